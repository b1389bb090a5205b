#include "direct-shear.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "grit/error.hpp"
#include "grit/plugin.hpp"

namespace grit {
namespace {

// Solid fraction of the cloud of grains that preparation starts from.
constexpr double cloud_solid_fraction = 0.3;
constexpr double degree = std::numbers::pi / 180;

// Friction during compaction, and the void ratio of the interior that it led to: measured under 200 kPa, see README.md.
struct Compacted {
  double friction_angle, void_ratio;
};
constexpr std::array<Compacted, 7> compacted{{{0, 0.558},
                                              {2 * degree, 0.597},
                                              {5 * degree, 0.635},
                                              {10 * degree, 0.698},
                                              {18 * degree, 0.770},
                                              {30 * degree, 0.853},
                                              {60 * degree, 0.919}}};
// Compaction aims so much above the wanted void ratio; lowering the friction does the rest.
constexpr double aim_above = 0.03;

double compaction_friction_angle(double void_ratio) {
  for (std::size_t i = 1; i < compacted.size(); ++i) {
    const Compacted &a = compacted[i - 1], &b = compacted[i];
    if (void_ratio >= b.void_ratio) continue;
    const double share = std::max(0.0, void_ratio - a.void_ratio) / (b.void_ratio - a.void_ratio);
    return a.friction_angle + share * (b.friction_angle - a.friction_angle);
  }
  return compacted.back().friction_angle;
}

// Shear starts from rest over this share of its duration.
constexpr double start_share = 0.02;
constexpr int curve_samples = 400, frames_in_shear = 10;

Description vector(double x, double y, double z) { return Description::array({x, y, z}); }

}  // namespace

void DirectShear::declare(Parameters& p) {
  p.add("width", width_).unit("m").above(0).doc("inner length of the box, along the shear");
  p.add("height", height_).unit("m").above(0).doc("height of the specimen at the wanted void ratio");
  p.add("depth", depth_).unit("m").above(0).doc("inner depth of the box, across the shear");
  p.add("depth_boundary", depth_boundary_)
      .one_of({"walls", "periodic"})
      .doc("front and back of the box: smooth walls, or a periodic boundary");
  p.add("smallest_diameter", smallest_diameter_).unit("m").symbol("d_min").above(0).doc("of the grains");
  p.add("largest_diameter", largest_diameter_)
      .unit("m")
      .symbol("d_max")
      .above(0)
      .doc("of the grains; diameters are uniform by number in between");
  p.add("density", density_).unit("kg/m^3").symbol("rho").above(0).doc("of the grains");
  p.add("friction_angle", friction_angle_)
      .unit("rad")
      .symbol("mu")
      .at_least(0)
      .below(std::numbers::pi / 2)
      .doc("between grains, during shear; other parameters of the sand are overridden by /materials/sand");
  p.add("wall_friction_angle", wall_friction_angle_)
      .unit("rad")
      .at_least(0)
      .below(std::numbers::pi / 2)
      .doc("between grains and frames, bottom and platen; front and back are smooth");
  p.add("local_damping", local_damping_).symbol("lambda").at_least(0).below(1).doc("during shear");
  p.add("normal_stress", normal_stress_).unit("Pa").symbol("sigma_n").above(0).doc("on the platen, kept by a servo");
  p.add("void_ratio", void_ratio_)
      .symbol("e_0")
      .above(0)
      .doc("of the interior, one mean diameter or more off the walls, before shear; reached within 0.01 or failed");
  p.add("shear_displacement", shear_displacement_).unit("m").symbol("u").above(0).doc("of the upper frame");
  p.add("inertial_number", inertial_number_)
      .symbol("I")
      .above(0)
      .at_most(0.1)
      .doc("during shear, with the rate velocity over height; sets the velocity");
  p.add("velocity", velocity_).unit("m/s").at_least(0).doc("of the upper frame; 0: as the inertial number says");
  p.add("preparation_inertial_number", preparation_inertial_number_)
      .above(0)
      .at_most(0.1)
      .doc("during preparation; the faster, the less time it takes and the less uniform the specimen");
  p.add("seed", seed_).at_least(0).doc("of the grains' sizes and places");
  p.check(
      [this](const Complain& complain) {
        if (!(smallest_diameter_ <= largest_diameter_))
          complain("smallest_diameter", std::to_string(smallest_diameter_) + " m", "at most largest_diameter");
      },
      {"smallest_diameter", "largest_diameter"});
}

VoidRatioRange DirectShear::reachable() const { return {0.57, 0.79}; }

double DirectShear::shear_velocity() const {
  if (velocity_ > 0) return velocity_;
  return inertial_number_ * height_ / (mean_diameter() * std::sqrt(density_ / normal_stress_));
}

std::int64_t DirectShear::grains() const {
  // Mean of d³ of a uniform distribution.
  const double a = smallest_diameter_, b = largest_diameter_;
  const double cube = 0.25 * (a + b) * (a * a + b * b);
  const double solids = width_ * height_ * depth_ / (1 + void_ratio_);
  return std::llround(solids / (std::numbers::pi / 6 * cube));
}

Description DirectShear::expand() const {
  const VoidRatioRange range = reachable();
  if (void_ratio_ < range.densest || void_ratio_ > range.loosest) {
    std::ostringstream text;
    text.precision(3);
    text << "/scenario/void_ratio is " << void_ratio_ << "; this grading can be prepared between " << range.densest
         << " (frictionless compaction) and " << range.loosest << " (high friction, then its own) under "
         << normal_stress_ * 1e-3 << " kPa; wish for one in this range";
    throw Error(text.str());
  }
  if (const double shortest = std::min({width_, height_, depth_}); shortest < 4 * largest_diameter_)
    throw Error("/scenario: the box is " + std::to_string(shortest * 1e3) +
                " mm wide, high or deep, less than four of the largest grains; make it larger or the grains smaller");

  const double gap = largest_diameter_, middle = 0.5 * height_;
  const double cloud_height = height_ / (1 + void_ratio_) / cloud_solid_fraction;
  const double top = cloud_height + 2 * largest_diameter_;
  const double thickness = shear_displacement_ + 2 * largest_diameter_;
  const double velocity = shear_velocity(), duration = shear_displacement_ / velocity / (1 - 0.5 * start_share);
  const double area = width_ * depth_;
  // A grain moves its own size under the pressure in this time: the clock of everything inertial.
  const double inertial_time = mean_diameter() * std::sqrt(density_ / normal_stress_);
  const double preparation_speed = preparation_inertial_number_ * height_ / inertial_time;
  const double closing = (cloud_height - height_) / preparation_speed;
  const double settling = 200 * inertial_time / std::sqrt(preparation_inertial_number_ / 1e-2);
  const double over = std::max(0.2 * height_, 4 * largest_diameter_);
  // The aprons stand so far behind the faces of the frames that a grain pressed against a face does not feel them.
  const double behind = 0.1 * smallest_diameter_;
  const bool periodic = depth_boundary_ == "periodic";

  Description d;
  d["title"] = "direct shear, " + std::to_string(std::lround(normal_stress_ * 1e-3)) + " kPa, e0 = " + [&] {
    std::ostringstream e;
    e.precision(3);
    e << void_ratio_;
    return e.str();
  }();
  d["seed"] = seed_;
  d["contacts"] = {{"type", "linear-rolling"}};
  d["materials"]["sand"] = {{"density", density_}, {"friction_angle", friction_angle_}};
  d["materials"]["frame"] = {{"friction_angle", wall_friction_angle_}, {"rolling_limit", 0.0}};
  d["materials"]["smooth"] = {{"friction_angle", 0.0}, {"rolling_limit", 0.0}};

  const double reach = thickness + width_;
  d["domain"] = {{"low", vector(-reach, periodic ? 0 : -depth_, -height_)},
                 {"high", vector(width_ + reach, periodic ? depth_ : 2 * depth_, top + height_)},
                 {"periodic", {false, periodic, false}}};
  d["bodies"]["sand"] = {
      {"type", "sphere"},
      {"material", "sand"},
      {"grains",
       {{"type", "cloud"},
        {"low", vector(0, 0, 0)},
        {"high", vector(width_, depth_, cloud_height)},
        {"count", grains()},
        {"sizes", {{"type", "uniform"}, {"smallest", smallest_diameter_}, {"largest", largest_diameter_}}}}}};

  const auto wall = [](Description geometry, const char* material) {
    geometry["material"] = material;
    return geometry;
  };
  const auto plane = [&](const Description& point, const Description& normal, const char* material) {
    return wall({{"type", "plane"}, {"point", point}, {"normal", normal}}, material);
  };
  const auto block = [&](double x_low, double x_high, double z_low, double z_high) {
    return wall({{"type", "box"},
                 {"low", vector(x_low, -depth_, z_low)},
                 {"high", vector(x_high, 2 * depth_, z_high)},
                 {"inside", false}},
                "frame");
  };
  const auto apron = [&](double x, double z_low, double z_high, double facing) {
    // Seen from the sand, normal = edge_a × edge_b.
    const double y = facing > 0 ? -depth_ : 2 * depth_, along = facing > 0 ? 3 * depth_ : -3 * depth_;
    return wall({{"type", "rectangle"},
                 {"corner", vector(x, y, z_low)},
                 {"edge_a", vector(0, along, 0)},
                 {"edge_b", vector(0, 0, z_high - z_low)},
                 {"two_sided", false}},
                "smooth");
  };
  auto& walls = d["walls"];
  walls["bottom"] = plane(vector(0, 0, 0), vector(0, 0, 1), "frame");
  walls["lower-left"] = block(-thickness, 0, -4 * gap, middle - 0.5 * gap);
  walls["lower-right"] = block(width_, width_ + thickness, -4 * gap, middle - 0.5 * gap);
  walls["upper-left"] = block(-thickness, 0, middle + 0.5 * gap, top);
  walls["upper-right"] = block(width_, width_ + thickness, middle + 0.5 * gap, top);
  walls["lower-apron"] = apron(-behind, middle - gap, middle + 0.5 * gap + over, 1);
  walls["upper-apron"] = apron(width_ + behind, middle - 0.5 * gap - over, middle + gap, -1);
  walls["platen"] = wall({{"type", "rectangle"},
                          {"corner", vector(0, depth_, cloud_height)},
                          {"edge_a", vector(width_, 0, 0)},
                          {"edge_b", vector(0, -depth_, 0)},
                          {"two_sided", false}},
                         "frame");
  walls["platen"]["motion"]["servo"] = {
      {"axis", "z"}, {"pressure", normal_stress_}, {"max_velocity", preparation_speed}};
  if (!periodic) {
    walls["front"] = plane(vector(0, 0, 0), vector(0, 1, 0), "smooth");
    walls["back"] = plane(vector(0, depth_, 0), vector(0, -1, 0), "smooth");
  }
  d["specimen"] = {{"low", {"upper-left", periodic ? "" : "front", "bottom"}},
                   {"high", {"lower-right", periodic ? "" : "back", "platen"}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.3}};

  // Preparation: compacted with high friction, which is then lowered until the grains have settled far enough. Aprons
  // keep the gap between the frames closed, so that no sand is lost.
  const auto friction = [](double angle) -> Description { return {{"sand", {{"friction_angle", angle}}}}; };
  const double loose_angle = compaction_friction_angle(void_ratio_ + aim_above);
  Description compact;
  compact["name"] = "compact";
  compact["change"]["materials"] = friction(loose_angle);
  compact["until"] = {{"type", "all"},
                      {"of",
                       {{{"type", "pressure"}, {"wall", "platen"}, {"value", normal_stress_}, {"within", 0.02}},
                        {{"type", "unbalanced-force"}, {"below", 0.01}}}}};
  compact["limit"] = 3 * closing + 5 * settling;
  Description densify;
  densify["name"] = "densify";
  densify["ramps"] = Description::array({{{"pointer", "/materials/sand/friction_angle"},
                                          {"from", loose_angle},
                                          {"to", 0.0},
                                          {"duration", settling},
                                          {"increments", 100}}});
  densify["until"] = {{"type", "void-ratio"}, {"below", void_ratio_}};
  densify["limit"] = 5 * settling;
  Description settle;
  settle["name"] = "settle";
  settle["change"]["materials"] = friction(friction_angle_);
  settle["until"] = {{"type", "all"},
                     {"of",
                      {{{"type", "pressure"}, {"wall", "platen"}, {"value", normal_stress_}, {"within", 0.005}},
                       {{"type", "unbalanced-force"}, {"below", 2e-3}}}}};
  settle["limit"] = 15 * settling;
  settle["expect"] = {{"void_ratio", void_ratio_}, {"within", 0.01}};
  Description shear;
  shear["name"] = "shear";
  shear["change"]["engines"]["damping"]["coefficient"] = local_damping_;
  const Description drive = {{"velocity", vector(velocity, 0, 0)}, {"ramp_time", start_share * duration}};
  for (const char* wall : {"upper-left", "upper-right", "upper-apron", "platen"}) {
    auto& motion = shear["change"]["walls"][wall]["motion"];
    motion = drive;
    if (std::string(wall) != "platen") motion["follow"] = {{"wall", "platen"}, {"axes", "z"}};
  }
  shear["until"] = {{"type", "displacement"}, {"wall", "platen"}, {"axis", "x"}, {"value", shear_displacement_}};
  shear["limit"] = 1.1 * duration;
  d["stages"] = Description::array({compact, densify, settle, shear});

  const std::string tau = "-(upper_left_force_x + upper_right_force_x + upper_apron_force_x + platen_force_x) / area";
  auto& test = d["probes"]["test"];
  test = {{"type", "formula"}, {"stages", {"shear"}}, {"every_time", duration / curve_samples}};
  test["constants"] = {
      {"area", {{"value", area}, {"doc", "of the box, seen from above [m2]"}}},
      {"start_height", {{"value", cloud_height}, {"doc", "of the platen at the start of the run [m]"}}}};
  test["curves"]["shear_displacement"] = {
      {"formula", "platen_stage_travel_x"}, {"unit", "m"}, {"doc", "displacement of the upper frame"}};
  test["curves"]["shear_stress"] = {
      {"formula", tau}, {"unit", "Pa"}, {"doc", "horizontal force of the upper frame and platen over the box's area"}};
  test["curves"]["normal_stress"] = {
      {"formula", "platen_pressure"}, {"unit", "Pa"}, {"doc", "on the platen, compression positive"}};
  test["curves"]["stress_ratio"] = {
      {"formula", tau + " / platen_pressure"}, {"unit", "1"}, {"doc", "shear stress over normal stress"}};
  test["curves"]["volumetric_strain"] = {
      {"formula", "platen_stage_travel_z / (start_height + platen_travel_z - platen_stage_travel_z)"},
      {"unit", "1"},
      {"doc", "rise of the platen over the specimen's height, dilation positive"}};
  d["probes"]["walls"] = {{"type", "walls"}, {"every_time", duration / curve_samples}};
  d["probes"]["packing"] = {
      {"type", "packing"}, {"driven_by", "platen"}, {"driven_axis", "x"}, {"every_time", duration / 100}};
  d["probes"]["force-chains"] = {{"type", "force-chains"}, {"every_time", duration / 100}, {"stages", {"shear"}}};
  d["output"] = {{"frames", {{"every_time", duration / frames_in_shear}}},
                 {"picture",
                  {{"x", "test/shear_displacement"},
                   {"y", {"test/stress_ratio", "test/volumetric_strain"}},
                   {"color", "rotation"}}},
                 {"summary", {"test/stress_ratio", "test/volumetric_strain"}}};
  return d;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info = [] {
    grit::PluginInfo i;
    i.kind = "scenario", i.name = "direct-shear", i.version = "1.0.0";
    i.doc = "direct shear test of sand between two frames";
    i.make_scenario = []() -> grit::Scenario* { return new grit::DirectShear; };
    return i;
  }();
  return &info;
}
