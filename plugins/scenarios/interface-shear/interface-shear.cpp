#include "interface-shear.hpp"

#include <algorithm>

#include "grit/plugin.hpp"
#include "grit/toolkit/analytical_solutions.hpp"
#include "grit/toolkit/homogeneity.hpp"
#include "grit/toolkit/lengths.hpp"

namespace grit {
namespace {

// Fraction of the duration of shear in which it accelerates from rest.
constexpr double start_fraction = 0.02;
constexpr int curve_samples = 400, frames_in_shear = 10;
// Default for the wall contact factor.
constexpr double usual_internal_friction = 44 * degree;

}  // namespace

void InterfaceShear::declare(Parameters& p) {
  p.add("width", width_).unit("m").above(0).doc("inner length of the box, in the direction of shear");
  p.add("height", height_)
      .unit("m")
      .above(0)
      .doc("height of the specimen above the tips of the surface, at the target void ratio");
  p.add("depth", depth_).unit("m").above(0).doc("inner depth of the box, across the direction of shear");
  p.add("depth_boundary", depth_boundary_)
      .one_of({"walls", "periodic"})
      .doc("front and back of the box: smooth walls, or a periodic boundary");
  p.add("surface", surface_).one_of({"flat", "saw-tooth", "sinusoidal"}).doc("shape of the surface");
  p.add("roughness", roughness_)
      .symbol("R_n")
      .above(0)
      .doc("of a saw-tooth surface: groove depth over the mean diameter");
  p.add("groove_inclination", groove_inclination_)
      .unit("rad")
      .above(0)
      .below(std::numbers::pi / 2)
      .doc(
          "angle of the flanks of a saw-tooth surface; default: 45 deg, or with groove_spacing the angle for grooves "
          "side by side");
  p.add("groove_spacing", groove_spacing_)
      .unit("m")
      .above(0)
      .doc(
          "period of the grooves of a saw-tooth surface; default: grooves side by side; flats remain where grooves are "
          "narrower by groove_inclination");
  p.add("depth_over_wavelength", depth_over_wavelength_)
      .symbol("d/l")
      .at_least(0)
      .doc("of a sinusoidal surface: depth from crest to trough over the wavelength");
  p.add("wavelength", wavelength_).unit("m").symbol("l").above(0).doc("wavelength of a sinusoidal surface");
  p.add("surface_friction_angle", surface_friction_angle_)
      .unit("rad")
      .at_least(0)
      .below(std::numbers::pi / 2)
      .doc("friction angle between grains and surface; box and lid are smooth");
  p.add("gap", gap_)
      .unit("m")
      .at_least(0)
      .doc("distance of the box from the tips of the surface during shear; 0: the largest diameter");
  preparation_.declare_sand(p);
  p.add("local_damping", local_damping_).symbol("lambda").at_least(0).below(1).doc("local damping during shear");
  p.add("normal_stress", normal_stress_)
      .unit("Pa")
      .symbol("sigma_n")
      .above(0)
      .doc("normal stress on the lid, kept by a servo");
  preparation_.declare_void_ratio(p);
  p.add("shear_displacement", shear_displacement_)
      .unit("m")
      .symbol("u")
      .above(0)
      .doc("displacement of the box during shear");
  p.add("inertial_number", inertial_number_)
      .symbol("I")
      .above(0)
      .at_most(0.1)
      .doc("inertial number during shear, for the rate velocity over height; sets the velocity");
  p.add("internal_friction_angle", internal_friction_angle_)
      .unit("rad")
      .symbol("phi_i")
      .above(0)
      .below(std::numbers::pi / 2)
      .doc(
          "internal friction angle of the sand, for the wall contact factor only; default: 44 deg; "
          "if given, wall friction by EN 1991-4 is drawn as a reference");
  preparation_.declare_course(p);
  preparation_.check_box(p, {{"width", &width_}, {"height", &height_}, {"depth", &depth_}});
  p.check(
      [this](const Complain& complain) {
        if (surface_ == "saw-tooth")
          check_groove_spacing(complain, groove_spacing_.value_or(0),
                               2 * groove_depth() / std::tan(groove_inclination()), width_);
      },
      {"groove_spacing", "roughness", "groove_inclination", "surface", "width"});
  p.check(
      [this](const Complain& complain) {
        const double of_the_sand = preparation_.friction_angle;
        if (surface_friction_angle_ > of_the_sand)
          complain("surface_friction_angle", quantity(surface_friction_angle_ / degree, "deg"),
                   "at most friction_angle, " + quantity(of_the_sand / degree, "deg") +
                       ": contacts have the smaller of both; or set /interfaces/sand+surface");
      },
      {"surface_friction_angle", "friction_angle"});
  p.check(
      [this](const Complain& complain) {
        if (gap_ >= height_) complain("gap", metres(gap_), "less than the height of the specimen, " + metres(height_));
      },
      {"gap", "height"});
}

VoidRatioRange InterfaceShear::reachable() const {
  return preparation_.reachable({width_, depth_boundary_ == "periodic" ? infinity : depth_, height_}, loosest_in_a_box);
}

double InterfaceShear::shear_velocity() const {
  return inertial_number_ * height_ / preparation_.inertial_time(normal_stress_);
}

double InterfaceShear::groove_depth() const {
  if (surface_ == "saw-tooth") return roughness_ * preparation_.mean_diameter();
  return surface_ == "sinusoidal" ? depth_over_wavelength_ * wavelength_ : 0;
}

double InterfaceShear::groove_inclination() const {
  if (groove_inclination_) return *groove_inclination_;
  return groove_spacing_ ? std::atan(2 * groove_depth() / *groove_spacing_) : 45 * degree;
}

double InterfaceShear::groove_spacing() const {
  if (surface_ == "sinusoidal") return wavelength_;
  return groove_spacing_.value_or(2 * groove_depth() / std::tan(groove_inclination()));
}

double InterfaceShear::groove_volume() const {
  if (surface_ == "sinusoidal") return 0.5 * groove_depth();
  return surface_ == "flat" ? 0 : groove_depth() * groove_depth() / std::tan(groove_inclination()) / groove_spacing();
}

Description InterfaceShear::surface(double reach) const {
  // Whole grooves before the box: it starts at a tip.
  const double before = surface_ == "flat" ? reach : std::ceil(reach / groove_spacing()) * groove_spacing();
  Description d =
      rectangle(vector(-before, -depth_, 0), vector(2 * before + width_, 0, 0), vector(0, 3 * depth_, 0), "surface");
  if (surface_ == "flat") return d;
  d.erase("two_sided");
  d["type"] = surface_;
  d["depth"] = groove_depth();
  if (surface_ == "sinusoidal") {
    d["wavelength"] = wavelength_;
  } else {
    d["inclination"] = groove_inclination();
    if (groove_spacing_ && groove_inclination_) d["spacing"] = *groove_spacing_;
  }
  return d;
}

Description InterfaceShear::expand() const {
  preparation_.require_reachable(reachable(), normal_stress_);

  const double grain = preparation_.largest_diameter, gap = gap_ > 0 ? gap_ : grain;
  const double area = width_ * depth_;
  const double filled = height_ + groove_volume();  // with the sand in the grooves
  const double cloud_height = preparation_.in_cloud(filled);
  const double top = cloud_height + 2 * grain + gap, thickness = shear_displacement_ + 2 * grain;
  const double velocity = shear_velocity(), duration = shear_displacement_ / velocity / (1 - 0.5 * start_fraction);
  const double preparation_speed = preparation_.closing_speed(height_, normal_stress_);
  const double closing = (cloud_height - height_) / preparation_speed;
  const bool periodic = depth_boundary_ == "periodic";

  Description d;
  d["title"] = "interface shear on a " + surface_ + " surface, " + preparation_.conditions(normal_stress_);
  d["seed"] = preparation_.seed;
  d["contacts"] = {{"type", "linear-rolling"}};
  d["materials"]["sand"] = preparation_.sand();
  d["materials"]["surface"] = {{"friction_angle", surface_friction_angle_}};
  d["materials"]["smooth"] = {{"friction_angle", 0.0}, {"rolling_limit", 0.0}};

  const double reach = thickness + width_;
  d["domain"] = {{"low", vector(-reach, periodic ? 0 : -depth_, -height_ - groove_depth())},
                 {"high", vector(width_ + reach, periodic ? depth_ : 2 * depth_, top + height_)},
                 {"periodic", {false, periodic, false}}};
  d["bodies"]["sand"] =
      preparation_.cloud(vector(0, 0, 0), vector(width_, depth_, cloud_height), preparation_.grains(area * filled));

  auto& walls = d["walls"];
  walls["surface"] = surface(reach + shear_displacement_);
  walls["left"] = block(vector(-thickness, -depth_, 0), vector(0, 2 * depth_, top), "smooth");
  walls["right"] = block(vector(width_, -depth_, 0), vector(width_ + thickness, 2 * depth_, top), "smooth");
  walls["lid"] = rectangle(vector(0, depth_, cloud_height), vector(width_, 0, 0), vector(0, -depth_, 0), "smooth");
  walls["lid"]["motion"]["servo"] = {{"axis", "z"}, {"pressure", normal_stress_}, {"max_velocity", preparation_speed}};
  if (!periodic) {
    walls["front"] = plane(vector(0, 0, 0), vector(0, 1, 0), "smooth");
    walls["back"] = plane(vector(0, depth_, 0), vector(0, -1, 0), "smooth");
  }
  d["specimen"] = {{"low", {"left", periodic ? "" : "front", "surface"}},
                   {"high", {"right", periodic ? "" : "back", "lid"}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", Preparation::local_damping}};

  // During preparation the box stands on the tips, so that no sand is lost. It is lifted before shear.
  auto stages = preparation_.stages(d["walls"], {"lid"}, normal_stress_, closing, compacted_in_a_box);
  Description lift, shear;
  lift["name"] = "lift";
  for (const char* wall : {"left", "right"})
    lift["change"]["walls"][wall]["motion"] = {{"velocity", vector(0, 0, preparation_speed)}};
  lift["until"] = {{"type", "displacement"}, {"wall", "left"}, {"axis", "z"}, {"value", gap}};
  lift["limit"] = 2 * gap / preparation_speed;
  shear["name"] = "shear";
  shear["change"]["engines"]["damping"]["coefficient"] = local_damping_;
  for (const char* wall : {"left", "right", "lid"})
    shear["change"]["walls"][wall]["motion"] = {{"velocity", vector(velocity, 0, 0)},
                                                {"ramp_time", start_fraction * duration}};
  Preparation::raise_servo_limit(shear, "lid", preparation_speed, velocity);
  shear["until"] = {{"type", "displacement"}, {"wall", "lid"}, {"axis", "x"}, {"value", shear_displacement_}};
  shear["limit"] = 1.1 * duration;
  stages.push_back(lift), stages.push_back(shear);
  d["stages"] = stages;

  const std::string mu = "surface_force_x / lid_force_z";
  auto& test = d["probes"]["test"];
  test = {{"type", "formula"}, {"stages", {"shear"}}, {"every_time", duration / curve_samples}};
  const auto constant = [&](const char* name, double value, const char* doc) {
    test["constants"][name] = {{"value", value}, {"doc", doc}};
  };
  const auto curve = [&](const char* name, const std::string& formula, const char* unit, const char* doc) {
    test["curves"][name] = {{"formula", formula}, {"unit", unit}, {"doc", doc}};
  };
  constant("area", area, "area of the box in plan [m2]");
  constant("start_height", cloud_height, "height of the lid above the tips at the start of the run [m]");
  constant("tan_phi_i", std::tan(internal_friction_angle_.value_or(usual_internal_friction)),
           "internal friction coefficient of the sand");
  constant("mu_w", std::tan(surface_friction_angle_), "friction coefficient of a flat surface");
  curve("shear_displacement", "lid_stage_travel_x", "m", "displacement of the box");
  curve("shear_stress", "surface_force_x / area", "Pa", "horizontal force on the surface over the area of the box");
  curve("normal_stress", "lid_pressure", "Pa", "pressure on the lid, compression positive");
  curve("stress_ratio", mu, "1", "mu_eff: horizontal force on the surface over the force on the lid");
  curve("friction_angle", "180 / _pi * atan(" + mu + ")", "degree", "phi_s of the interface, from the stress ratio");
  curve("volumetric_strain", "lid_stage_travel_z / (start_height + lid_travel_z - lid_stage_travel_z)", "1",
        "rise of the lid over the height of the specimen above the tips, dilation positive");
  curve("wall_contact_factor", "(" + mu + " - tan_phi_i) / (mu_w - tan_phi_i)", "1",
        "a_w of EN 1991-4: 1 if the sand slides on the surface, 0 if it shears internally");
  for (const char* type : {"slip", "interface"})
    d["probes"][type] = {{"type", type}, {"wall", "surface"},   {"driven_by", "lid"},
                         {"axis", "x"},  {"stages", {"shear"}}, {"every_time", duration / curve_samples}};
  d["probes"]["walls"] = {{"type", "walls"}, {"every_time", duration / curve_samples}};
  d["probes"]["packing"] = {
      {"type", "packing"}, {"driven_by", "lid"}, {"driven_axis", "x"}, {"every_time", duration / 100}};
  for (const char* type : {"force-chains", "rotations", "displacements", "strain"})
    d["probes"][type] = {{"type", type}, {"every_time", duration / 100}, {"stages", {"shear"}}};
  d["probes"]["displacements"]["strips"] = 5;
  d["probes"]["strain"]["sliding"] = {{"wall", "surface"}, {"driven_by", "lid"}};
  d["output"] = {{"frames", {{"every_time", duration / frames_in_shear}}},
                 {"picture",
                  {{"x", "test/shear_displacement"},
                   {"y", {"test/friction_angle", "test/volumetric_strain", "slip/fraction"}},
                   {"color", "rotation"}}},
                 {"summary", {"test/friction_angle", "test/volumetric_strain", "slip/fraction"}}};
  add_homogeneity_probes(d, "y");
  if (internal_friction_angle_) {
    using namespace analytical_solutions;
    const double factor = usual_wall_contact_factor(groove_depth(), preparation_.mean_diameter());
    const double friction =
        effective_wall_friction(factor, std::tan(surface_friction_angle_), *internal_friction_angle_);
    const auto beside = [&](const char* name, const char* curve, double value) {
      d["output"]["references"][name] = {{"of", std::string("test/") + curve}, {"value", value}};
    };
    beside("EN_1991-4_effective_wall_friction", "stress_ratio", friction);
    beside("EN_1991-4_effective_wall_friction_angle", "friction_angle", std::atan(friction) / degree);
    beside("EN_1991-4_wall_contact_factor", "wall_contact_factor", factor);
  }
  return d;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "scenario",
                                     .name = "interface-shear",
                                     .version = "1.0.0",
                                     .doc = "shear of sand on a flat, saw-tooth or sinusoidal surface",
                                     .make_scenario = []() -> grit::Scenario* { return new grit::InterfaceShear; }};
  return &info;
}
