// Preparation of a specimen, as scenarios share it: a cloud of grains is compacted by servo-controlled walls, one along
// an axis or six around it, or its grains grow between walls that stand; friction is the control of the void ratio. See
// README.md.
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

inline constexpr double degree = std::numbers::pi / 180, infinity = std::numeric_limits<double>::infinity();

/// Void ratios of the interior that a grading, pressure and stiffness can be brought to.
struct VoidRatioRange {
  double densest, loosest;
};

/// Friction during compaction or growth, and the void ratio of the interior that it was measured to lead to.
struct Compacted {
  double friction_angle, void_ratio;
};

/// Of sand whose diameters are uniform by number from 0.25 to 0.75 mm, in the box of direct-shear under 200 kPa; its
/// README.md says how it was measured.
inline constexpr std::array<Compacted, 7> compacted_in_a_box{{{0, 0.558},
                                                              {2 * degree, 0.597},
                                                              {5 * degree, 0.635},
                                                              {10 * degree, 0.698},
                                                              {18 * degree, 0.770},
                                                              {30 * degree, 0.853},
                                                              {60 * degree, 0.919}}};
inline constexpr double loosest_in_a_box = 0.79;

/// Of the same grading that grows in a cube of 12 mean diameters until it bears 200 kPa; README.md says more.
inline constexpr std::array<Compacted, 7> grown_in_a_cube{{{0, 0.564},
                                                           {2 * degree, 0.601},
                                                           {5 * degree, 0.644},
                                                           {10 * degree, 0.695},
                                                           {18 * degree, 0.736},
                                                           {30 * degree, 0.795},
                                                           {60 * degree, 0.832}}};
inline constexpr double loosest_by_growth = 0.76;

/// The densest that frictionless spheres of that grading come to in the interior, between walls that are so many mean
/// diameters apart along each axis, infinity where they are periodic; README.md has what was measured.
inline double densest_between(const Vec3& walls) {
  const double near_walls = walls.cwiseInverse().sum();
  return 0.519 + 0.08 * near_walls + 0.28 * near_walls * near_walls;
}

struct Preparation {
  /// Solid fraction of the cloud that compaction starts from.
  static constexpr double cloud_solid_fraction = 0.3;
  static constexpr double local_damping = 0.3;

  /// Volume of an asymmetric clump over that of the sphere that encloses it.
  static constexpr double clump_share = 0.479;

  std::string grain = "sphere";
  double smallest_diameter = 0.25e-3, largest_diameter = 0.75e-3;
  std::vector<double> sieve_diameters, sieve_passing;
  double density = 2600, friction_angle = 18 * degree;
  double void_ratio = 0.6, inertial_number = 3e-3;
  std::string way = "compaction";
  std::optional<double> compaction_friction_angle;
  std::int64_t seed = 1;

