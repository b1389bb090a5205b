#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("no-maker", [](grit::PluginInfo& info) {
    info.make_body = nullptr;
    info.make_probe = []() -> grit::Probe* { return nullptr; };
  });
}
