// The lateral surface of a cylinder. See README.md.
#include "cylinder.hpp"

#include "grit/plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "cylinder",
                                     .version = "1.0.0",
                                     .doc = "round wall of a drum, silo or rod, open at both ends",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Cylinder; }};
  return &info;
}
