#include "representative-volume.hpp"

#include <cmath>

#include "grit/plugin.hpp"

namespace grit {
namespace {

constexpr int curve_samples = 400, frames_in_test = 10;
// Largest strain rate of stresses that are kept during the test, over that of the test: several times the rate at which
// dense sand dilates.
constexpr double freedom = 10;
// A cell of fewer grains may become too short for its largest grain.
constexpr std::int64_t fewest_grains = 100;

/// All normal stresses are within a relative difference of the confining one, and grains are in equilibrium.
Description at_confinement(double within, double unbalanced, double stress) {
  Description of = Description::array();
  for (const char* component : {"xx", "yy", "zz"})
    of.push_back({{"type", "stress"}, {"component", component}, {"value", stress}, {"within", within}});
  of.push_back({{"type", "unbalanced-force"}, {"below", unbalanced}});
  return {{"type", "all"}, {"of", of}};
}

}  // namespace

RepresentativeVolume::RepresentativeVolume() {
  preparation_.smallest_diameter = 2.5e-3, preparation_.largest_diameter = 7.5e-3;
}

void RepresentativeVolume::declare(Parameters& p) {
  p.add("grains", grains_).at_least(fewest_grains).doc("number of grains");
  preparation_.declare_sand(p);
  p.add("preparation_friction_angle", preparation_friction_angle_)
      .unit("rad")
      .at_least(0)
      .below(std::numbers::pi / 2)
      .doc("friction angle between grains during isotropic compression: the lower, the denser");
  p.add("preparation_inertial_number", preparation_.inertial_number)
      .above(0)
      .at_most(0.1)
      .doc("inertial number of isotropic compression, with the confining stress");
  p.add("confining_stress", confining_stress_)
      .unit("Pa")
      .symbol("sigma_c")
      .above(0)
      .doc("isotropic stress before the test; kept on the lateral axes, or normal to the plane of shear");
  p.add("test", test_)
      .one_of({"triaxial", "simple-shear"})
      .doc(
          "triaxial: shortened along z at constant stress along x and y. simple-shear: velocity along x, gradient "
          "along z, at constant stress along z and constant lengths along x and y");
  p.add("strain", strain_).above(0).doc("axial strain, below 1, or shear strain at the end");
  p.add("inertial_number", inertial_number_)
      .symbol("I")
      .above(0)
      .at_most(0.1)
      .doc("inertial number during the test, with the confining stress; sets the strain rate");
  p.add("local_damping", local_damping_).symbol("lambda").at_least(0).below(1).doc("local damping during the test");
  p.add("seed", preparation_.seed).at_least(0).doc("seed of the random sizes and positions of the grains");
  p.check(
      [this](const Complain& complain) {
        if (!shears() && strain_ >= 1)
          complain("strain", quantity(strain_, ""), "an axial strain below 1; the test \"simple-shear\" may have more");
      },
      {"strain", "test"});
}

Description RepresentativeVolume::test_stage(double duration) const {
  Description stage;
  stage["name"] = "test";
  Description& change = stage["change"];
  change["engines"]["damping"]["coefficient"] = local_damping_;
  Description& domain = change["domain"];
  if (shears()) {
    domain["shear_rate"]["xz"] = strain_rate();
    domain["servo"]["stress"] = {{"xx", nullptr}, {"yy", nullptr}};
  } else {
    domain["strain_rate"] = vector(0, 0, -strain_rate());
    domain["servo"]["stress"] = {{"zz", nullptr}};
  }
  if (const double most = freedom * strain_rate(); most > compression_rate()) domain["servo"]["max_strain_rate"] = most;
  stage["until"] = {{"type", "time"}, {"value", duration}};
  stage["limit"] = 1.1 * duration;
  return stage;
}

void RepresentativeVolume::add_curves(Description& d, double duration) const {
  const std::string volume = "cell_length_x * cell_length_y * cell_length_z",
                    volume_at_start = "(cell_stage_length_x * cell_stage_length_y * cell_stage_length_z)";
  Description& test = d["probes"]["test"];
  test = {{"type", "formula"}, {"stages", {"test"}}, {"every_time", duration / curve_samples}};
  const auto curve = [&](const char* name, const std::string& formula, const char* unit, const char* doc) {
    test["curves"][name] = {{"formula", formula}, {"unit", unit}, {"doc", doc}};
  };
  curve("volumetric_strain", volume + " / " + volume_at_start + " - 1", "1",
        "change of volume over volume before the test, dilation positive");
  if (shears()) {
    curve("shear_strain", "cell_shear_strain_xz", "1", "shear strain of the cell");
    curve("shear_stress", "-stress_xz", "Pa", "shear stress, positive against the shear");
    curve("normal_stress", "stress_zz", "Pa", "stress along z, compression positive");
    curve("stress_ratio", "-stress_xz / stress_zz", "1", "shear stress over normal stress");
    d["output"]["picture"] = {{"x", "test/shear_strain"}, {"y", {"test/stress_ratio", "test/volumetric_strain"}}};
    d["output"]["summary"] = {"test/stress_ratio", "test/volumetric_strain"};
    return;
  }
  curve("axial_strain", "1 - cell_length_z / cell_stage_length_z", "1",
        "shortening over the length before the test, compression positive");
  curve("sigma_1", "stress_zz", "Pa", "stress along z, compression positive");
  curve("sigma_2", "stress_yy", "Pa", "stress along y, compression positive");
  curve("sigma_3", "stress_xx", "Pa", "stress along x, compression positive");
  curve("friction_angle", "180 / _pi * asin((stress_zz - stress_xx) / (stress_zz + stress_xx))", "degree",
        "mobilised friction angle, asin((sigma_1 - sigma_3) / (sigma_1 + sigma_3))");
  d["output"]["picture"] = {{"x", "test/axial_strain"},
                            {"y", {"test/sigma_1", "test/friction_angle", "test/volumetric_strain"}}};
  d["output"]["summary"] = {"test/sigma_1", "test/friction_angle", "test/volumetric_strain"};
}

Description RepresentativeVolume::expand() const {
  // Volume of the cloud: that of all grains over its solid fraction.
  const double volume = static_cast<double>(grains_) / static_cast<double>(preparation_.grains(1));
  const double swollen = preparation_.in_cloud(volume), side = std::cbrt(swollen);
  const double closing = std::log(swollen / volume) / 3 / compression_rate(),
               settling = preparation_.settling_time(confining_stress_);
  const double duration = (shears() ? strain_ : -std::log(1 - strain_)) / strain_rate();

  Description d;
  d["title"] = std::string(shears() ? "simple shear" : "triaxial compression") + " of a periodic cell, " +
               std::to_string(std::lround(confining_stress_ * 1e-3)) + " kPa";
  d["seed"] = preparation_.seed;
  d["contacts"] = {{"type", "linear-rolling"}};
  d["materials"]["sand"] = preparation_.sand();
  d["domain"] = {{"low", vector(0, 0, 0)},
                 {"high", vector(side, side, side)},
                 {"periodic", {true, true, true}},
                 {"servo",
                  {{"stress", {{"xx", confining_stress_}, {"yy", confining_stress_}, {"zz", confining_stress_}}},
                   {"max_strain_rate", compression_rate()}}}};
  d["bodies"]["sand"] = preparation_.cloud(vector(0, 0, 0), vector(side, side, side), grains_);
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", Preparation::local_damping}};

  Description compress, settle;
  compress["name"] = "compress";
  compress["change"]["materials"]["sand"]["friction_angle"] = preparation_friction_angle_;
  compress["until"] = at_confinement(0.02, 0.01, confining_stress_);
  compress["limit"] = 3 * closing + 5 * settling;
  compress["typical_time"] = closing;
  settle["name"] = "settle";
  settle["change"]["materials"]["sand"]["friction_angle"] = preparation_.friction_angle;
  settle["until"] = at_confinement(0.005, 2e-3, confining_stress_);
  settle["limit"] = 15 * settling;
  settle["typical_time"] = 0.05 * settling;
  d["stages"] = {compress, settle, test_stage(duration)};

  d["probes"]["packing"] = {{"type", "packing"}, {"shear_rate", strain_rate()}, {"every_time", duration / 100}};
  d["probes"]["force-chains"] = {{"type", "force-chains"}, {"every_time", duration / 100}, {"stages", {"test"}}};
  d["output"]["frames"] = {{"every_time", duration / frames_in_test}};
  add_curves(d, duration);
  return d;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "scenario",
      .name = "representative-volume",
      .version = "1.0.0",
      .doc = "triaxial compression or simple shear of sand in a periodic cell at prescribed stress",
      .make_scenario = []() -> grit::Scenario* { return new grit::RepresentativeVolume; }};
  return &info;
}
