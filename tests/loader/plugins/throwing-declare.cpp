#include <stdexcept>

#include "fixture.hpp"
#include "grit/body_kind.hpp"

namespace {

struct Mute : grit::BodyKind {
  void declare(grit::Parameters&) override { throw std::runtime_error("nothing to declare"); }
  double volume(double) const override { return 1; }
  double inertia(double, double) const override { return 1; }
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("throwing-declare",
                         [](grit::PluginInfo& info) { info.make_body = []() -> grit::BodyKind* { return new Mute; }; });
}
