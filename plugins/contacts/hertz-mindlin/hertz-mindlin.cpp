// Hertz's normal force, Mindlin's shear without slip, Coulomb's limit, damping and rolling resistance. See README.md.
#include "hertz-mindlin.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = grit::contact_law_plugin<grit::HertzMindlin>(
      "hertz-mindlin", "1.0.0", "Hertz and Mindlin's elastic spheres, Coulomb friction, damping, rolling resistance");
  return &info;
}
