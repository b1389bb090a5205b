// Descriptions, up to the values of a scene.
#include "fuzz.hpp"
#include "input/document.hpp"
#include "input/scene.hpp"
#include "support/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  fuzz::allow_refusal([&] {
    Document document = Document::parse(std::string(fuzz::text_of_input(data, size)), "input");
    const Registry& registry = test::installed();
    resolved(*read_scene(expanded_document(std::move(document), {}, registry), registry).description);
  });
  return 0;
}
