#include "silo-quasistatic.hpp"

#include "grit/plugin.hpp"
#include "grit/toolkit/homogeneity.hpp"
#include "grit/toolkit/lengths.hpp"

namespace grit {
namespace {

// Fraction of the duration of lowering in which the bottom accelerates from rest.
constexpr double start_fraction = 0.02;
constexpr int curve_samples = 400, frames_while_lowered = 10;

}  // namespace

void SiloQuasistatic::declare(Parameters& p) {
  silo_.declare(p);
  p.add("settlement", settlement_).unit("m").above(0).doc("displacement by which the bottom is lowered");
  p.add("velocity", velocity_).unit("m/s").above(0).doc("velocity of the bottom");
  p.check(
      [this](const Complain& complain) {
        if (settlement_ >= silo_.height)
          complain("settlement", metres(settlement_), "less than the height of the filling, " + metres(silo_.height));
      },
      {"settlement", "height"});
}

Description SiloQuasistatic::expand() const {
  const double duration = settlement_ / velocity_ / (1 - 0.5 * start_fraction), beyond = silo_.overhang();
  const double below = settlement_ + 2 * silo_.largest_diameter;
  Description d = silo_.description("silo with a lowered bottom, " + silo_.wall_surface + " walls", below);
  d["walls"]["bottom"] = silo_.bottom(-beyond, silo_.width + beyond);
  d["specimen"] = {{"low", {silo_.segment("left", 1), "front", "bottom"}},
                   {"high", {silo_.segment("right", 1), "back", ""}}};

  auto stages = silo_.filling_stages();
  Description lower;
  lower["name"] = "lower";
  lower["change"]["engines"]["damping"]["coefficient"] = silo_.local_damping;
  lower["change"]["walls"]["bottom"]["motion"] = {{"velocity", vector(0, 0, -velocity_)},
                                                  {"ramp_time", start_fraction * duration}};
  lower["until"] = {{"type", "displacement"}, {"wall", "bottom"}, {"axis", "z"}, {"value", -settlement_}};
  lower["limit"] = 1.1 * duration;
  stages.push_back(lower);
  d["stages"] = stages;

  auto& test = d["probes"]["test"];
  test = silo_.curves({"bottom"}, "bottom_travel_z", true);
  test["stages"] = {"settle", "lower"};
  test["every_time"] = duration / curve_samples;
  test["curves"]["settlement"] = {
      {"formula", "-bottom_travel_z"}, {"unit", "m"}, {"doc", "displacement of the bottom, downwards positive"}};
  d["probes"]["walls"] = {{"type", "walls"}, {"stages", {"settle", "lower"}}, {"every_time", duration / curve_samples}};
  d["probes"]["packing"] = {{"type", "packing"}, {"every_time", duration / 100}, {"stages", {"settle", "lower"}}};
  auto& profile = d["probes"]["wall-profile"] = silo_.wall_profile();
  profile["stages"] = {"settle", "lower"}, profile["every_time"] = duration / 100;
  d["output"] = {{"frames", {{"every_time", duration / frames_while_lowered}}},
                 {"picture",
                  {{"x", "test/settlement"},
                   {"y", {"test/bottom_fraction", "test/wall_shear_fraction", "test/wall_friction_angle"}},
                   {"color", "rotation"}}},
                 {"summary",
                  {"test/bottom_fraction", "test/wall_shear_fraction", "test/wall_normal_fraction",
                   "test/wall_friction_angle", "test/balance", "test/void_ratio"}}};
  add_homogeneity_probes(d, "y");
  auto& references = d["output"]["references"] = silo_.references();
  const auto add_bottom_force = [&](const char* name, const std::optional<SiloForm>& form, double walls_with_friction) {
    if (!form) return;
    analytical_solutions::PlaneSilo balance = silo_.balance(*form);
    balance.walls_with_friction = walls_with_friction;
    references[name] = {{"of", "test/bottom_force"}, {"value", balance.bottom_force()}};
  };
  add_bottom_force("Drescher", silo_.forms.drescher, 1);
  add_bottom_force("EN_1991-4", silo_.forms.en_1991_4, 2);
  return d;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "scenario",
                                     .name = "silo-quasistatic",
                                     .version = "1.0.0",
                                     .doc = "plane silo that is filled and whose bottom is lowered",
                                     .make_scenario = []() -> grit::Scenario* { return new grit::SiloQuasistatic; }};
  return &info;
}
