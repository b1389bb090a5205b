#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("wrong-kind", [](grit::PluginInfo& info) { info.kind = "probe"; });
}
