// A plane silo between two smooth panes, and its filling, for the silo scenarios. See silo.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/scenario.hpp"
#include "grit/toolkit/analytical_solutions.hpp"
#include "grit/toolkit/lengths.hpp"
#include "grit/toolkit/wall_descriptions.hpp"

namespace grit {

/// Parameters of one analytical solution that override those of SiloForms.
struct SiloForm {
  std::optional<double> stress_ratio, wall_friction_angle, unit_weight;

  void declare(Parameters& p) {
    p.add("stress_ratio", stress_ratio)
        .symbol("K")
        .above(0)
        .doc("horizontal over vertical stress; default: that of analytical_solutions");
    p.add("wall_friction_angle", wall_friction_angle)
        .unit("rad")
        .symbol("phi_w")
        .above(0)
        .below(std::numbers::pi / 2)
        .doc("wall friction angle; default: that of analytical_solutions");
    p.add("unit_weight", unit_weight)
        .unit("N/m^3")
        .symbol("gamma")
        .above(0)
        .doc("unit weight of the bulk; default: that at the expected void ratio of the filling");
  }
};

/// Parameters of analytical solutions to compare with; they do not act on the grains.
struct SiloForms {
  double internal_friction_angle = 36 * std::numbers::pi / 180;
  std::optional<double> stress_ratio, wall_friction_angle;
  std::optional<SiloForm> drescher, en_1991_4;

  void declare(Parameters& p) {
    p.add("internal_friction_angle", internal_friction_angle)
        .unit("rad")
        .symbol("phi_i")
        .above(0)
        .below(std::numbers::pi / 2)
        .doc("internal friction angle of the sand; the default is that of sand in EN 1991-4");
    p.add("stress_ratio", stress_ratio)
        .symbol("K")
        .above(0)
        .doc("horizontal over vertical stress; default: 1.1 (1 - sin phi_i) of EN 1991-4");
    p.add("wall_friction_angle", wall_friction_angle)
        .unit("rad")
        .symbol("phi_w")
        .above(0)
        .below(std::numbers::pi / 2)
        .doc("wall friction angle; default: by EN 1991-4; for a flat or nearly flat wall that of its surface");
    p.add("drescher", drescher).doc("bottom force P after Drescher, with friction on one wall; silo-quasistatic only");
    p.add("en_1991_4", en_1991_4).doc("bottom force P by EN 1991-4 with its own parameters; silo-quasistatic only");
  }
};

/// Parameters and parts of the description of a silo.
struct Silo {
  static constexpr double gravity = analytical_solutions::gravity;
  /// Solid fraction of the cloud that falls into the silo.
  static constexpr double cloud_solid_fraction = 0.35;
  /// Default limit of the displacement per step over the radius.
  static constexpr double usual_travel = 0.05;
  /// Time in which fallen sand came to rest, from heights of 60 mm to 0.5 m [s]; for estimates.
  static constexpr double usual_rest = 0.25;
  /// Maximum speed over the speed of fall: large grains that fall on small ones throw them up.
  static constexpr double throw_factor = 5;

  double width = 200e-3, height = 500e-3, depth = 7.5e-3;
  std::string wall_surface = "saw-tooth";
  double roughness = 1, groove_spacing = 0, groove_inclination = 45 * degree, wall_friction_angle = 18 * degree;
  double depth_over_wavelength = 0.24, wavelength = 15e-3;
  std::int64_t wall_segments = 10;
  double smallest_diameter = 0.5e-3, largest_diameter = 2.5e-3, density = 2600, friction_angle = 25 * degree;
  double contact_modulus = 10e6, shear_to_normal_stiffness = 0.3, rolling_stiffness = 0.2, rolling_limit = 0.4;
  double local_damping = 0.01, filling_damping = 0.3;
  double void_ratio = 0.6;
  std::string filling = "cloud";
  std::optional<double> filling_friction_angle;
  double reduced_gravity = 1.0 / 6;
  std::int64_t layers = 6, seed = 1;
  double scaled_below = 0;  ///< density scaling of smaller grains [m]; 0: none
  SiloForms forms;

