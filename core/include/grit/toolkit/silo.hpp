// A plane silo between two smooth panes and how it is filled, as the silo scenarios share it. See silo.md.
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
#include "grit/toolkit/closed_forms.hpp"
#include "grit/toolkit/lengths.hpp"
#include "grit/toolkit/wall_descriptions.hpp"

namespace grit {

/// What a closed form is worked out with where it differs from the others.
struct SiloForm {
  std::optional<double> stress_ratio, wall_friction_angle, unit_weight;

  void declare(Parameters& p) {
    p.add("stress_ratio", stress_ratio).symbol("K").above(0).doc("left out: that of closed_forms");
    p.add("wall_friction_angle", wall_friction_angle)
        .unit("rad")
        .symbol("phi_w")
        .above(0)
        .below(std::numbers::pi / 2)
        .doc("left out: that of closed_forms");
    p.add("unit_weight", unit_weight)
        .unit("N/m^3")
        .symbol("gamma")
        .above(0)
        .doc("of the bulk; left out: at the void ratio that the filling is expected to come to");
  }
};

/// What the run is put beside; none of it acts on the grains.
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
        .doc("of the sand as it shears in itself; the default is that of sand in EN 1991-4");
    p.add("stress_ratio", stress_ratio)
        .symbol("K")
        .above(0)
        .doc("horizontal over vertical stress; left out: 1.1 (1 - sin phi_i) of EN 1991-4");
    p.add("wall_friction_angle", wall_friction_angle)
        .unit("rad")
        .symbol("phi_w")
        .above(0)
        .below(std::numbers::pi / 2)
        .doc("between sand and wall; left out: EN 1991-4's, that of the surface where it is flat or nearly so");
    p.add("drescher", drescher).doc("P after Drescher, with one wall's friction, on the bottom of a silo-quasistatic");
    p.add("en_1991_4", en_1991_4).doc("P by EN 1991-4 with values of its own, on the bottom of a silo-quasistatic");
  }
};

struct Silo {
  static constexpr double degree = std::numbers::pi / 180, gravity = closed_forms::gravity;
  /// Of the cloud that falls into the silo.
  static constexpr double cloud_solid_fraction = 0.35;
  /// Largest way in a step, over the radius, unless a guard says otherwise.
  static constexpr double usual_travel = 0.05;
  /// In which sand came to rest once it had fallen, from 60 mm as from 0.5 m [s]: for estimates.
  static constexpr double usual_rest = 0.25;
  /// Small grains are thrown up by large ones that fall on them: speeds to allow for, over that of the fall.
  static constexpr double thrown = 5;

  double width = 200e-3, height = 500e-3, depth = 7.5e-3;
  std::string wall_surface = "saw-tooth";
  double roughness = 1, groove_spacing = 0, groove_inclination = 45 * degree, wall_friction_angle = 18 * degree;
  double depth_over_wavelength = 0.24, wavelength = 15e-3;
  std::int64_t wall_pieces = 10;
  double smallest_diameter = 0.5e-3, largest_diameter = 2.5e-3, density = 2600, friction_angle = 25 * degree;
  double contact_modulus = 10e6, shear_to_normal_stiffness = 0.3, rolling_stiffness = 0.2, rolling_limit = 0.4;
  double local_damping = 0.01, filling_damping = 0.3;
  double void_ratio = 0.6;
  std::string filling = "cloud";
  std::optional<double> filling_friction_angle;
  double relieved_gravity = 1.0 / 6;
  std::int64_t layers = 6, seed = 1;
  SiloForms forms;

