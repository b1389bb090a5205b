// Adhesive elastic spheres by Johnson, Kendall and Roberts, with Mindlin shear. See README.md.
#include "jkr.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = grit::contact_law_plugin<grit::Jkr>(
      "jkr", "1.0.0", "JKR adhesive elastic spheres, Mindlin shear, friction, damping");
  return &info;
}
