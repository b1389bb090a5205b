// Files of the spheres of a clump, and the clump made of them.
#include <vector>

#include "bodies/clump_shape.hpp"
#include "bodies/packing_file.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  fuzz::allow_refusal([&] {
    const std::vector<Ball> spheres = read_packing(fuzz::file_of_input("clump.txt", data, size));
    if (!clump_defects(spheres).empty()) return;
    make_clump_shape(spheres, 9);  // few lines, so that many inputs are tried
  });
  return 0;
}
