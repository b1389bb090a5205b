// Build tags of plugins. An input overwrites the first bytes of the tag of this build.
#include "grit/build_tag.hpp"

#include <algorithm>
#include <cstring>

#include "fuzz.hpp"
#include "grit/plugin.hpp"
#include "plugins/loader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  BuildTag found = build_tag();
  std::memcpy(&found, data, std::min(size, sizeof found));
  mismatches(build_tag(), found);
  return 0;
}
