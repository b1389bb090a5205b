// Preparation of specimens for scenarios. A cloud of grains is compacted by servo-controlled walls, one along an axis
// or six around it; or its grains grow between fixed walls. Friction controls the void ratio. See
// plugins/scenarios/README.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/scenario.hpp"
#include "grit/toolkit/lengths.hpp"
#include "grit/toolkit/wall_descriptions.hpp"

namespace grit {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Range of void ratios of the interior that can be prepared with a grading, pressure and stiffness.
struct VoidRatioRange {
  double densest, loosest;
};

/// Friction angle [rad] during compaction or growth, and the measured void ratio of the interior that results.
struct Compacted {
  double friction_angle, void_ratio;
};

/// For sand with diameters uniform by number from 0.25 to 0.75 mm, in the box of direct-shear under 200 kPa; the
/// measurement: plugins/scenarios/README.md.
inline constexpr std::array<Compacted, 7> compacted_in_a_box{{{0, 0.558},
                                                              {2 * degree, 0.597},
                                                              {5 * degree, 0.635},
                                                              {10 * degree, 0.698},
                                                              {18 * degree, 0.770},
                                                              {30 * degree, 0.853},
                                                              {60 * degree, 0.919}}};
inline constexpr double loosest_in_a_box = 0.79;

/// For the same grading grown in a cube of 12 mean diameters until it carries 200 kPa; see there.
inline constexpr std::array<Compacted, 7> grown_in_a_cube{{{0, 0.564},
                                                           {2 * degree, 0.601},
                                                           {5 * degree, 0.644},
                                                           {10 * degree, 0.695},
                                                           {18 * degree, 0.736},
                                                           {30 * degree, 0.795},
                                                           {60 * degree, 0.832}}};
inline constexpr double loosest_by_growth = 0.76;

/// Smallest void ratio of the interior for frictionless spheres of that grading. `walls`: distance of the walls along
/// each axis, in mean diameters; infinite along periodic axes. A fit of the measurements given there.
inline double densest_between(const Vec3& walls) {
  const double near_walls = walls.cwiseInverse().sum();
  return 0.519 + 0.08 * near_walls + 0.28 * near_walls * near_walls;
}

/// Parameters of the preparation of a specimen, and the stages that prepare it.
struct Preparation {
  /// Solid fraction of the cloud that compaction starts from.
  static constexpr double cloud_solid_fraction = 0.3;
  static constexpr double local_damping = 0.3;

  /// Volume of an asymmetric clump over that of its enclosing sphere.
  static constexpr double clump_fraction = 0.479;

  std::string grain_shape = "sphere";
  double smallest_diameter = 0.25e-3, largest_diameter = 0.75e-3;
  std::vector<double> sieve_diameters, sieve_passing;
  double density = 2600, friction_angle = 18 * degree;
  double void_ratio = 0.6, inertial_number = 3e-3;
  std::string method = "compaction";
  std::optional<double> compaction_friction_angle;
  std::int64_t seed = 1;

