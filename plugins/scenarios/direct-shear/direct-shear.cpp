#include "direct-shear.hpp"

#include <algorithm>

#include "grit/plugin.hpp"
#include "grit/toolkit/homogeneity.hpp"

namespace grit {
namespace {

// Fraction of the duration of shear in which it accelerates from rest.
constexpr double start_fraction = 0.02;
constexpr int curve_samples = 400, frames_in_shear = 10;

}  // namespace

void DirectShear::declare(Parameters& p) {
  p.add("width", width_).unit("m").above(0).doc("inner length of the box, in the direction of shear");
  p.add("height", height_).unit("m").above(0).doc("height of the specimen at the target void ratio");
  p.add("depth", depth_).unit("m").above(0).doc("inner depth of the box, across the direction of shear");
  p.add("depth_boundary", depth_boundary_)
      .one_of({"walls", "periodic"})
      .doc("front and back of the box: smooth walls, or a periodic boundary");
  preparation_.declare_sand(p);
  p.add("wall_friction_angle", wall_friction_angle_)
      .unit("rad")
      .at_least(0)
      .below(std::numbers::pi / 2)
      .doc("friction angle between grains and frames, bottom and platen; front and back are smooth");
  p.add("local_damping", local_damping_).symbol("lambda").at_least(0).below(1).doc("local damping during shear");
  p.add("normal_stress", normal_stress_)
      .unit("Pa")
      .symbol("sigma_n")
      .above(0)
      .doc("normal stress on the platen, kept by a servo");
  preparation_.declare_void_ratio(p);
  p.add("shear_displacement", shear_displacement_)
      .unit("m")
      .symbol("u")
      .above(0)
      .doc("displacement of the upper frame during shear");
  p.add("inertial_number", inertial_number_)
      .symbol("I")
      .above(0)
      .at_most(0.1)
      .doc("inertial number during shear, for the rate velocity over height; sets the velocity");
  p.add("velocity", velocity_).unit("m/s").at_least(0).doc("velocity of the upper frame; 0: from the inertial number");
  preparation_.declare_course(p);
  preparation_.check_box(p, {{"width", &width_}, {"height", &height_}, {"depth", &depth_}});
}

VoidRatioRange DirectShear::reachable() const {
  return preparation_.reachable({width_, depth_boundary_ == "periodic" ? infinity : depth_, height_}, loosest_in_a_box);
}

double DirectShear::shear_velocity() const {
  if (velocity_ > 0) return velocity_;
  return inertial_number_ * height_ / preparation_.inertial_time(normal_stress_);
}

Description DirectShear::expand() const {
  preparation_.require_reachable(reachable(), normal_stress_);

  const double grain = preparation_.largest_diameter, gap = grain, middle = 0.5 * height_;
  const double cloud_height = preparation_.in_cloud(height_);
  const double top = cloud_height + 2 * grain;
  const double thickness = shear_displacement_ + 2 * grain;
  const double velocity = shear_velocity(), duration = shear_displacement_ / velocity / (1 - 0.5 * start_fraction);
  const double area = width_ * depth_;
  const double preparation_speed = preparation_.closing_speed(height_, normal_stress_);
  const double closing = (cloud_height - height_) / preparation_speed;
  const double over = std::max(0.2 * height_, 4 * grain);
  // Aprons are far enough behind the faces of the frames not to touch grains pressed against a face.
  const double behind = 0.1 * preparation_.smallest_diameter;
  const bool periodic = depth_boundary_ == "periodic";

  Description d;
  d["title"] = "direct shear, " + preparation_.conditions(normal_stress_);
  d["seed"] = preparation_.seed;
  d["contacts"] = {{"type", "linear-rolling"}};
  d["materials"]["sand"] = preparation_.sand();
  d["materials"]["frame"] = {{"friction_angle", wall_friction_angle_}, {"rolling_limit", 0.0}};
  d["materials"]["smooth"] = {{"friction_angle", 0.0}, {"rolling_limit", 0.0}};

  const double reach = thickness + width_;
  d["domain"] = {{"low", vector(-reach, periodic ? 0 : -depth_, -height_)},
                 {"high", vector(width_ + reach, periodic ? depth_ : 2 * depth_, top + height_)},
                 {"periodic", {false, periodic, false}}};
  d["bodies"]["sand"] = preparation_.cloud(vector(0, 0, 0), vector(width_, depth_, cloud_height),
                                           preparation_.grains(width_ * height_ * depth_));

  const auto frame = [&](double x_low, double x_high, double z_low, double z_high) {
    return block(vector(x_low, -depth_, z_low), vector(x_high, 2 * depth_, z_high), "frame");
  };
  const auto apron = [&](double x, double z_low, double z_high, double facing) {
    // Seen from the sand, normal = edge_a × edge_b.
    const double y = facing > 0 ? -depth_ : 2 * depth_, along = facing > 0 ? 3 * depth_ : -3 * depth_;
    return rectangle(vector(x, y, z_low), vector(0, along, 0), vector(0, 0, z_high - z_low), "smooth");
  };
  auto& walls = d["walls"];
  walls["bottom"] = plane(vector(0, 0, 0), vector(0, 0, 1), "frame");
  walls["lower-left"] = frame(-thickness, 0, -4 * gap, middle - 0.5 * gap);
  walls["lower-right"] = frame(width_, width_ + thickness, -4 * gap, middle - 0.5 * gap);
  walls["upper-left"] = frame(-thickness, 0, middle + 0.5 * gap, top);
  walls["upper-right"] = frame(width_, width_ + thickness, middle + 0.5 * gap, top);
  walls["lower-apron"] = apron(-behind, middle - gap, middle + 0.5 * gap + over, 1);
  walls["upper-apron"] = apron(width_ + behind, middle - 0.5 * gap - over, middle + gap, -1);
  walls["platen"] = rectangle(vector(0, depth_, cloud_height), vector(width_, 0, 0), vector(0, -depth_, 0), "frame");
  walls["platen"]["motion"]["servo"] = {
      {"axis", "z"}, {"pressure", normal_stress_}, {"max_velocity", preparation_speed}};
  if (!periodic) {
    walls["front"] = plane(vector(0, 0, 0), vector(0, 1, 0), "smooth");
    walls["back"] = plane(vector(0, depth_, 0), vector(0, -1, 0), "smooth");
  }
  d["specimen"] = {{"low", {"upper-left", periodic ? "" : "front", "bottom"}},
                   {"high", {"lower-right", periodic ? "" : "back", "platen"}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", Preparation::local_damping}};

  // Aprons close the gap between the frames, so that no sand is lost.
  auto stages = preparation_.stages(d["walls"], {"platen"}, normal_stress_, closing, compacted_in_a_box);
  Description shear;
  shear["name"] = "shear";
  shear["change"]["engines"]["damping"]["coefficient"] = local_damping_;
  const Description drive = {{"velocity", vector(velocity, 0, 0)}, {"ramp_time", start_fraction * duration}};
  for (const char* wall : {"upper-left", "upper-right", "upper-apron", "platen"}) {
    auto& motion = shear["change"]["walls"][wall]["motion"];
    motion = drive;
    if (std::string(wall) != "platen") motion["follow"] = {{"wall", "platen"}, {"axes", "z"}};
  }
  Preparation::raise_servo_limit(shear, "platen", preparation_speed, velocity);
  shear["until"] = {{"type", "displacement"}, {"wall", "platen"}, {"axis", "x"}, {"value", shear_displacement_}};
  shear["limit"] = 1.1 * duration;
  stages.push_back(shear);
  d["stages"] = stages;

  const std::string tau = "-(upper_left_force_x + upper_right_force_x + upper_apron_force_x + platen_force_x) / area";
  auto& test = d["probes"]["test"];
  test = {{"type", "formula"}, {"stages", {"shear"}}, {"every_time", duration / curve_samples}};
  test["constants"] = {
      {"area", {{"value", area}, {"doc", "area of the box in plan [m2]"}}},
      {"start_height", {{"value", cloud_height}, {"doc", "height of the platen at the start of the run [m]"}}}};
  test["curves"]["shear_displacement"] = {
      {"formula", "platen_stage_travel_x"}, {"unit", "m"}, {"doc", "displacement of the upper frame"}};
  test["curves"]["shear_stress"] = {
      {"formula", tau},
      {"unit", "Pa"},
      {"doc", "horizontal force on upper frame, apron and platen over the area of the box"}};
  test["curves"]["normal_stress"] = {
      {"formula", "platen_pressure"}, {"unit", "Pa"}, {"doc", "pressure on the platen, compression positive"}};
  test["curves"]["stress_ratio"] = {
      {"formula", tau + " / platen_pressure"}, {"unit", "1"}, {"doc", "shear stress over normal stress"}};
  test["curves"]["volumetric_strain"] = {
      {"formula", "platen_stage_travel_z / (start_height + platen_travel_z - platen_stage_travel_z)"},
      {"unit", "1"},
      {"doc", "rise of the platen over the height of the specimen, dilation positive"}};
  d["probes"]["walls"] = {{"type", "walls"}, {"every_time", duration / curve_samples}};
  d["probes"]["packing"] = {
      {"type", "packing"}, {"driven_by", "platen"}, {"driven_axis", "x"}, {"every_time", duration / 100}};
  for (const char* type : {"force-chains", "rotations", "displacements", "strain"})
    d["probes"][type] = {{"type", type}, {"every_time", duration / 100}, {"stages", {"shear"}}};
  d["probes"]["displacements"]["strips"] = 5;
  d["output"] = {{"frames", {{"every_time", duration / frames_in_shear}}},
                 {"picture",
                  {{"x", "test/shear_displacement"},
                   {"y", {"test/stress_ratio", "test/volumetric_strain"}},
                   {"color", "rotation"}}},
                 {"summary", {"test/stress_ratio", "test/volumetric_strain"}}};
  add_homogeneity_probes(d, "y");
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