  void declare(Parameters& p) {
    const double right_angle = std::numbers::pi / 2;
    p.add("width", width).unit("m").symbol("b").above(0).doc("distance of the walls, along x");
    p.add("height", height).unit("m").symbol("h").above(0).doc("height of the filling at the given void ratio");
    p.add("depth", depth).unit("m").above(0).doc("distance of the smooth panes, along y");
    p.add("wall_surface", wall_surface).one_of({"flat", "saw-tooth", "sinusoidal"}).doc("surface of the two walls");
    p.add("roughness", roughness).symbol("R_n").above(0).doc("of saw-tooth walls: groove depth over the mean diameter");
    p.add("groove_spacing", groove_spacing)
        .unit("m")
        .at_least(0)
        .doc("spacing of the grooves of saw-tooth walls; 0: four times their depth");
    p.add("groove_inclination", groove_inclination)
        .unit("rad")
        .above(0)
        .below(right_angle)
        .doc("angle of the flanks of a groove to a saw-tooth wall");
    p.add("depth_over_wavelength", depth_over_wavelength)
        .symbol("d/l")
        .at_least(0)
        .doc("of sinusoidal walls: depth from crest to trough over the wavelength");
    p.add("wavelength", wavelength).unit("m").symbol("l").above(0).doc("wavelength of sinusoidal walls");
    p.add("wall_friction_angle", wall_friction_angle)
        .unit("rad")
        .at_least(0)
        .below(right_angle)
        .doc("friction angle between grains and the surfaces of walls and bottom");
    p.add("wall_segments", wall_segments)
        .at_least(1)
        .at_most(100)  // formulas sum the forces of all; their length is limited
        .doc("number of segments of equal height of each wall, for stresses over the height");
    p.add("smallest_diameter", smallest_diameter)
        .unit("m")
        .symbol("d_min")
        .above(0)
        .doc("smallest diameter of the grains");
    p.add("largest_diameter", largest_diameter)
        .unit("m")
        .symbol("d_max")
        .above(0)
        .doc("largest diameter of the grains; diameters are uniform by number in between");
    p.add("density", density).unit("kg/m^3").symbol("rho").above(0).doc("density of the grains");
    p.add("friction_angle", friction_angle)
        .unit("rad")
        .symbol("phi")
        .at_least(0)
        .below(right_angle)
        .doc("friction angle between grains after filling");
    p.add("contact_modulus", contact_modulus).unit("Pa").symbol("E_c").above(0).doc("contact modulus of the grains");
    p.add("shear_to_normal_stiffness", shear_to_normal_stiffness)
        .symbol("nu_c")
        .at_least(0)
        .doc("shear over normal stiffness of the grains");
    p.add("rolling_stiffness", rolling_stiffness)
        .symbol("beta")
        .at_least(0)
        .doc("rolling stiffness of the grains over k_s R_a R_b");
    p.add("rolling_limit", rolling_limit)
        .symbol("eta")
        .at_least(0)
        .doc("limit of the rolling moment of the grains over normal force times radius");
    p.add("local_damping", local_damping).symbol("lambda").at_least(0).below(1).doc("local damping after filling");
    p.add("filling_damping", filling_damping).at_least(0).below(1).doc("local damping during filling");
    p.add("void_ratio", void_ratio)
        .symbol("e")
        .at_least(0.4)
        .at_most(2)
        .doc("expected void ratio of the filling; with the height it determines the number of grains");
    p.add("filling_friction_angle", filling_friction_angle)
        .unit("rad")
        .at_least(0)
        .below(right_angle)
        .doc("friction angle between grains during filling; low: dense, high: loose; default: friction_angle");
    p.add("reduced_gravity", reduced_gravity)
        .above(0)
        .at_most(1)
        .doc(
            "fraction of gravity to which it is reduced before friction changes to friction_angle; it rises again "
            "afterwards; only with a filling_friction_angle");
    p.add("filling", filling)
        .one_of({"cloud", "layers"})
        .doc("cloud: all grains fall at once; layers: one layer after another, each when those below are at rest");
    p.add("layers", layers)
        .at_least(1)
        .at_most(100)
        .doc("number of layers of equal mass, alternately of the materials sand and dyed, which differ only in name");
    p.add("density_scaling_below", scaled_below)
        .unit("m")
        .at_least(0)
        .doc(
            "for a longer time step once the grains have fallen: those of a smaller diameter get the mass and "
            "inertia of one of this diameter, and keep their weight; not while sand flows out; 0: none");
    p.add("seed", seed).at_least(0).doc("seed of the random sizes and positions of the grains");
    p.add("analytical_solutions", forms).doc("parameters of reference values; without effect on the grains");
    p.check(
        [this](const Complain& complain) {
          if (!(smallest_diameter <= largest_diameter))
            complain("smallest_diameter", metres(smallest_diameter), "at most largest_diameter");
        },
        {"smallest_diameter", "largest_diameter"});
    p.check(
        [this](const Complain& complain) {
          if (wall_surface == "saw-tooth")
            check_groove_spacing(complain, groove_spacing, 2 * groove_depth() / std::tan(groove_inclination), height);
        },
        {"groove_spacing", "roughness", "groove_inclination", "wall_surface", "height"});
    p.check(
        [this](const Complain& complain) {
          check_side(complain, "width", width, 4, largest_diameter);
          check_side(complain, "height", height, 4, largest_diameter);
          check_side(complain, "depth", depth, 2, largest_diameter);
        },
        {"width", "height", "depth", "largest_diameter"});
  }

