// Linear springs that carry tension up to a pull-off force, Coulomb friction with cohesion. See README.md.
#include "linear-cohesive.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = grit::contact_law_plugin<grit::LinearCohesive>(
      "linear-cohesive", "1.0.0",
      "linear springs with tension up to a pull-off force, friction with cohesion, rolling");
  return &info;
}