  void declare_sand(Parameters& p) {
    p.add("grain_shape", grain_shape)
        .one_of({"sphere", "clump"})
        .doc("spheres, or asymmetric clumps of four spheres; the diameter of a clump is that of its enclosing sphere");
    p.add("smallest_diameter", smallest_diameter)
        .unit("m")
        .symbol("d_min")
        .above(0)
        .doc("smallest diameter of the grains");
    p.add("largest_diameter", largest_diameter)
        .unit("m")
        .symbol("d_max")
        .above(0)
        .doc("largest diameter of the grains; diameters are uniform by number in between, unless there are sieves");
    p.add("sieve_diameters", sieve_diameters)
        .unit("m")
        .above(0)
        .doc("sieve openings, ascending from the smallest to the largest diameter; empty: uniform by number");
    p.add("sieve_passing", sieve_passing)
        .at_least(0)
        .at_most(1)
        .doc("fraction of the mass that passes each sieve, ascending from 0 to 1; uniform by mass in between");
    p.add("density", density).unit("kg/m^3").symbol("rho").above(0).doc("density of the grains");
    p.add("friction_angle", friction_angle)
        .unit("rad")
        .symbol("phi")
        .at_least(0)
        .below(std::numbers::pi / 2)
        .doc("friction angle between grains during shear; set other parameters of the sand in /materials/sand");
    p.check(
        [this](const Complain& complain) {
          if (!(smallest_diameter <= largest_diameter))
            complain("smallest_diameter", metres(smallest_diameter), "at most largest_diameter");
        },
        {"smallest_diameter", "largest_diameter"});
    p.check(
        [this](const Complain& complain) {
          const auto& d = sieve_diameters;
          const auto& passing = sieve_passing;
          if (d.size() != passing.size())
            complain("sieve_passing", std::to_string(passing.size()) + " fractions",
                     "as many as sieve_diameters has, " + std::to_string(d.size()));
          else if (!d.empty() && (d.size() < 2 || !std::ranges::is_sorted(d, std::less_equal<>())))
            complain("sieve_diameters", std::to_string(d.size()) + " diameters",
                     "two or more, each above the one before");
          else if (!d.empty() && (d.front() != smallest_diameter || d.back() != largest_diameter))
            complain("sieve_diameters", metres(d.front()) + " to " + metres(d.back()),
                     "from smallest_diameter to largest_diameter");
          else if (!d.empty() && (passing.front() != 0 || passing.back() != 1 || !std::ranges::is_sorted(passing)))
            complain("sieve_passing",
                     "from " + std::to_string(passing.front()) + " to " + std::to_string(passing.back()),
                     "fractions that rise from 0 to 1");
        },
        {"smallest_diameter", "largest_diameter", "sieve_diameters", "sieve_passing"});
  }
  void declare_void_ratio(Parameters& p) {
    p.add("void_ratio", void_ratio)
        .symbol("e_0")
        .at_least(0.2)
        .at_most(2)
        .doc(
            "void ratio of the interior (one mean diameter off the walls) before shear; the run fails if it differs by "
            "over 0.01");
  }
  void declare_course(Parameters& p) {
    p.add("preparation", method)
        .one_of({"compaction", "growth"})
        .doc("compaction: walls compress a cloud of grains; growth: grains of a cloud grow in the final box");
    p.add("preparation_inertial_number", inertial_number)
        .above(0)
        .at_most(0.1)
        .doc("inertial number during preparation; higher is faster, but the specimen becomes less uniform");
    p.add("compaction_friction_angle", compaction_friction_angle)
        .unit("rad")
        .at_least(0)
        .below(std::numbers::pi / 2)
        .doc(
            "friction angle between grains during compaction or growth; default: the measured value for a void ratio "
            "slightly above the target");
    p.add("seed", seed).at_least(0).doc("seed of the random sizes and positions of the grains");
  }

  /// Mean diameter by number [m].
  double mean_diameter() const {
    if (sieve_diameters.empty()) return 0.5 * (smallest_diameter + largest_diameter);
    return over_sieves([](double a, double b) { return 1 / (a * b); }) / over_sieves(inverse_cube);
  }
  /// Number of grains that fill a volume [m³] at the target void ratio.
  std::int64_t grains(double volume) const {
    // Mean of d³ of a uniform distribution.
    const double a = smallest_diameter, b = largest_diameter;
    const double cube = sieve_diameters.empty() ? 0.25 * (a + b) * (a * a + b * b) : 1 / over_sieves(inverse_cube);
    return std::llround(volume / (1 + void_ratio) / (std::numbers::pi / 6 * cube * solid_fraction()));
  }
  bool grows() const { return method == "growth"; }
  /// Volume of the cloud for a specimen of this volume; or its length, for a cloud extended along one axis only. With
  /// growth it is the volume at the void ratio that friction leads to, above the target.
  double in_cloud(double specimen) const {
    const double solids = specimen / (1 + void_ratio);
    return grows() ? solids * (1 + loose_void_ratio()) : solids / (cloud_solid_fraction * solid_fraction());
  }

  /// Inertial time scale d √(ρ/p) [s] under a pressure [Pa]: a grain moves by its own size in this time.
  double inertial_time(double pressure) const { return mean_diameter() * std::sqrt(density / pressure); }
  /// Time in which a disturbed specimen comes to rest [s].
  double settling_time(double pressure) const {
    return 200 * inertial_time(pressure) / std::sqrt(inertial_number / 1e-2);
  }
  /// Closing speed [m/s] of the walls of a specimen of this length [m] under a pressure [Pa], both walls together.
  double closing_speed(double length, double pressure) const {
    return inertial_number * length / inertial_time(pressure);
  }
  /// Raises the velocity limit of a wall's servo in `stage`, from `speed` [m/s] during compaction to twice the shear
  /// velocity `driven` [m/s]: on flanks of 45 degrees the specimen rises as fast as it is sheared, with jerks.
  static void raise_servo_limit(Description& stage, const char* wall, double speed, double driven) {
    if (speed < 2 * driven) stage["change"]["walls"][wall]["motion"]["servo"]["max_velocity"] = 2 * driven;
  }

