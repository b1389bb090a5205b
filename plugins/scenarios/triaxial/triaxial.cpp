#include "triaxial.hpp"

#include <array>
#include <string_view>

#include "grit/plugin.hpp"
#include "grit/toolkit/analytical_solutions.hpp"
#include "grit/toolkit/homogeneity.hpp"

namespace grit {
namespace {

// Measured under 200 kPa, see plugins/scenarios/README.md.
constexpr std::array<Compacted, 7> compacted{{{0, 0.560},
                                              {2 * degree, 0.622},
                                              {5 * degree, 0.670},
                                              {10 * degree, 0.735},
                                              {18 * degree, 0.814},
                                              {30 * degree, 0.964},
                                              {60 * degree, 1.043}}};

// Fraction of the duration of compression in which it accelerates from rest.
constexpr double start_fraction = 0.02;
constexpr int curve_samples = 400, frames_in_shear = 10;

// The walls at the lower and upper end of an axis.
struct Pair {
  const char *low, *high;
};
constexpr std::array<Pair, 3> pairs{{{"left", "right"}, {"front", "back"}, {"bottom", "top"}}};
constexpr const char* letters[] = {"x", "y", "z"};

Description along(int axis, double value) {
  Vec3 v = Vec3::Zero();
  v[axis] = value;
  return vector(v.x(), v.y(), v.z());
}

/// Replaces $ by the axis, < and > by its walls.
std::string formula(std::string_view text, int axis) {
  std::string result;
  for (const char c : text) {
    if (c == '$') result += letters[axis];
    else if (c == '<') result += pairs[as_index(axis)].low;
    else if (c == '>') result += pairs[as_index(axis)].high;
    else result += c;
  }
  return result;
}
std::string length(int axis) { return formula("(start_$ + >_travel_$ - <_travel_$)", axis); }
std::string length_at_start(int axis) {
  return formula("(start_$ + >_travel_$ - <_travel_$ - >_stage_travel_$ + <_stage_travel_$)", axis);
}
std::string stress(int axis) {
  return formula("0.5 * (>_force_$ - <_force_$) / (", axis) + length((axis + 1) % 3) + " * " + length((axis + 2) % 3) +
         ")";
}

}  // namespace

Triaxial::Triaxial() { preparation_.smallest_diameter = 2.5e-3, preparation_.largest_diameter = 7.5e-3; }

void Triaxial::declare(Parameters& p) {
  p.add("size", size_).unit("m").above(0).doc("width, depth and height of the specimen at the target void ratio");
  preparation_.declare_sand(p);
  p.add("local_damping", local_damping_).symbol("lambda").at_least(0).below(1).doc("local damping during compression");
  p.add("confining_stress", confining_stress_)
      .unit("Pa")
      .symbol("sigma_c")
      .above(0)
      .doc("stress on all walls at first, on the lateral ones also during compression, kept by servos");
  preparation_.declare_void_ratio(p);
  p.add("front_and_back", front_and_back_)
      .one_of({"confining-stress", "held", "intermediate-stress"})
      .doc("front and back during compression: at the confining stress; held (plane strain); at intermediate_stress");
  p.add("intermediate_stress", intermediate_stress_)
      .unit("Pa")
      .symbol("sigma_2")
      .above(0)
      .doc("stress on front and back, for a true triaxial test");
  p.add("axial_strain", axial_strain_)
      .symbol("eps_1")
      .above(0)
      .below(1)
      .doc(
          "displacement of top and bottom at the end over the height in size; the specimen is slightly "
          "higher, its strain slightly smaller");
  p.add("inertial_number", inertial_number_)
      .symbol("I")
      .above(0)
      .at_most(0.1)
      .doc("inertial number during compression, with the confining stress; sets the rate of axial strain");
  p.add("internal_friction_angle", internal_friction_angle_)
      .unit("rad")
      .symbol("phi_i")
      .above(0)
      .below(std::numbers::pi / 2)
      .doc("internal friction angle of the sand, for Rankine's strength as a reference; default: no reference");
  preparation_.declare_course(p);
  preparation_.check_box(p, {{"size/0", &size_[0]}, {"size/1", &size_[1]}, {"size/2", &size_[2]}});
  p.check(
      [this](const Complain& complain) {
        const bool wanted = front_and_back_ == "intermediate-stress";
        if (wanted && !intermediate_stress_)
          complain("intermediate_stress", "none", "a stress, for front_and_back \"intermediate-stress\"");
        if (!wanted && intermediate_stress_)
          complain("intermediate_stress", "a stress with front_and_back \"" + front_and_back_ + '"',
                   "a stress with front_and_back \"intermediate-stress\" only");
        if (intermediate_stress_ && *intermediate_stress_ < confining_stress_)
          complain("intermediate_stress", quantity(*intermediate_stress_, "Pa"),
                   "at least confining_stress, " + quantity(confining_stress_, "Pa") + ", the minor stress");
      },
      {"front_and_back", "intermediate_stress", "confining_stress"});
}

VoidRatioRange Triaxial::reachable() const { return preparation_.reachable(size_, 0.80); }

double Triaxial::strain_rate() const { return inertial_number_ / preparation_.inertial_time(confining_stress_); }

Description Triaxial::expand() const {
  preparation_.require_reachable(reachable(), confining_stress_);

  const double swollen = std::cbrt(preparation_.in_cloud(1));
  const Vec3 cloud = swollen * size_;
  const double closing = (swollen - 1) * size_.z() / preparation_.closing_speed(size_.z(), confining_stress_);
  const double duration = axial_strain_ / strain_rate() / (1 - 0.5 * start_fraction);

  Description d;
  d["title"] = "triaxial compression, " + preparation_.conditions(confining_stress_);
  d["seed"] = preparation_.seed;
  d["contacts"] = {{"type", "linear-rolling"}};
  d["materials"]["sand"] = preparation_.sand();
  d["materials"]["wall"] = {{"friction_angle", 0.0}, {"rolling_limit", 0.0}};
  const auto corner = [](const Vec3& v) { return vector(v.x(), v.y(), v.z()); };
  // The specimen may widen to 1 / (1 − ε) of its length, about its centre.
  const Vec3 wide = cloud.cwiseMax(0.6 * size_ / (1 - axial_strain_));
  d["domain"] = {{"low", corner(-wide)}, {"high", corner(wide)}};
  d["bodies"]["sand"] =
      preparation_.cloud(corner(-0.5 * cloud), corner(0.5 * cloud), preparation_.grains(size_.prod()));

  // Two walls share the displacement along an axis.
  const auto servo_speed = [&](int axis) { return 0.5 * preparation_.closing_speed(size_[axis], confining_stress_); };
  std::vector<std::string> names;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const std::string name = side < 0 ? pairs[as_index(axis)].low : pairs[as_index(axis)].high;
      Description wall = plane(along(axis, 0.5 * side * cloud[axis]), along(axis, -side), "wall");
      wall["extent"] = cloud.maxCoeff();
      // Stress refers to the present cross-section of the specimen; the walls are larger.
      wall["motion"]["servo"] = {{"axis", letters[axis]},
                                 {"pressure", confining_stress_},
                                 {"area", "specimen"},
                                 {"max_velocity", servo_speed(axis)}};
      d["walls"][name] = wall;
      names.push_back(name);
    }
  d["specimen"] = {{"low", {"left", "front", "bottom"}}, {"high", {"right", "back", "top"}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", Preparation::local_damping}};

  auto stages = preparation_.stages(d["walls"], names, confining_stress_, closing, compacted);
  const auto hold = [](Description& stage, const char* wall) { stage["change"]["walls"][wall]["motion"] = nullptr; };
  if (intermediate_stress_) {
    // Slow compared with the inertial time. The front is held, so that one ramp is enough.
    Description load;
    load["name"] = "load";
    hold(load, "front");
    const double time = preparation_.settling_time(confining_stress_);
    load["ramps"] = Description::array({{{"pointer", "/walls/back/motion/servo/pressure"},
                                         {"from", confining_stress_},
                                         {"to", *intermediate_stress_},
                                         {"duration", time},
                                         {"increments", 200}}});
    load["until"] = {{"type", "time"}, {"value", 1.2 * time}};
    load["limit"] = 2 * time;
    stages.push_back(load);
  }
  Description shear;
  shear["name"] = "shear";
  shear["change"]["engines"]["damping"]["coefficient"] = local_damping_;
  for (const int side : {-1, 1})
    shear["change"]["walls"][side < 0 ? "bottom" : "top"]["motion"] = {
        {"servo", nullptr},
        {"velocity", along(2, -0.5 * side * strain_rate() * size_.z())},
        {"ramp_time", start_fraction * duration}};
  if (front_and_back_ == "held") hold(shear, "front"), hold(shear, "back");
  // The specimen widens faster as its height decreases: at most by all of its volume, and as much again for dilation,
  // along one axis.
  const double widening = 2 * strain_rate() / std::pow(1 - axial_strain_, 2);
  for (int axis = 0; axis < (front_and_back_ == "held" ? 1 : 2); ++axis) {
    const bool single = axis == 1 && intermediate_stress_;  // the front is held
    const double needed = (single ? 1 : 0.5) * widening * size_[axis];
    if (needed <= servo_speed(axis)) continue;
    for (const char* wall : {pairs[as_index(axis)].low, pairs[as_index(axis)].high})
      if (!single || wall == pairs[as_index(axis)].high)
        shear["change"]["walls"][wall]["motion"]["servo"]["max_velocity"] = needed;
  }
  shear["until"] = {
      {"type", "displacement"}, {"wall", "top"}, {"axis", "z"}, {"value", -0.5 * axial_strain_ * size_.z()}};
  shear["limit"] = 1.1 * duration;
  stages.push_back(shear);
  d["stages"] = stages;

  const std::string major = stress(2), minor = stress(0), volume = length(0) + " * " + length(1) + " * " + length(2),
                    volume_at_start = length_at_start(0) + " * " + length_at_start(1) + " * " + length_at_start(2);
  auto& test = d["probes"]["test"];
  test = {{"type", "formula"}, {"stages", {"shear"}}, {"every_time", duration / curve_samples}};
  for (int axis = 0; axis < 3; ++axis)
    test["constants"][std::string("start_") + letters[axis]] = {
        {"value", cloud[axis]}, {"doc", "distance of the walls at the start of the run [m]"}};
  const auto curve = [&](const char* name, const std::string& formula, const char* unit, const char* doc) {
    test["curves"][name] = {{"formula", formula}, {"unit", unit}, {"doc", doc}};
  };
  curve("axial_strain", "1 - " + length(2) + " / " + length_at_start(2), "1",
        "displacement of top and bottom over the height before compression, compression positive");
  curve("sigma_1", major, "Pa", "axial stress, mean of top and bottom, over the present cross-section");
  curve("sigma_2", stress(1), "Pa", "stress on front and back, over the present cross-section");
  curve("sigma_3", minor, "Pa", "stress on left and right, over the present cross-section");
  curve("volumetric_strain", volume + " / (" + volume_at_start + ") - 1", "1",
        "change of volume over volume before compression, dilation positive");
  curve("friction_angle", "180 / _pi * asin((" + major + " - " + minor + ") / (" + major + " + " + minor + "))",
        "degree", "mobilised friction angle, asin((sigma_1 - sigma_3) / (sigma_1 + sigma_3))");
  d["probes"]["walls"] = {{"type", "walls"}, {"every_time", duration / curve_samples}};
  d["probes"]["packing"] = {{"type", "packing"}, {"shear_rate", strain_rate()}, {"every_time", duration / 100}};
  d["probes"]["force-chains"] = {{"type", "force-chains"}, {"every_time", duration / 100}, {"stages", {"shear"}}};
  d["output"] = {{"frames", {{"every_time", duration / frames_in_shear}}},
                 {"picture",
                  {{"x", "test/axial_strain"},
                   {"y", {"test/sigma_1", "test/friction_angle", "test/volumetric_strain"}},
                   {"color", "rotation"}}},
                 {"summary", {"test/sigma_1", "test/friction_angle", "test/volumetric_strain"}}};
  add_homogeneity_probes(d, "");
  if (internal_friction_angle_) {
    const double strength = confining_stress_ * analytical_solutions::rankine_passive(*internal_friction_angle_);
    d["output"]["references"] = {
        {"Rankine_strength", {{"of", "test/sigma_1"}, {"value", strength}}},
        {"Rankine_friction_angle", {{"of", "test/friction_angle"}, {"value", *internal_friction_angle_ / degree}}}};
  }
  return d;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "scenario",
      .name = "triaxial",
      .version = "1.0.0",
      .doc = "triaxial, plane strain or true triaxial test of sand between six smooth walls",
      .make_scenario = []() -> grit::Scenario* { return new grit::Triaxial; }};
  return &info;
}
