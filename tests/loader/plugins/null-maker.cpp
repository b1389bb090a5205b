#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("null-maker", [](grit::PluginInfo&) {});
}
