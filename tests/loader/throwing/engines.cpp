#include "grit/engine.hpp"
#include "throwing.hpp"

namespace {

/// Does nothing, in the phase of its parameter.
struct Idle final : grit::Engine {
  void declare(grit::Parameters& p) override {
    throwing::declare("declare()", p);
    p.add("acts_in", acts_in).one_of({"settings", "forces", "removal"}).doc("its phase");
  }
  grit::Phase phase() const override {
    throwing::here("phase()");
    return acts_in == "forces"    ? grit::Phase::forces
           : acts_in == "removal" ? grit::Phase::removal
                                  : grit::Phase::settings;
  }
  grit::StateRequest needs() const override { return throwing::here("needs()"), grit::StateRequest(); }
  void settings(grit::MotionSettings&) const override { throwing::here("settings()"); }
  void forces(const grit::World&, std::span<grit::Row>, std::span<grit::Row>) const override {
    throwing::here("forces()");
  }
  bool removes(const grit::World&, const grit::Vec3&) const override { return throwing::here("removes()"), false; }
  grit::EngineRates rates(const grit::World&) const override { return throwing::here("rates()"), grit::EngineRates(); }
  void serialize(grit::Archive&) override { throwing::here("serialize()"); }

  std::string acts_in = "forces";
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return throwing::plugin("engine", "throwing", [](grit::PluginInfo& info) {
    info.make_engine = []() -> grit::Engine* { return throwing::here("make_engine()"), new Idle; };
  });
}