  /// Range of void ratios between `walls` [m] (see densest_between); `loosest` is the maximum by compaction.
  VoidRatioRange reachable(const Vec3& walls, double loosest) const {
    return {densest_between(walls / mean_diameter()), grows() ? loosest_by_growth : loosest};
  }
  /// Throws ParameterError for a void ratio out of the range, unless compaction_friction_angle is set or grains
  /// are not spheres, for which it was measured. `pressure` [Pa] appears in the message.
  void require_reachable(const VoidRatioRange& range, double pressure) const {
    if (compaction_friction_angle || grain_shape != "sphere" ||
        (void_ratio >= range.densest && void_ratio <= range.loosest))
      return;
    std::ostringstream found, allowed;
    found.precision(3), allowed.precision(3);
    found << void_ratio;
    allowed << "between " << range.densest << " (prepared without friction) and " << range.loosest
            << " (with high friction, then its own), for this grading in a specimen of this size under "
            << pressure * 1e-3 << " kPa";
    throw ParameterError({{"void_ratio", found.str(), allowed.str()}});
  }
  /// Adds a check that the sides of a specimen [m], each with its key, are at least four of the largest diameters.
  void check_box(Parameters& p, const std::vector<std::pair<std::string, const double*>>& sides) const {
    std::vector<std::string> keys{"largest_diameter"};
    for (const auto& [key, side] : sides) keys.push_back(key.substr(0, key.find('/')));
    p.check(
        [this, sides](const Complain& complain) {
          for (const auto& [key, side] : sides) check_side(complain, key, *side, 4, largest_diameter);
        },
        keys);
  }

  /// For titles: "200 kPa, e0 = 0.6".
  std::string conditions(double pressure) const {
    std::ostringstream text;
    text.precision(3);
    text << std::lround(pressure * 1e-3) << " kPa, e0 = " << void_ratio;
    return text.str();
  }
  Description sand() const { return {{"density", density}, {"friction_angle", friction_angle}}; }
  /// The group of grains: a cloud of `count` grains between two corners [m].
  Description cloud(const Description& low, const Description& high, std::int64_t count) const {
    const double size = size_at_start();
    Description sizes = {
        {"type", "uniform"}, {"smallest", size * smallest_diameter}, {"largest", size * largest_diameter}};
    if (!sieve_diameters.empty()) {
      sizes = {{"type", "sieve"}, {"diameters", sieve_diameters}, {"passing", sieve_passing}};
      for (Description& diameter : sizes["diameters"]) diameter = size * diameter.get<double>();
    }
    Description group = {
        {"type", grain_shape},
        {"material", "sand"},
        {"source", {{"type", "cloud"}, {"low", low}, {"high", high}, {"count", count}, {"sizes", sizes}}}};
    if (grain_shape == "clump") group["shape"] = {{"type", "asymmetric"}};
    return group;
  }