  double mean_diameter() const { return 0.5 * (smallest_diameter + largest_diameter); }
  double groove_depth() const {
    if (wall_surface == "sinusoidal") return depth_over_wavelength * wavelength;
    return wall_surface == "flat" ? 0 : roughness * mean_diameter();
  }
  double spacing() const {
    if (wall_surface == "sinusoidal") return wavelength;
    return groove_spacing > 0 ? groove_spacing : 4 * groove_depth();
  }
  /// Area in plan, with the grooves of both walls [m²].
  double area() const {
    const double groove = wall_surface == "sinusoidal" ? 0.5 * groove_depth() * wavelength
                                                       : groove_depth() * groove_depth() / std::tan(groove_inclination);
    return (width + (groove > 0 ? 2 * groove / spacing() : 0)) * depth;
  }
  std::int64_t grains() const {
    // Mean of d³ of a uniform distribution.
    const double a = smallest_diameter, b = largest_diameter, cube = 0.25 * (a + b) * (a * a + b * b);
    return std::llround(solids() / (std::numbers::pi / 6 * cube));
  }
  double solids() const { return area() * height / (1 + void_ratio); }  ///< volume [m³]
  double bulk_density() const { return density / (1 + void_ratio); }    ///< kg/m³
  double cloud_height() const { return std::max(height, solids() / (width * depth) / cloud_solid_fraction); }
  /// Time in which the top of the cloud falls to its final height [s].
  double falling_time() const {
    return std::sqrt(2 * std::max(cloud_height() - height, height) / gravity / (1 - filling_damping));
  }
  /// The same for the first layers, which fill a part of the silo.
  double falling_time(std::int64_t first_layers) const {
    return falling_time() * std::sqrt(static_cast<double>(first_layers) / static_cast<double>(layers));
  }
  /// Limit of the guard on the displacement per step that falling grains need.
  double travel() const {
    const double speed = throw_factor * (1 - filling_damping) * gravity * falling_time(),
                 mass = density * std::numbers::pi / 6 * std::pow(smallest_diameter, 3),
                 radius = 0.5 * smallest_diameter,
                 impact = std::numbers::pi * std::sqrt(mass / (2 * contact_modulus * radius)), steps_per_impact = 7;
    return std::max(usual_travel, speed * impact / steps_per_impact / radius);
  }
  /// Whether gravity is reduced and restored after filling.
  bool relieved() const { return filling_friction_angle && reduced_gravity < 1; }
  /// Time in which gravity changes [s]: twenty times that of a wave from top to bottom at √(E_c/ρ), an upper bound of
  /// the wave speed in the sand, so that no oscillations arise.
  double relief_time() const { return 20 * height / std::sqrt(contact_modulus / density); }
  /// Length by which walls and bottom extend beyond each other, so that no grain passes between them [m].
  double overhang() const { return groove_depth() + largest_diameter; }

  /// Name of a segment of a wall; "left-1" is the lowest.
  std::string segment(const std::string& side, std::int64_t number) const {
    return side + '-' + std::to_string(number);
  }

