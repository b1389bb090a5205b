// Right in all but what it was built for: see CMakeLists.txt. Made so that no compiler has its tag as a constant.
#include "grit/body_kind.hpp"
#include "grit/plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const auto* const info = new grit::PluginInfo{.kind = "body",
                                                       .name = "other-instruction-set",
                                                       .version = "1.0.0",
                                                       .doc = "of the loader's tests",
                                                       .make_body = []() -> grit::BodyKind* { return nullptr; }};
  return info;
}