  void declare(Parameters& p) {
    const double right_angle = std::numbers::pi / 2;
    p.add("width", width).unit("m").symbol("b").above(0).doc("between the walls, along x");
    p.add("height", height).unit("m").symbol("h").above(0).doc("to which the silo is filled, at the void ratio");
    p.add("depth", depth).unit("m").above(0).doc("between the panes, along y, which are smooth");
    p.add("wall_surface", wall_surface).one_of({"flat", "saw-tooth", "sinusoidal"}).doc("of the two walls");
    p.add("roughness", roughness)
        .symbol("R_n")
        .above(0)
        .doc("of saw-tooth walls: depth of a groove over the mean diameter");
    p.add("groove_spacing", groove_spacing)
        .unit("m")
        .at_least(0)
        .doc("from groove to groove of saw-tooth walls; 0: four times their depth");
    p.add("groove_inclination", groove_inclination)
        .unit("rad")
        .above(0)
        .below(right_angle)
        .doc("of a groove's flanks against a saw-tooth wall");
    p.add("depth_over_wavelength", depth_over_wavelength)
        .symbol("d/l")
        .at_least(0)
        .doc("of sinusoidal walls: from crests to troughs over the wavelength");
    p.add("wavelength", wavelength).unit("m").symbol("l").above(0).doc("of sinusoidal walls");
    p.add("wall_friction_angle", wall_friction_angle)
        .unit("rad")
        .at_least(0)
        .below(right_angle)
        .doc("between grains and the surface of walls and bottom");
    p.add("wall_pieces", wall_pieces)
        .at_least(1)
        .at_most(100)  // formulas add up the forces of all, and take no longer ones than of some hundred
        .doc("of equal height into which each wall is cut, for stresses by height");
    p.add("smallest_diameter", smallest_diameter).unit("m").symbol("d_min").above(0).doc("of the grains");
    p.add("largest_diameter", largest_diameter)
        .unit("m")
        .symbol("d_max")
        .above(0)
        .doc("of the grains; diameters are uniform by number in between");
    p.add("density", density).unit("kg/m^3").symbol("rho").above(0).doc("of the grains");
    p.add("friction_angle", friction_angle)
        .unit("rad")
        .symbol("mu")
        .at_least(0)
        .below(right_angle)
        .doc("between grains, once the silo is filled");
    p.add("contact_modulus", contact_modulus).unit("Pa").symbol("E_c").above(0).doc("of the grains");
    p.add("shear_to_normal_stiffness", shear_to_normal_stiffness).symbol("nu_c").at_least(0).doc("of the grains");
    p.add("rolling_stiffness", rolling_stiffness).symbol("beta").at_least(0).doc("of the grains");
    p.add("rolling_limit", rolling_limit).symbol("eta").at_least(0).doc("of the grains");
    p.add("local_damping", local_damping).symbol("lambda").at_least(0).below(1).doc("once the silo is filled");
    p.add("filling_damping", filling_damping).at_least(0).below(1).doc("local damping until the filling rests");
    p.add("void_ratio", void_ratio)
        .symbol("e")
        .at_least(0.4)
        .at_most(2)
        .doc("that the filling is expected to come to: with the height it says how many grains there are");
    p.add("filling_friction_angle", filling_friction_angle)
        .unit("rad")
        .at_least(0)
        .below(right_angle)
        .doc("between grains while they fall; low: dense, high: loose; left out: their own");
    p.add("relieved_gravity", relieved_gravity)
        .above(0)
        .at_most(1)
        .doc(
            "share of gravity that is left while friction becomes the grains' own; it rises again afterwards; "
            "without effect unless there is a filling_friction_angle");
    p.add("filling", filling)
        .one_of({"cloud", "layers"})
        .doc("cloud: all grains fall at once; layers: one layer after the other, each once all before it rest");
    p.add("layers", layers)
        .at_least(1)
        .at_most(100)
        .doc("of equal mass, turn by turn of the materials sand and dyed, which differ in name alone");
    p.add("seed", seed).at_least(0).doc("of the grains' sizes and places");
    p.add("closed_forms", forms).doc("what the curves are drawn beside; without effect on the grains");
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
  /// Seen from above, with the grooves of both walls [m²].
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
  double solids() const { return area() * height / (1 + void_ratio); }  ///< m³
  double bulk_density() const { return density / (1 + void_ratio); }    ///< kg/m³
  double cloud_height() const { return std::max(height, solids() / (width * depth) / cloud_solid_fraction); }
  /// In which the top of the cloud falls to where it stays [s].
  double falling_time() const {
    return std::sqrt(2 * std::max(cloud_height() - height, height) / gravity / (1 - filling_damping));
  }
  /// The same of the first layers, whose share of the silo is filled.
  double falling_time(std::int64_t first_layers) const {
    return falling_time() * std::sqrt(static_cast<double>(first_layers) / static_cast<double>(layers));
  }
  /// What the guard on ways has to let through while grains fall.
  double travel() const {
    const double speed = thrown * (1 - filling_damping) * gravity * falling_time(),
                 mass = density * std::numbers::pi / 6 * std::pow(smallest_diameter, 3),
                 radius = 0.5 * smallest_diameter,
                 impact = std::numbers::pi * std::sqrt(mass / (2 * contact_modulus * radius)), steps_per_impact = 7;
    return std::max(usual_travel, speed * impact / steps_per_impact / radius);
  }
  /// Whether gravity is taken off and put on again once the silo is filled.
  bool relieved() const { return filling_friction_angle && relieved_gravity < 1; }
  /// In which gravity changes: that of twenty waves from top to bottom at sqrt(E_c/rho), which pressure in the sand
  /// does not reach, so that nothing bounces [s].
  double relief_time() const { return 20 * height / std::sqrt(contact_modulus / density); }
  /// By which walls and bottom reach beyond each other, so that no grain comes between them [m].
  double overhang() const { return groove_depth() + largest_diameter; }

  /// "left-1" is the lowest piece.
  std::string piece(const std::string& side, std::int64_t number) const { return side + '-' + std::to_string(number); }

  /// All but the bottom, stages and probes. The walls reach `below` under z = 0 [m].
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
      // Said for the pair, as low friction between grains while they fall would lower it.
      d["interfaces"][std::string(name) + "+wall"] = {{"friction_angle", wall_friction_angle}};
    }
    d["materials"]["wall"] = {{"rolling_limit", rolling_limit}};
    d["materials"]["smooth"] = {{"friction_angle", 0.0}, {"rolling_limit", 0.0}};

