#include "silo-discharge.hpp"

#include <functional>
#include <sstream>
#include <utility>

#include "grit/plugin.hpp"
#include "grit/toolkit/homogeneity.hpp"
#include "grit/toolkit/lengths.hpp"

namespace grit {
namespace {

constexpr int curve_samples = 400, frames_while_discharged = 10;
// In largest grains; arches block narrower outlets.
constexpr double least_outlet = 3;
/// Measured time of discharge over that of Beverloo's law, for sand with rolling resistance; for estimates.
constexpr double slower = 1.7;

/// Name of the stage that ends at this fraction: "discharge-10" for a tenth.
std::string discharge(double fraction) {
  return "discharge-" + (std::ostringstream() << 100 * fraction).str();  // six digits: 29, not 28.999…
}

}  // namespace

void SiloDischarge::declare(Parameters& p) {
  silo_.declare(p);
  p.add("outlet_positions", outlet_positions_)
      .unit("m")
      .doc(
          "distance of the middle of each outlet from the left wall; empty: one in the middle of the bottom; channels "
          "number outlets from left to right");
  p.add("outlet_widths", outlet_widths_)
      .unit("m")
      .above(0)
      .entries(1)
      .doc("width of each outlet; outlets extend over the depth of the silo");
  p.add("discharged_fractions", discharged_fractions_)
      .above(0)
      .at_most(1)
      .entries(1)
      .doc("ascending fractions of the mass; a stage ends, and a frame is written, at each; the last ends the run");
  p.check(
      [this](const Complain& complain) {
        if (!std::ranges::is_sorted(discharged_fractions_, std::less_equal<>()))
          complain("discharged_fractions", "a fraction that is not above the one before", "ascending fractions");
        else if (std::ranges::adjacent_find(discharged_fractions_, {}, discharge) != discharged_fractions_.end())
          complain("discharged_fractions", "two fractions with the same first six digits",
                   "fractions that differ in six digits");
      },
      {"discharged_fractions"});
  p.check(
      [this](const Complain& complain) {
        const std::size_t positions = outlet_positions_.empty() ? 1 : outlet_positions_.size();
        if (positions != outlet_widths_.size()) {
          complain("outlet_widths", std::to_string(outlet_widths_.size()) + " widths",
                   "as many as outlet_positions, " + std::to_string(positions));
          return;
        }
        const auto slots = outlets();
        const double rounding = 1e-9 * silo_.width;
        for (std::size_t i = 0; i < slots.size(); ++i) {
          const auto& [low, high] = slots[i];
          const std::string from_to = "an outlet from " + metres(low) + " to " + metres(high);
          if (high - low < least_outlet * silo_.largest_diameter - rounding)
            complain("outlet_widths", metres(high - low),
                     "at least three of the largest grains, which block narrower ones: " +
                         metres(least_outlet * silo_.largest_diameter));
          if (low < -rounding || high > silo_.width + rounding)
            complain("outlet_widths", from_to, "outlets inside the bottom, 0 to " + metres(silo_.width));
          if (i > 0 && low < slots[i - 1].high + rounding)
            complain("outlet_positions",
                     from_to + ", which overlaps or touches its neighbour, up to " + metres(slots[i - 1].high),
                     "outlets with some bottom in between");
        }
      },
      {"outlet_positions", "outlet_widths", "width", "largest_diameter"});
  p.check(
      [this](const Complain& complain) {
        for (const auto& [name, form] :
             {std::pair("drescher", silo_.forms.drescher), {"en_1991_4", silo_.forms.en_1991_4}})
          if (form)
            complain(std::string("analytical_solutions/") + name,
                     "a solution for the force on a bottom without outlets",
                     "the other analytical_solutions; use silo-quasistatic for this one");
      },
      {"analytical_solutions"});
}

std::vector<SiloDischarge::Slot> SiloDischarge::outlets() const {
  const std::vector<double> middle = outlet_positions_.empty() ? std::vector{0.5 * silo_.width} : outlet_positions_;
  std::vector<Slot> slots;
  for (std::size_t i = 0; i < middle.size(); ++i)
    slots.push_back({middle[i] - 0.5 * outlet_widths_[i], middle[i] + 0.5 * outlet_widths_[i]});
  std::ranges::sort(slots, {}, &Slot::low);
  return slots;
}

double SiloDischarge::expected_rate() const {
  double rate = 0;
  for (const auto& [low, high] : outlets())
    rate += analytical_solutions::beverloo_slot(silo_.bulk_density(), silo_.depth, high - low, silo_.mean_diameter());
  return rate;
}

Description SiloDischarge::expand() const {
  const auto slots = outlets();
  const double mass = silo_.bulk_density() * silo_.area() * silo_.height;
  const double duration = discharged_fractions_.back() * mass / expected_rate();
  const double beyond = silo_.overhang(), drop = 4 * silo_.largest_diameter;

  Description d = silo_.description("discharge of a silo, " + silo_.wall_surface + " walls", 0);
  d["domain"]["low"][2] = -drop;
  d["domain"]["open_sides"] = {"-z"};

  // Bottom and gates side by side; the outer ones extend into the grooves of the walls.
  std::vector<std::string> bottoms, gates;
  double end = -beyond;
  const auto bottom_to = [&](double low) {
    if (low <= end) return;
    bottoms.push_back("bottom-" + std::to_string(bottoms.size() + 1));
    d["walls"][bottoms.back()] = silo_.bottom(end, low);
  };
  for (const Slot& slot : slots) {
    const double rounding = 1e-9 * silo_.width;
    const double low = slot.low < rounding ? -beyond : slot.low;
    const double high = slot.high > silo_.width - rounding ? silo_.width + beyond : slot.high;
    bottom_to(low);
    gates.push_back("gate-" + std::to_string(gates.size() + 1));
    d["walls"][gates.back()] = silo_.bottom(low, high);
    end = high;
  }
  bottom_to(silo_.width + beyond);
  d["specimen"] = {{"low", {silo_.segment("left", 1), "front", bottoms.empty() ? "" : bottoms.front()}},
                   {"high", {silo_.segment("right", 1), "back", ""}}};

  // Gates open in one step: they move below the domain.
  auto stages = silo_.filling_stages();
  for (std::size_t i = 0; i < discharged_fractions_.size(); ++i) {
    Description stage;
    stage["name"] = discharge(discharged_fractions_[i]);
    if (i == 0) {
      stage["change"]["engines"]["damping"]["coefficient"] = silo_.local_damping;
      if (silo_.scaled_below > 0) stage["change"]["engines"]["density-scaling"] = nullptr;
      for (const std::string& gate : gates) {
        Description corner = d["walls"][gate]["corner"];
        corner[2] = -drop - silo_.height;
        stage["change"]["walls"][gate]["corner"] = corner;
      }
    }
    const double expected = duration * (discharged_fractions_[i] - (i > 0 ? discharged_fractions_[i - 1] : 0)) /
                            discharged_fractions_.back();
    const Description discharged = {{"type", "discharged"}, {"fraction", discharged_fractions_[i]}};
    const Description rests = {
        {"type", "all"},
        {"of", {{{"type", "time"}, {"value", 0.5 * expected}}, {{"type", "unbalanced-force"}, {"below", 1e-3}}}}};
    stage["until"] = {{"type", "any"}, {"of", {discharged, rests}}};
    // Includes time for the remaining sand to come to rest.
    stage["limit"] = 10 * expected + 20 * silo_.falling_time();
    stage["typical_time"] = slower * expected;
    stages.push_back(stage);
  }
  d["stages"] = stages;

  std::vector<std::string> floor = bottoms;
  floor.insert(floor.end(), gates.begin(), gates.end());
  auto& test = d["probes"]["test"];
  test = silo_.curves(floor, "0", false);
  test["every_time"] = duration / curve_samples;
  Description sampled = Description::array();
  for (const Description& stage : stages)
    if (!stage["name"].get_ref<const std::string&>().starts_with("fill")) sampled.push_back(stage["name"]);
  test["stages"] = sampled;
  test["curves"]["discharged_mass"] = {
      {"formula", "departed_mass"}, {"unit", "kg"}, {"doc", "mass discharged through the outlets"}};
  test["curves"]["discharged_fraction"] = {{"formula", "departed_mass / (departed_mass + mass)"},
                                           {"unit", "1"},
                                           {"doc", "discharged mass over the mass at the start"}};
  auto& flow = d["probes"]["flow"];
  flow = {{"type", "flow"},
          {"stages", sampled},
          {"every_time", duration / curve_samples},
          {"window", duration / 20},
          {"pattern", {{"depth_axis", "y"}}}};
  for (std::size_t i = 0; i < slots.size() && slots.size() > 1; ++i) {
    // Falling grains spread: they belong to the nearest outlet.
    const double reach = silo_.width + beyond;
    flow["outlets"]["outlet_" + std::to_string(i + 1)] = {
        {"low", i == 0 ? -reach : 0.5 * (slots[i - 1].high + slots[i].low)},
        {"high", i + 1 == slots.size() ? silo_.width + reach : 0.5 * (slots[i].high + slots[i + 1].low)}};
  }
  d["probes"]["walls"] = {{"type", "walls"}, {"stages", sampled}, {"every_time", duration / curve_samples}};
  d["probes"]["packing"] = {{"type", "packing"}, {"stages", sampled}, {"every_time", duration / 100}};
  auto& profile = d["probes"]["wall-profile"] = silo_.wall_profile();
  profile["stages"] = sampled, profile["every_time"] = duration / 100;
  d["output"] = {{"frames", {{"every_time", duration / frames_while_discharged}}},
                 {"picture",
                  {{"x", "test/discharged_fraction"},
                   {"y", {"flow/discharge_rate", "test/bottom_fraction", "test/wall_shear_fraction"}},
                   {"color", "speed"}}},
                 {"summary",
                  {"flow/discharged_mass", "flow/discharge_rate", "test/bottom_fraction", "test/wall_shear_fraction",
                   "test/balance"}}};
  add_homogeneity_probes(d, "y");
  auto& references = d["output"]["references"] = silo_.references();
  references["Beverloo"] = {{"of", "flow/discharge_rate"}, {"value", expected_rate()}};
  return d;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "scenario",
                                     .name = "silo-discharge",
                                     .version = "1.0.0",
                                     .doc = "plane silo that is filled and discharges through slots in its bottom",
                                     .make_scenario = []() -> grit::Scenario* { return new grit::SiloDischarge; }};
  return &info;
}
