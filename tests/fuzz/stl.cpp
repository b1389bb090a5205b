// STL files.
#include "fuzz.hpp"
#include "grit/toolkit/stl_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  fuzz::allow_refusal([&] { read_stl(fuzz::file_of_input("mesh.stl", data, size)); });
  return 0;
}
