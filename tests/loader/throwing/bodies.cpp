#include "grit/body_kind.hpp"
#include "throwing.hpp"

namespace {

struct Sphere final : grit::BodyKind {
  void declare(grit::Parameters& p) override { throwing::declare("declare()", p); }
  void prepare() override { throwing::here("prepare()"); }
  const grit::ClumpShape* clump() const override { return throwing::here("clump()"), nullptr; }
  double volume(double radius) const override {
    throwing::here("volume()");
    return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  }
  double inertia(double radius, double mass) const override {
    throwing::here("inertia()");
    return 0.4 * mass * radius * radius;
  }
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return throwing::plugin("body", "throwing", [](grit::PluginInfo& info) {
    info.make_body = []() -> grit::BodyKind* { return throwing::here("make_body()"), new Sphere; };
  });
}
