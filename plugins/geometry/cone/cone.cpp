// The lateral surface of a cone, whole or truncated. See README.md.
#include "cone.hpp"

#include "grit/plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "cone",
                                     .version = "1.0.0",
                                     .doc = "round sloping wall of a hopper or funnel, open at both ends",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Cone; }};
  return &info;
}
