#include "linear-normal.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info =
      grit::contact_law_plugin<LinearNormal>("linear-normal", "1.0.0", "a linear spring along the normal");
  return &info;
}
