#include "grit/scenario.hpp"
#include "throwing.hpp"

namespace {

struct Nothing final : grit::Scenario {
  void declare(grit::Parameters& p) override { throwing::declare("declare()", p); }
  grit::Description expand() const override {
    throwing::here("expand()");
    return {{"title", "nothing"}};
  }
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return throwing::plugin("scenario", "throwing", [](grit::PluginInfo& info) {
    info.make_scenario = []() -> grit::Scenario* { return throwing::here("make_scenario()"), new Nothing; };
  });
}
