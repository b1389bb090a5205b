// Hertzian normal force, Mindlin no-slip shear, Coulomb friction, damping and rolling resistance. See README.md.
#include "hertz-mindlin.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = grit::contact_law_plugin<grit::HertzMindlin>(
      "hertz-mindlin", "1.0.0", "Hertz-Mindlin elastic spheres, Coulomb friction, damping, rolling resistance");
  return &info;
}
