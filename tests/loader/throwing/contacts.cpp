// A law that the kernel's calls reach directly. It computes nothing.
#include "grit/contact/contact_law.hpp"
#include "throwing.hpp"

namespace {

struct Law final : grit::ContactLaw {
  void declare(grit::Parameters& p) override { throwing::declare("declare()", p); }
  void clear_materials() override { throwing::here("clear_materials()"); }
  void declare_material(const std::string&, grit::Parameters& p) override {
    throwing::declare("declare_material()", p);
  }
  void declare_interface(const std::string&, const std::string&, grit::Parameters& p) override {
    throwing::declare("declare_interface()", p);
  }
  void mix(std::span<const std::string>, std::size_t) override { throwing::here("mix()"); }
  std::vector<grit::StateField> state() const override {
    return throwing::here("state()"), std::vector<grit::StateField>();
  }
  grit::LawLoop loop() const override { return throwing::here("loop()"), grit::LawLoop(); }
  void evaluate_pairs(grit::PairBatch&) const override { throwing::here("evaluate_pairs()"); }
  void evaluate_walls(grit::WallBatch&) const override { throwing::here("evaluate_walls()"); }
  void evaluate_pairs_reference(grit::PairBatch&) const override { throwing::here("evaluate_pairs_reference()"); }
  std::optional<grit::DeviceLaw> device() const override {
    return throwing::here("device()"), std::optional<grit::DeviceLaw>();
  }
  void evaluate_device_pairs(const grit::DevicePairs&, const void*, std::uint32_t, std::uint32_t) const override {
    throwing::here("evaluate_device_pairs()");
  }
  grit::Stiffness stiffness(const grit::PairSize&, std::size_t, std::size_t) const override {
    return throwing::here("stiffness()"), grit::Stiffness();
  }
  bool has_reach() const override { return throwing::here("has_reach()"), false; }
  double reach(const grit::PairSize&, std::size_t, std::size_t) const override { return throwing::here("reach()"), 0; }
  std::vector<double> reaches(double) const override { return throwing::here("reaches()"), std::vector<double>(); }
  std::vector<double> mixed(std::size_t, std::size_t, bool) const override {
    return throwing::here("mixed()"), std::vector<double>();
  }
  grit::ElasticEnergy energy(const grit::PairSize&, std::size_t, std::size_t, std::span<const double>) const override {
    return throwing::here("energy()"), grit::ElasticEnergy();
  }
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return throwing::plugin("contact", "throwing", [](grit::PluginInfo& info) {
    info.make_contact = []() -> grit::ContactLaw* { return throwing::here("make_contact()"), new Law; };
  });
}