  /// The description without bottom, stages and probes. The walls extend to z = −below [m].
  Description description(const std::string& title, double below) const {
    Description d;
    d["title"] = title;
    d["seed"] = seed;
    d["contacts"] = {{"type", "linear-rolling"}};
    for (const char* name : {"sand", "dyed"}) {
      if (name == dyed && layers == 1) break;
      d["materials"][name] = {{"density", density},
                              {"contact_modulus", contact_modulus},
                              {"shear_to_normal_stiffness", shear_to_normal_stiffness},
                              {"friction_angle", filling_friction_angle.value_or(friction_angle)},
                              {"rolling_stiffness", rolling_stiffness},
                              {"rolling_limit", rolling_limit}};
      // Set for the interface: the low friction of grains during filling would reduce it.
      d["interfaces"][std::string(name) + "+wall"] = {{"friction_angle", wall_friction_angle}};
    }
    d["materials"]["wall"] = {{"rolling_limit", rolling_limit}};
    d["materials"]["smooth"] = {{"friction_angle", 0.0}, {"rolling_limit", 0.0}};

    const double reach = overhang() + width;
    d["domain"] = {{"low", vector(-reach, -depth, -below - height)}};
    for (std::int64_t layer = 0; layer < layers; ++layer) {
      const auto below_layer = [&](double of) { return of * static_cast<double>(layer) / static_cast<double>(layers); };
      const auto with_layer = [&](double of) {
        return of * static_cast<double>(layer + 1) / static_cast<double>(layers);
      };
      const auto all = static_cast<double>(grains());
      d["bodies"]["layer-" + std::to_string(layer + 1)] = {
          {"type", "sphere"},
          {"material", layer % 2 == 0 ? "sand" : dyed},
          {"source",
           {{"type", "cloud"},
            {"low", vector(0, 0, below_layer(cloud_height()))},
            {"high", vector(width, depth, with_layer(cloud_height()))},
            {"count", std::llround(with_layer(all)) - std::llround(below_layer(all))},
            {"sizes", {{"type", "uniform"}, {"smallest", smallest_diameter}, {"largest", largest_diameter}}}}}};
      // Its part of the cloud is above the layers that have fallen.
      if (filling == "layers" && layer > 0)
        d["bodies"]["layer-" + std::to_string(layer + 1)]["stage"] = fill(layer + 1);
    }

    auto& walls = d["walls"];
    for (const char* side : {"left", "right"}) {
      if (below > 0) walls[std::string(side) + "-below"] = wall(side, -below, 0);
      for (std::int64_t i = 0; i < wall_segments; ++i) {
        const double one = height / static_cast<double>(wall_segments);
        walls[segment(side, i + 1)] = wall(side, static_cast<double>(i) * one, static_cast<double>(i + 1) * one);
      }
      walls[std::string(side) + "-above"] = wall(side, height, cloud_height() + 4 * largest_diameter);
    }
    walls["front"] = plane(vector(0, 0, 0), vector(0, 1, 0), "smooth");
    walls["back"] = plane(vector(0, depth, 0), vector(0, -1, 0), "smooth");
    d["guards"]["travel"] = travel();
    d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", vector(0, 0, -gravity)}};
    d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", filling_damping}};
    return d;
  }

  /// A part of the bottom between two coordinates x [m].
  Description bottom(double low, double high) const {
    return rectangle(vector(low, 0, 0), vector(high - low, 0, 0), vector(0, depth, 0), "wall");
  }

  /// Stages of filling. "fill" (or "fill-1" and so on for layers): grains fall and come to rest. "settle": friction
  /// becomes friction_angle. If it was different, "relieve" reduces gravity first and "settle" restores it: with little
  /// friction the horizontal stress becomes nearly as high as the vertical stress, and would stay so at higher
  /// friction.
  std::vector<Description> filling_stages() const {
    const auto stage = [&](const std::string& name, double after, double unbalanced, double usual) -> Description {
      return {{"name", name},
              {"until",
               {{"type", "all"},
                {"of", {{{"type", "time"}, {"value", after}}, {{"type", "unbalanced-force"}, {"below", unbalanced}}}}}},
              {"limit", 20 * falling_time()},
              {"typical_time", usual}};
    };
    const auto gravity_goes = [&](double from, double to) {
      return Description::array({{{"pointer", "/engines/gravity/acceleration/2"},
                                  {"from", -from * gravity},
                                  {"to", -to * gravity},
                                  {"duration", relief_time()},
                                  {"increments", 50}}});
    };
    std::vector<Description> stages;
    if (filling == "cloud") stages.push_back(stage("fill", falling_time(), 0.01, falling_time() + usual_rest));
    else
      for (std::int64_t layer = 1; layer <= layers; ++layer)
        stages.push_back(stage(fill(layer), falling_time(layer), 0.01, falling_time(layer) + usual_rest));
    const double settling = 0.1 * falling_time() + (relieved() ? relief_time() : 0);
    Description settle = stage("settle", settling, 1e-3, settling);
    for (const char* name : {"sand", "dyed"})
      if (name != dyed || layers > 1) settle["change"]["materials"][name]["friction_angle"] = friction_angle;
    if (relieved()) {
      settle["ramps"] = gravity_goes(reduced_gravity, 1);
      stages.push_back({{"name", "relieve"},
                        {"ramps", gravity_goes(1, reduced_gravity)},
                        {"until", {{"type", "time"}, {"value", relief_time()}}},
                        {"limit", 2 * relief_time()}});
    }
    stages.push_back(settle);
    if (scaled_below > 0)
      (relieved() ? *std::prev(stages.end(), 2) : stages.back())["change"]["engines"]["density-scaling"] = {
          {"type", "density-scaling"}, {"below", scaled_below}};
    return stages;
  }

