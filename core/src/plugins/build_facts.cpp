#include "plugins/build_facts.hpp"

#include "grit/plugin.hpp"

namespace grit {

const BuildFacts& build_facts() {
  static constexpr BuildTag tag = build_tag();
  static constexpr BuildFacts facts{.version = GRIT_VERSION,
                                    .revision = GRIT_REVISION,
                                    .date = GRIT_DATE,
                                    .compiler = GRIT_COMPILER,
                                    .build_type = GRIT_BUILD_TYPE,
                                    .flags = GRIT_FLAGS,
                                    .libraries = GRIT_LIBRARIES,
                                    .arch = GRIT_ARCH,
                                    .instruction_set = tag.instruction_set};
  return facts;
}

}  // namespace grit
