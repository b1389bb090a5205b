// Linear springs, Coulomb friction, dashpots, and liquid bridges that pull until they rupture. See README.md.
#include "capillary.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = grit::contact_law_plugin<grit::Capillary>(
      "capillary", "1.0.0", "linear springs, Coulomb friction, viscous damping, liquid bridges between bodies");
  return &info;
}