    const double reach = overhang() + width;
    d["domain"] = {{"low", vector(-reach, -depth, -below - height)}};
    for (std::int64_t layer = 0; layer < layers; ++layer) {
      const auto share = [&](double of) { return of * static_cast<double>(layer) / static_cast<double>(layers); };
      const auto next = [&](double of) { return of * static_cast<double>(layer + 1) / static_cast<double>(layers); };
      const auto all = static_cast<double>(grains());
      d["bodies"]["layer-" + std::to_string(layer + 1)] = {
          {"type", "sphere"},
          {"material", layer % 2 == 0 ? "sand" : dyed},
          {"grains",
           {{"type", "cloud"},
            {"low", vector(0, 0, share(cloud_height()))},
            {"high", vector(width, depth, next(cloud_height()))},
            {"count", std::llround(next(all)) - std::llround(share(all))},
            {"sizes", {{"type", "uniform"}, {"smallest", smallest_diameter}, {"largest", largest_diameter}}}}}};
      // Where it would hang in the cloud is above all that has fallen.
      if (filling == "layers" && layer > 0)
        d["bodies"]["layer-" + std::to_string(layer + 1)]["stage"] = fill(layer + 1);
    }

    auto& walls = d["walls"];
    for (const char* side : {"left", "right"}) {
      if (below > 0) walls[std::string(side) + "-below"] = wall(side, -below, 0);
      for (std::int64_t i = 0; i < wall_pieces; ++i) {
        const double one = height / static_cast<double>(wall_pieces);
        walls[piece(side, i + 1)] = wall(side, static_cast<double>(i) * one, static_cast<double>(i + 1) * one);
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

  /// A piece of bottom between two places along x [m].
  Description bottom(double low, double high) const {
    return rectangle(vector(low, 0, 0), vector(high - low, 0, 0), vector(0, depth, 0), "wall");
  }

  /// "fill": the cloud falls and comes to rest; or "fill-1" and so on: a layer does. "settle": friction is the grains'
  /// own. Where it was another one gravity goes down before, in "relieve", and rises while they settle: stress that
  /// came about with little friction is nearly as high sideways as downwards, and more friction leaves it so.
  std::vector<Description> filling_stages() const {
    const auto stage = [&](const std::string& name, double after, double unbalanced, double usual) -> Description {
      return {{"name", name},
              {"until",
               {{"type", "all"},
                {"of", {{{"type", "time"}, {"value", after}}, {{"type", "unbalanced-force"}, {"below", unbalanced}}}}}},
              {"limit", 20 * falling_time()},
              {"usual_time", usual}};
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
      settle["ramps"] = gravity_goes(relieved_gravity, 1);
      stages.push_back({{"name", "relieve"},
                        {"ramps", gravity_goes(1, relieved_gravity)},
                        {"until", {{"type", "time"}, {"value", relief_time()}}},
                        {"limit", 2 * relief_time()}});
    }
    stages.push_back(settle);
    return stages;
  }

  /// Curves of the forces in the silo, for a probe "formula"; `floor` are the walls that bear the sand from below, and
  /// `level` is where the bottom is, as a formula.
  Description curves(const std::vector<std::string>& floor, const std::string& level, bool below) const {
    const auto sum = [](const std::vector<std::string>& walls, const std::string& component) {
      std::string text;
      for (std::string name : walls) {
        std::ranges::replace(name, '-', '_');
        text += (text.empty() ? "" : " + ") + name + "_force_" + component;
      }
      return "(" + text + ")";
    };
    const auto pieces = [&](const std::string& side) {
      std::vector<std::string> names;
      if (below) names.push_back(side + "-below");
      for (std::int64_t i = 1; i <= wall_pieces; ++i) names.push_back(piece(side, i));
      names.push_back(side + "-above");
      return names;
    };
    const std::string p = "-" + sum(floor, "z");
    const std::string t = "-0.5 * (" + sum(pieces("left"), "z") + " + " + sum(pieces("right"), "z") + ")";
    const std::string n = "0.5 * (" + sum(pieces("right"), "x") + " - " + sum(pieces("left"), "x") + ")";
    const std::string g = "(mass * g)";
    Description test = {{"type", "formula"}};
    const auto constant = [&](const char* name, double value, const char* doc) {
      test["constants"][name] = {{"value", value}, {"doc", doc}};
    };
    const auto curve = [&](const char* name, const std::string& formula, const char* unit, const char* doc) {
      test["curves"][name] = {{"formula", formula}, {"unit", unit}, {"doc", doc}};
    };
    constant("g", gravity, "acceleration of gravity [m s-2]");
    constant("area", area(), "of the silo, seen from above, with its grooves [m2]");
    constant("width", width, "between the walls [m]");
    constant("height", height, "to which the silo is filled [m]");
    constant("piece_height", height / static_cast<double>(wall_pieces), "of a piece of a wall [m]");
    constant("density", density, "of the grains [kg m-3]");
    curve("weight", "mass * g", "N", "G, of the sand in the silo");
    curve("bottom_force", p, "N", "P, on the bottom, downwards positive");
    curve("wall_shear_force", t, "N", "T, on one wall, mean of both, downwards positive");
    curve("wall_normal_force", n, "N", "N, on one wall, mean of both, outwards positive");
    curve("bottom_share", p + " / " + g, "1", "P/G");
    curve("wall_shear_share", "(" + t + ") / " + g, "1", "T/G of one wall");
    curve("wall_normal_share", "(" + n + ") / " + g, "1", "N/G of one wall");
    curve("wall_friction_angle", "180 / _pi * atan2(" + t + ", " + n + ")", "degree", "phi_w = atan(T/N), mobilised");
    // Over the whole height: what lies above each level, less what the walls bear of it, is on the bottom of the level.
    std::string borne;
    const auto bears = [&](const std::string& piece, const std::string& place) {
      borne += " + " + sum({"left" + piece, "right" + piece}, "z") + " * (" + place + ")";
    };
    if (below) bears("-below", "-0.5 * " + level);
    for (std::int64_t i = 1; i <= wall_pieces; ++i)
      bears('-' + std::to_string(i), std::to_string(i) + " * piece_height - 0.5 * piece_height - " + level);
    bears("-above", "height - " + level);
    curve("lateral_stress_ratio", n + " * width / (" + g + " * (centre_z - " + level + ")" + borne + ")", "1",
          "K: horizontal stress on the walls over the vertical one, each the mean over the height; from the balance");
    curve("balance", "(" + p + " + 2 * (" + t + ")) / " + g, "1", "P/G + 2 T/G: 1 at rest");
    curve("void_ratio", "2 * (centre_z - " + level + ") * area * density / mass - 1", "1",
          "overall, of a filling that is even and level; from the height of its centre of mass");
    return test;
  }

  /// Janssen's balance, or another's, of the filling as it is expected.
  closed_forms::PlaneSilo balance(const SiloForm& form = {}) const {
    return {.width = width,
            .height = height,
            .depth = depth,
            .unit_weight = form.unit_weight.value_or(bulk_density() * gravity),
            .stress_ratio = form.stress_ratio.value_or(stress_ratio()),
            .wall_friction = std::tan(form.wall_friction_angle.value_or(wall_friction()))};
  }

  /// What the curves of the full silo are drawn beside. Descriptions add their own by other names.
  Description references() const {
    Description all;
    const auto beside = [&](const char* name, const char* curve, double value) {
      all[name] = {{"of", std::string("test/") + curve}, {"value", value}};
    };
    const closed_forms::PlaneSilo janssen = balance();
    beside("Janssen_P_over_G", "bottom_share", janssen.bottom_share());
    beside("Janssen_T_over_G", "wall_shear_share", janssen.wall_shear_share());
    beside("Janssen_N_over_G", "wall_normal_share", janssen.wall_normal_share());
    beside("Janssen_K", "lateral_stress_ratio", janssen.stress_ratio);
    beside("Janssen_wall_friction", "wall_friction_angle", wall_friction() / degree);
    beside("Rankine_active", "lateral_stress_ratio", closed_forms::rankine_active(forms.internal_friction_angle));
    beside("Rankine_passive", "lateral_stress_ratio", closed_forms::rankine_passive(forms.internal_friction_angle));
    return all;
  }

  /// Stresses on both walls together, by height.
  Description wall_profile() const {
    Description walls = Description::array();
    for (const char* side : {"left", "right"})
      for (std::int64_t i = 1; i <= wall_pieces; ++i) walls.push_back(piece(side, i));
    Description profile{{"type", "wall-profile"}, {"walls", walls}, {"width", 2 * depth}, {"low", 0}, {"high", height}};
    if (groove_depth() > 0) {
      // Whole grooves in each: a strip of flanks alone, or of lands, would have the stress of those.
      constexpr double about = 20;
      const double strip = std::max(1.0, std::round(height / (about * spacing()))) * spacing();
      const double strips = std::ceil(height / strip - 1e-9);
      profile["strips"] = static_cast<std::int64_t>(strips), profile["high"] = strips * strip;
    }
    return profile;
  }

 private:
  static constexpr const char* dyed = "dyed";

  /// K of the closed forms.
  double stress_ratio() const {
    return forms.stress_ratio.value_or(closed_forms::stored_stress_ratio(forms.internal_friction_angle));
  }
  /// φ_w of the closed forms [rad].
  double wall_friction() const {
    if (forms.wall_friction_angle) return *forms.wall_friction_angle;
    const double factor = closed_forms::usual_wall_contact_factor(groove_depth(), mean_diameter());
    return std::atan(
        closed_forms::effective_wall_friction(factor, std::tan(wall_friction_angle), forms.internal_friction_angle));
  }

  /// The stage in which a layer falls, from 1.
  static std::string fill(std::int64_t layer) { return "fill-" + std::to_string(layer); }

  /// A side's wall between two heights [m]; grooves go on from piece to piece.
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
