#include "fixture.hpp"
#include "grit/body_kind.hpp"

namespace {

/// A cube of edge 2 r.
struct Cube : grit::BodyKind {
  void declare(grit::Parameters&) override {}
  double volume(double radius) const override { return 8 * radius * radius * radius; }
  double inertia(double radius, double mass) const override { return mass * 2 / 3 * radius * radius; }
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("good",
                         [](grit::PluginInfo& info) { info.make_body = []() -> grit::BodyKind* { return new Cube; }; });
}
