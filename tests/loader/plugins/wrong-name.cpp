#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("another-name", [](grit::PluginInfo&) {});
}
