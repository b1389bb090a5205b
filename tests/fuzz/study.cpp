// Studies.
#include "fuzz.hpp"
#include "study/description.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  fuzz::allow_refusal([&] { load_study(fuzz::file_of_input("study.json", data, size)); });
  return 0;
}
