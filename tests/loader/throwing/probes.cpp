#include "grit/probe.hpp"
#include "grit/toolkit/limited_fields.hpp"
#include "throwing.hpp"

namespace {

struct Counter final : grit::Probe, grit::LimitedFields {
  void declare(grit::Parameters& p) override { throwing::declare("declare()", p); }
  grit::StateRequest needs() const override { return throwing::here("needs()"), grit::StateRequest(); }
  void prepare(const grit::World&) override { throwing::here("prepare()"); }
  std::vector<grit::Channel> channels() const override {
    throwing::here("channels()");
    const char* const name = std::getenv("CHANNEL");
    std::vector<grit::Channel> all{{name == nullptr ? "bodies" : name, "1", "number of bodies", {}}};
    if (calls_++ > 0 && std::getenv("MORE_CHANNELS") != nullptr) all.push_back({"more", "1", "nothing", {}});
    return all;
  }
  void sample(const grit::World& world, grit::ChannelValues& values) override {
    throwing::here("sample()");
    values["bodies"] = static_cast<double>(world.positions().size());
  }
  std::vector<grit::Field> fields(const grit::World&) override {
    throwing::here("fields()");
    return {};
  }
  void check_fields(const grit::World&) const override { throwing::here("check_fields()"); }
  void serialize(grit::Archive&) override { throwing::here("serialize()"); }

 private:
  mutable int calls_ = 0;  // of channels()
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return throwing::plugin("probe", "throwing", [](grit::PluginInfo& info) {
    info.make_probe = []() -> grit::Probe* { return throwing::here("make_probe()"), new Counter; };
  });
}
