// Packings of other codes, whose format is recognised by content and extension.
#include "bodies/packing_file.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  for (const char* name : {"packing.txt", "packing.xyz"})
    fuzz::allow_refusal([&] {
      FileSource source;
      source.path = fuzz::file_of_input(name, data, size).string();
      read_bodies(source);
    });
  return 0;
}