  /// A probe "formula" with the curves of the forces in the silo. `floor`: walls that carry the sand from below;
  /// `level`: formula of the height of the bottom.
  Description curves(const std::vector<std::string>& floor, const std::string& level, bool below) const {
    const auto sum = [](const std::vector<std::string>& walls, const std::string& component) {
      std::string text;
      for (std::string name : walls) {
        std::ranges::replace(name, '-', '_');
        text += (text.empty() ? "" : " + ") + name + "_force_" + component;
      }
      return "(" + text + ")";
    };
    const auto segments = [&](const std::string& side) {
      std::vector<std::string> names;
      if (below) names.push_back(side + "-below");
      for (std::int64_t i = 1; i <= wall_segments; ++i) names.push_back(segment(side, i));
      names.push_back(side + "-above");
      return names;
    };
    const std::string p = "-" + sum(floor, "z");
    const std::string t = "-0.5 * (" + sum(segments("left"), "z") + " + " + sum(segments("right"), "z") + ")";
    const std::string n = "0.5 * (" + sum(segments("right"), "x") + " - " + sum(segments("left"), "x") + ")";
    const std::string g = "(mass * g)";
    Description test = {{"type", "formula"}};
    const auto constant = [&](const char* name, double value, const char* doc) {
      test["constants"][name] = {{"value", value}, {"doc", doc}};
    };
    const auto curve = [&](const char* name, const std::string& formula, const char* unit, const char* doc) {
      test["curves"][name] = {{"formula", formula}, {"unit", unit}, {"doc", doc}};
    };
    constant("g", gravity, "acceleration of gravity [m s-2]");
    constant("area", area(), "area of the silo in plan, with grooves [m2]");
    constant("width", width, "distance of the walls [m]");
    constant("height", height, "height of the filling [m]");
    constant("piece_height", height / static_cast<double>(wall_segments), "height of a wall segment [m]");
    constant("density", density, "density of the grains [kg m-3]");
    curve("weight", "mass * g", "N", "G, weight of the sand in the silo");
    curve("bottom_force", p, "N", "P, force on the bottom, downwards positive");
    curve("wall_shear_force", t, "N", "T, vertical force on one wall, mean of both, downwards positive");
    curve("wall_normal_force", n, "N", "N, horizontal force on one wall, mean of both, outwards positive");
    curve("bottom_fraction", p + " / " + g, "1", "P/G");
    curve("wall_shear_fraction", "(" + t + ") / " + g, "1", "T/G of one wall");
    curve("wall_normal_fraction", "(" + n + ") / " + g, "1", "N/G of one wall");
    curve("wall_friction_angle", "180 / _pi * atan2(" + t + ", " + n + ")", "degree",
          "phi_w = atan(T/N), mobilised wall friction angle");
    // Over the whole height: the vertical force at a level is the weight above it less the wall friction above it.
    std::string carried;
    const auto add_friction = [&](const std::string& segment, const std::string& lever) {
      carried += " + " + sum({"left" + segment, "right" + segment}, "z") + " * (" + lever + ")";
    };
    if (below) add_friction("-below", "-0.5 * " + level);
    for (std::int64_t i = 1; i <= wall_segments; ++i)
      add_friction('-' + std::to_string(i), std::to_string(i) + " * piece_height - 0.5 * piece_height - " + level);
    add_friction("-above", "height - " + level);
    curve("lateral_stress_ratio", n + " * width / (" + g + " * (centre_z - " + level + ")" + carried + ")", "1",
          "K, mean horizontal over mean vertical stress over the height, from equilibrium");
    curve("balance", "(" + p + " + 2 * (" + t + ")) / " + g, "1", "P/G + 2 T/G: 1 at rest");
    curve("void_ratio", "2 * (centre_z - " + level + ") * area * density / mass - 1", "1",
          "overall void ratio of a uniform, level filling, from the height of its centre of mass");
    return test;
  }