  /// Stages of the preparation. "compact": friction leads to a void ratio slightly above the target. "densify":
  /// friction falls until the target is reached, or until it is zero and the grains are at rest. "settle": friction of
  /// the sand. Of all `walls`, those named in `pressing` are servo-controlled to `pressure` [Pa] and close in `closing`
  /// [s]; `compacted` relates friction to void ratio. With growth, "grow" and "press" replace "compact", and the
  /// pressing walls are fixed until their servos start in "densify".
  std::vector<Description> stages(Description& walls, const std::vector<std::string>& pressing, double pressure,
                                  double closing, std::span<const Compacted> compacted) const {
    const double settling = settling_time(pressure);
    const double loose_angle =
        compaction_friction_angle.value_or(friction_for(loose_void_ratio(), grows() ? grown_in_a_cube : compacted));
    const auto friction = [](double angle) -> Description { return {{"sand", {{"friction_angle", angle}}}}; };
    const auto at_rest = [&](double within, double unbalanced) -> Description {
      Description of = Description::array();
      for (const std::string& wall : pressing)
        of.push_back({{"type", "pressure"}, {"wall", wall}, {"value", pressure}, {"within", within}});
      of.push_back({{"type", "unbalanced-force"}, {"below", unbalanced}});
      return {{"type", "all"}, {"of", of}};
    };
    Description compact, densify, settle;
    compact["name"] = "compact";
    compact["change"]["materials"] = friction(loose_angle);
    compact["until"] = at_rest(0.02, 0.01);
    compact["limit"] = 3 * closing + 5 * settling;
    compact["typical_time"] = closing;
    densify["name"] = "densify";
    densify["ramps"] = Description::array({{{"pointer", "/materials/sand/friction_angle"},
                                            {"from", loose_angle},
                                            {"to", 0.0},
                                            {"duration", settling},
                                            {"increments", 100}}});
    // Frictionless grains at rest do not densify further; "settle" checks the void ratio.
    const Description without_friction = {{"type", "time"}, {"value", settling}},
                      rest = {{"type", "unbalanced-force"}, {"below", 1e-4}};
    densify["until"] = {
        {"type", "any"},
        {"of", Description::array({{{"type", "void-ratio"}, {"below", void_ratio}},
                                   {{"type", "all"}, {"of", Description::array({without_friction, rest})}}})}};
    densify["limit"] = 5 * settling;
    densify["typical_time"] = 0.6 * settling;
    settle["name"] = "settle";
    settle["change"]["materials"] = friction(friction_angle);
    settle["until"] = at_rest(0.005, 2e-3);
    settle["limit"] = 15 * settling;
    settle["typical_time"] = 0.01 * settling;
    settle["expect"] = {{"void_ratio", void_ratio}, {"within", 0.01}};
    if (!grows()) return {compact, densify, settle};

    // The strain rate of walls that close at the inertial number; slower as soon as grains come into contact.
    const double rate = inertial_number / inertial_time(pressure), slow_rate = rate / 20;
    const double margin = 0.05;  // above the target void ratio: grains do not carry load yet
    Description grow, press;
    grow["name"] = "grow";
    grow["change"]["materials"] = friction(loose_angle);
    grow["growth"]["rate"] = rate;
    grow["until"] = {{"type", "any"},
                     {"of", Description::array({{{"type", "void-ratio"}, {"below", loose_void_ratio() + margin}},
                                                {{"type", "mean-stress"}, {"above", 0.1 * pressure}}})}};
    grow["limit"] = -2 * std::log(size_at_start()) / rate;
    grow["typical_time"] = -0.8 * std::log(size_at_start()) / rate;
    press["name"] = "press";
    press["growth"]["rate"] = slow_rate;
    press["until"] = {{"type", "mean-stress"}, {"above", pressure}};
    press["limit"] = 0.2 / slow_rate;
    press["typical_time"] = 0.025 / slow_rate;
    for (const std::string& wall : pressing) {
      densify["change"]["walls"][wall]["motion"] = walls[wall]["motion"];
      walls[wall].erase("motion");
    }
    return {grow, press, densify, settle};
  }

 private:
  /// Void ratio after compaction or growth; "densify" lowers it to the target.
  double loose_void_ratio() const { return void_ratio + 0.03; }
  /// Diameter of grains in the cloud over their final diameter.
  double size_at_start() const {
    return grows() ? std::cbrt(cloud_solid_fraction * solid_fraction() * (1 + loose_void_ratio())) : 1;
  }
  /// Volume of a grain over that of a sphere of its diameter.
  double solid_fraction() const { return grain_shape == "clump" ? clump_fraction : 1; }

  // Mean of d⁻³ between two sieves, by mass: proportional to the number of grains per mass.
  static double inverse_cube(double a, double b) { return (a + b) / (2 * a * a * b * b); }
  // Sum of of(…) over the intervals between sieves, weighted by mass fraction.
  template <class Of>
  double over_sieves(Of of) const {
    double sum = 0;
    for (std::size_t i = 1; i < sieve_diameters.size(); ++i)
      sum += (sieve_passing[i] - sieve_passing[i - 1]) * of(sieve_diameters[i - 1], sieve_diameters[i]);
    return sum;
  }

  static double friction_for(double void_ratio, std::span<const Compacted> compacted) {
    for (std::size_t i = 1; i < compacted.size(); ++i) {
      const Compacted &a = compacted[i - 1], &b = compacted[i];
      if (void_ratio >= b.void_ratio) continue;
      const double fraction = std::max(0.0, void_ratio - a.void_ratio) / (b.void_ratio - a.void_ratio);
      return a.friction_angle + fraction * (b.friction_angle - a.friction_angle);
    }
    return compacted.back().friction_angle;
  }
};

}  // namespace grit
