#include <stdexcept>

#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("throwing-maker", [](grit::PluginInfo& info) {
    info.make_body = []() -> grit::BodyKind* { throw std::runtime_error("out of clay"); };
  });
}
