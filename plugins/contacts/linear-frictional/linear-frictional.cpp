// Linear normal and shear springs, Coulomb friction, dashpots from a coefficient of restitution. See README.md.
#include "linear-frictional.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = grit::contact_law_plugin<grit::LinearFrictional>(
      "linear-frictional", "1.0.0", "linear springs, Coulomb friction, viscous damping");
  return &info;
}
