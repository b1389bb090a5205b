#include "linear-normal.hpp"

#include "grit/contact/law_plugin.hpp"

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info =
      grit::contact_law_plugin<mine::LinearNormal>("linear-normal", "1.0.0", "a linear spring along the normal");
  return &info;
}
