#include "silo-quasistatic.hpp"

#include "grit/plugin.hpp"
#include "grit/toolkit/homogeneity.hpp"
#include "grit/toolkit/lengths.hpp"

namespace grit {
namespace {

// The bottom starts from rest over this share of its way's duration.
constexpr double start_share = 0.02;
constexpr int curve_samples = 400, frames_while_lowered = 10;

}  // namespace

void SiloQuasistatic::declare(Parameters& p) {
  silo_.declare(p);
  p.add("settlement", settlement_).unit("m").above(0).doc("by which the bottom is lowered");
  p.add("velocity", velocity_).unit("m/s").above(0).doc("of the bottom");
  p.check(
      [this](const Complain& complain) {
        if (settlement_ >= silo_.height)
          complain("settlement", metres(settlement_), "less than the height of the filling, " + metres(silo_.height));
      },
      {"settlement", "height"});
}

Description SiloQuasistatic::expand() const {
  const double duration = settlement_ / velocity_ / (1 - 0.5 * start_share), beyond = silo_.overhang();
  const double below = settlement_ + 2 * silo_.largest_diameter;
  Description d = silo_.description("silo with a lowered bottom, " + silo_.wall_surface + " walls", below);
  d["walls"]["bottom"] = silo_.bottom(-beyond, silo_.width + beyond);
  d["specimen"] = {{"low", {silo_.piece("left", 1), "front", "bottom"}},
                   {"high", {silo_.piece("right", 1), "back", ""}}};

  auto stages = silo_.filling_stages();
  Description lower;
  lower["name"] = "lower";
  lower["change"]["engines"]["damping"]["coefficient"] = silo_.local_damping;
  lower["change"]["walls"]["bottom"]["motion"] = {{"velocity", vector(0, 0, -velocity_)},
                                                  {"ramp_time", start_share * duration}};
  lower["until"] = {{"type", "displacement"}, {"wall", "bottom"}, {"axis", "z"}, {"value", -settlement_}};
  lower["limit"] = 1.1 * duration;
  stages.push_back(lower);
  d["stages"] = stages;

  auto& test = d["probes"]["test"];
  test = silo_.curves({"bottom"}, "bottom_travel_z", true);
  test["stages"] = {"settle", "lower"};
  test["every_time"] = duration / curve_samples;
  test["curves"]["settlement"] = {
      {"formula", "-bottom_travel_z"}, {"unit", "m"}, {"doc", "of the bottom, downwards positive"}};
  d["probes"]["walls"] = {{"type", "walls"}, {"stages", {"settle", "lower"}}, {"every_time", duration / curve_samples}};
  d["probes"]["packing"] = {{"type", "packing"}, {"every_time", duration / 100}, {"stages", {"settle", "lower"}}};
  auto& profile = d["probes"]["wall-profile"] = silo_.wall_profile();
  profile["stages"] = {"settle", "lower"}, profile["every_time"] = duration / 100;
  d["output"] = {{"frames", {{"every_time", duration / frames_while_lowered}}},
                 {"picture",
                  {{"x", "test/settlement"},
                   {"y", {"test/bottom_share", "test/wall_shear_share", "test/wall_friction_angle"}},
                   {"color", "rotation"}}},
                 {"summary",
                  {"test/bottom_share", "test/wall_shear_share", "test/wall_normal_share", "test/wall_friction_angle",
                   "test/balance", "test/void_ratio"}}};
  look_how_even_it_is(d, "y");
  auto& references = d["output"]["references"] = silo_.references();
  const auto on_the_bottom = [&](const char* name, const std::optional<SiloForm>& form, double rubbing_walls) {
    if (!form) return;
    closed_forms::PlaneSilo balance = silo_.balance(*form);
    balance.rubbing_walls = rubbing_walls;
    references[name] = {{"of", "test/bottom_force"}, {"value", balance.bottom_force()}};
  };
  on_the_bottom("Drescher", silo_.forms.drescher, 1);
  on_the_bottom("EN_1991-4", silo_.forms.en_1991_4, 2);
  return d;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "scenario",
                                     .name = "silo-quasistatic",
                                     .version = "1.0.0",
                                     .doc = "plane silo, filled, whose bottom is lowered",
                                     .make_scenario = []() -> grit::Scenario* { return new grit::SiloQuasistatic; }};
  return &info;
}