  void declare_sand(Parameters& p) {
    p.add("grain", grain)
        .one_of({"sphere", "clump"})
        .doc("spheres, or asymmetric clumps of four; diameters of clumps are those of the enclosing sphere");
    p.add("smallest_diameter", smallest_diameter).unit("m").symbol("d_min").above(0).doc("of the grains");
    p.add("largest_diameter", largest_diameter)
        .unit("m")
        .symbol("d_max")
        .above(0)
        .doc("of the grains; diameters are uniform by number in between, unless there are sieves");
    p.add("sieve_diameters", sieve_diameters)
        .unit("m")
        .above(0)
        .doc("openings of sieves, rising from the smallest to the largest diameter; empty: uniform by number");
    p.add("sieve_passing", sieve_passing)
        .at_least(0)
        .at_most(1)
        .doc("share of the mass that passes each sieve, rising from 0 to 1; even by mass in between");
    p.add("density", density).unit("kg/m^3").symbol("rho").above(0).doc("of the grains");
    p.add("friction_angle", friction_angle)
        .unit("rad")
        .symbol("mu")
        .at_least(0)
        .below(std::numbers::pi / 2)
        .doc("between grains, during shear; other parameters of the sand are overridden by /materials/sand");
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
            complain("sieve_passing", std::to_string(passing.size()) + " shares",
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
                     "shares that rise from 0 to 1");
        },
        {"smallest_diameter", "largest_diameter", "sieve_diameters", "sieve_passing"});
  }
  void declare_void_ratio(Parameters& p) {
    p.add("void_ratio", void_ratio)
        .symbol("e_0")
        .at_least(0.2)
        .at_most(2)
        .doc("of the interior, one mean diameter or more off the walls, before shear; reached within 0.01 or failed");
  }
  void declare_course(Parameters& p) {
    p.add("preparation", way)
        .one_of({"compaction", "growth"})
        .doc(
            "walls press a cloud of grains together, or grains of a cloud in the final box grow while its walls stand");
    p.add("preparation_inertial_number", inertial_number)
        .above(0)
        .at_most(0.1)
        .doc("during preparation; the faster, the less time it takes and the less uniform the specimen");
    p.add("compaction_friction_angle", compaction_friction_angle)
        .unit("rad")
        .at_least(0)
        .below(std::numbers::pi / 2)
        .doc(
            "between grains while the cloud is compacted or grows; left out: as was found to lead somewhat above the "
            "void ratio");
    p.add("seed", seed).at_least(0).doc("of the grains' sizes and places");
  }

  /// By number [m].
  double mean_diameter() const {
    if (sieve_diameters.empty()) return 0.5 * (smallest_diameter + largest_diameter);
    return over_sieves([](double a, double b) { return 1 / (a * b); }) / over_sieves(inverse_cube);
  }
  /// Grains that fill a volume [m³] at the wanted void ratio.
  std::int64_t grains(double volume) const {
    // Mean of d³ of a uniform distribution.
    const double a = smallest_diameter, b = largest_diameter;
    const double cube = sieve_diameters.empty() ? 0.25 * (a + b) * (a * a + b * b) : 1 / over_sieves(inverse_cube);
    return std::llround(volume / (1 + void_ratio) / (std::numbers::pi / 6 * cube * solid_share()));
  }
  bool grows() const { return way == "growth"; }
  /// Volume of the cloud for a specimen of this volume, or its length where it is longer along one axis alone. Grains
  /// that grow fill it when friction has led them above the wanted void ratio.
  double in_cloud(double specimen) const {
    const double solids = specimen / (1 + void_ratio);
    return grows() ? solids * (1 + aimed_at()) : solids / (cloud_solid_fraction * solid_share());
  }

  /// A grain moves its own size under the pressure [Pa] in this time [s]: the clock of everything inertial.
  double inertial_time(double pressure) const { return mean_diameter() * std::sqrt(density / pressure); }
  /// In which what was disturbed comes to rest [s].
  double settling_time(double pressure) const {
    return 200 * inertial_time(pressure) / std::sqrt(inertial_number / 1e-2);
  }
  /// Of walls that close on a specimen of this length [m], together, under a pressure [Pa]: m/s.
  double closing_speed(double length, double pressure) const {
    return inertial_number * length / inertial_time(pressure);
  }
  /// Lets the servo of a wall that closed with `speed` [m/s] follow, in `stage`, a specimen that is driven along it
  /// with `driven` [m/s]: up flanks of 45 degrees it rises as fast, and jerks on its way.
  static void let_keep_up(Description& stage, const char* wall, double speed, double driven) {
    if (speed < 2 * driven) stage["change"]["walls"][wall]["motion"]["servo"]["max_velocity"] = 2 * driven;
  }

  /// What `walls` [m], as densest_between has them, keep the interior to, and `loosest`, to which compaction leads.
  VoidRatioRange reachable(const Vec3& walls, double loosest) const {
    return {densest_between(walls / mean_diameter()), grows() ? loosest_by_growth : loosest};
  }
  /// Throws Error for a void ratio out of the range, unless the friction of compaction is the user's own, or grains are
  /// not the spheres that it was measured of. `pressure` [Pa] is named.
  void refuse_out_of(const VoidRatioRange& range, double pressure) const {
    if (compaction_friction_angle || grain != "sphere" || (void_ratio >= range.densest && void_ratio <= range.loosest))
      return;
    std::ostringstream text;
    text.precision(3);
    text << "/scenario/void_ratio: found " << void_ratio
         << "; in a specimen of this size this grading can be prepared between " << range.densest
         << " (without friction) and " << range.loosest << " (high friction, then its own) under " << pressure * 1e-3
         << " kPa; wish for one in this range";
    throw Error(text.str());
  }
  /// Sees to it that the sides of a specimen [m], each with its key, are four of the largest grains or more.
  void check_box(Parameters& p, const std::vector<std::pair<std::string, const double*>>& sides) const {
    std::vector<std::string> keys{"largest_diameter"};
    for (const auto& [key, side] : sides) keys.push_back(key.substr(0, key.find('/')));
    p.check(
        [this, sides](const Complain& complain) {
          for (const auto& [key, side] : sides) check_side(complain, key, *side, 4, largest_diameter);
        },
        keys);
  }

  /// "200 kPa, e0 = 0.6".
  std::string words(double pressure) const {
    std::ostringstream text;
    text.precision(3);
    text << std::lround(pressure * 1e-3) << " kPa, e0 = " << void_ratio;
    return text.str();
  }
  Description sand() const { return {{"density", density}, {"friction_angle", friction_angle}}; }
  /// The grains, a cloud between two corners.
  Description cloud(const Description& low, const Description& high, std::int64_t count) const {
    const double size = size_at_start();
    Description sizes = {
        {"type", "uniform"}, {"smallest", size * smallest_diameter}, {"largest", size * largest_diameter}};
    if (!sieve_diameters.empty()) {
      sizes = {{"type", "sieve"}, {"diameters", sieve_diameters}, {"passing", sieve_passing}};
      for (Description& diameter : sizes["diameters"]) diameter = size * diameter.get<double>();
    }
    Description group = {
        {"type", grain},
        {"material", "sand"},
        {"grains", {{"type", "cloud"}, {"low", low}, {"high", high}, {"count", count}, {"sizes", sizes}}}};
    if (grain == "clump") group["shape"] = {{"type", "asymmetric"}};
    return group;
  }

  /// Stages "compact" (friction leads somewhat above the wanted void ratio), "densify" (friction falls until it is
  /// there, or until it has vanished and the grains rest) and "settle" (friction is the sand's own). Of all `walls`,
  /// the `pressing` ones are servo-controlled to `pressure` [Pa] and close in `closing` [s]; `compacted` says what
  /// friction leads to. Where grains grow, "grow" and "press" take the place of "compact", and the pressing walls,
  /// which stand until then, go by their servos after it.
  std::vector<Description> stages(Description& walls, const std::vector<std::string>& pressing, double pressure,
                                  double closing, std::span<const Compacted> compacted) const {
    const double settling = settling_time(pressure);
    const double loose_angle =
        compaction_friction_angle.value_or(friction_for(aimed_at(), grows() ? grown_in_a_cube : compacted));
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
    compact["usual_time"] = closing;
    densify["name"] = "densify";
    densify["ramps"] = Description::array({{{"pointer", "/materials/sand/friction_angle"},
                                            {"from", loose_angle},
                                            {"to", 0.0},
                                            {"duration", settling},
                                            {"increments", 100}}});
    // Without friction grains that rest stay as dense as they are; whether that is near enough, "settle" says.
    const Description without_friction = {{"type", "time"}, {"value", settling}},
                      rest = {{"type", "unbalanced-force"}, {"below", 1e-4}};
    densify["until"] = {
        {"type", "any"},
        {"of", Description::array({{{"type", "void-ratio"}, {"below", void_ratio}},
                                   {{"type", "all"}, {"of", Description::array({without_friction, rest})}}})}};
    densify["limit"] = 5 * settling;
    densify["usual_time"] = 0.6 * settling;
    settle["name"] = "settle";
    settle["change"]["materials"] = friction(friction_angle);
    settle["until"] = at_rest(0.005, 2e-3);
    settle["limit"] = 15 * settling;
    settle["usual_time"] = 0.01 * settling;
    settle["expect"] = {{"void_ratio", void_ratio}, {"within", 0.01}};
    if (!grows()) return {compact, densify, settle};

    // The same strain rate as that of walls that close at the inertial number; slowly once grains come to touch.
    const double rate = inertial_number / inertial_time(pressure), slow_rate = rate / 20;
    const double nearly_there = 0.05;  // void ratio above which grains do not bear each other yet
    Description grow, press;
    grow["name"] = "grow";
    grow["change"]["materials"] = friction(loose_angle);
    grow["growth"]["rate"] = rate;
    grow["until"] = {{"type", "any"},
                     {"of", Description::array({{{"type", "void-ratio"}, {"below", aimed_at() + nearly_there}},
                                                {{"type", "mean-stress"}, {"above", 0.1 * pressure}}})}};
    grow["limit"] = -2 * std::log(size_at_start()) / rate;
    grow["usual_time"] = -0.8 * std::log(size_at_start()) / rate;
    press["name"] = "press";
    press["growth"]["rate"] = slow_rate;
    press["until"] = {{"type", "mean-stress"}, {"above", pressure}};
    press["limit"] = 0.2 / slow_rate;
    press["usual_time"] = 0.025 / slow_rate;
    for (const std::string& wall : pressing) {
      densify["change"]["walls"][wall]["motion"] = walls[wall]["motion"];
      walls[wall].erase("motion");
    }
    return {grow, press, densify, settle};
  }

 private:
  /// Void ratio that friction is to lead to; lowering it does the rest.
  double aimed_at() const { return void_ratio + 0.03; }
  /// Of grains in the cloud, over that of the specimen's.
  double size_at_start() const {
    return grows() ? std::cbrt(cloud_solid_fraction * solid_share() * (1 + aimed_at())) : 1;
  }
  /// Volume of a grain over that of a sphere of its diameter.
  double solid_share() const { return grain == "clump" ? clump_share : 1; }

  // Mean of d⁻³ between two sieves, by mass: what a mass holds of grains.
  static double inverse_cube(double a, double b) { return (a + b) / (2 * a * a * b * b); }
  // Sum over the sieves of what one holds, by its share of the mass.
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
      const double share = std::max(0.0, void_ratio - a.void_ratio) / (b.void_ratio - a.void_ratio);
      return a.friction_angle + share * (b.friction_angle - a.friction_angle);
    }
    return compacted.back().friction_angle;
  }
};

}  // namespace grit
