// Linear normal and shear springs, Coulomb friction, rolling and twisting springs with a limit, dashpots. See
// README.md.
#include "linear-rolling.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = grit::contact_law_plugin<grit::LinearRolling>(
      "linear-rolling", "1.0.0", "linear springs, Coulomb friction, rolling and twisting resistance, viscous damping");
  return &info;
}
