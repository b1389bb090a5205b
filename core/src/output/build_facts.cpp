#include "output/build_facts.hpp"

namespace grit {

const BuildFacts& build_facts() {
  static constexpr BuildFacts facts{GRIT_VERSION, GRIT_REVISION, GRIT_COMPILER, GRIT_BUILD_TYPE, GRIT_ARCH};
  return facts;
}

}  // namespace grit