  /// Janssen's formula for the expected filling; `form` overrides parameters.
  analytical_solutions::PlaneSilo balance(const SiloForm& form = {}) const {
    return {.width = width,
            .height = height,
            .depth = depth,
            .unit_weight = form.unit_weight.value_or(bulk_density() * gravity),
            .stress_ratio = form.stress_ratio.value_or(stress_ratio()),
            .wall_friction = std::tan(form.wall_friction_angle.value_or(wall_friction()))};
  }

  /// Reference values of the curves of the full silo. Descriptions can add their own under other names.
  Description references() const {
    Description all;
    const auto beside = [&](const char* name, const char* curve, double value) {
      all[name] = {{"of", std::string("test/") + curve}, {"value", value}};
    };
    const analytical_solutions::PlaneSilo janssen = balance();
    beside("Janssen_P_over_G", "bottom_fraction", janssen.bottom_fraction());
    beside("Janssen_T_over_G", "wall_shear_fraction", janssen.wall_shear_fraction());
    beside("Janssen_N_over_G", "wall_normal_fraction", janssen.wall_normal_fraction());
    beside("Janssen_K", "lateral_stress_ratio", janssen.stress_ratio);
    beside("Janssen_wall_friction", "wall_friction_angle", wall_friction() / degree);
    beside("Rankine_active", "lateral_stress_ratio",
           analytical_solutions::rankine_active(forms.internal_friction_angle));
    beside("Rankine_passive", "lateral_stress_ratio",
           analytical_solutions::rankine_passive(forms.internal_friction_angle));
    return all;
  }

  /// A probe "wall-profile": stresses on both walls together over the height.
  Description wall_profile() const {
    Description walls = Description::array();
    for (const char* side : {"left", "right"})
      for (std::int64_t i = 1; i <= wall_segments; ++i) walls.push_back(segment(side, i));
    Description profile{{"type", "wall-profile"}, {"walls", walls}, {"width", 2 * depth}, {"low", 0}, {"high", height}};
    if (groove_depth() > 0) {
      // Each strip contains whole grooves: the stress on flanks differs from that on the lands between grooves.
      constexpr double about = 20;
      const double strip = std::max(1.0, std::round(height / (about * spacing()))) * spacing();
      const double strips = std::ceil(height / strip - 1e-9);
      profile["strips"] = static_cast<std::int64_t>(strips), profile["high"] = strips * strip;
    }
    return profile;
  }

 private:
  static constexpr const char* dyed = "dyed";

  /// K of the analytical solutions.
  double stress_ratio() const {
    return forms.stress_ratio.value_or(analytical_solutions::stored_stress_ratio(forms.internal_friction_angle));
  }
  /// φ_w of the analytical solutions [rad].
  double wall_friction() const {
    if (forms.wall_friction_angle) return *forms.wall_friction_angle;
    const double factor = analytical_solutions::usual_wall_contact_factor(groove_depth(), mean_diameter());
    return std::atan(analytical_solutions::effective_wall_friction(factor, std::tan(wall_friction_angle),
                                                                   forms.internal_friction_angle));
  }

  /// Name of the stage in which a layer (from 1) falls.
  static std::string fill(std::int64_t layer) { return "fill-" + std::to_string(layer); }

  /// The wall of a side between two heights [m]; grooves continue from segment to segment.
  Description wall(const std::string& side, double low, double high) const {
    const bool left = side == "left";
    Description d = rectangle(vector(left ? 0 : width, left ? depth : 0, low), vector(0, 0, high - low),
                              vector(0, left ? -depth : depth, 0), "wall");
    if (wall_surface == "flat") return d;
    d.erase("two_sided");
    d["type"] = wall_surface;
    d["depth"] = groove_depth();
    if (wall_surface == "sinusoidal") {
      d["wavelength"] = wavelength;
    } else {
      d["inclination"] = groove_inclination;
      d["spacing"] = spacing();
    }
    d["offset"] = -std::fmod(low, spacing());
    return d;
  }
};

}  // namespace grit
