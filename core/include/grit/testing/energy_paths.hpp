// Work done on two bodies in contact along random paths, against the energies that their contact law reports.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "grit/testing/pairs.hpp"

namespace grit::test {

/// A smooth function of the share of a path, 0 … 1, that covers [low, high]: three waves with random phases.
class Wave {
 public:
  Wave(std::mt19937& random, bool closed, double low, double high) : frequency_(closed ? 1 : 0.77) {
    for (double& phase : phase_) phase = std::uniform_real_distribution<double>(0, 2 * std::numbers::pi)(random);
    double least = plain(0), most = least;
    for (int k = 1; k <= 200; ++k) least = std::min(least, plain(k / 200.0)), most = std::max(most, plain(k / 200.0));
    scale_ = (high - low) / (most - least), offset_ = low - scale_ * least;
  }
  double operator()(double share) const { return offset_ + scale_ * plain(share); }

 private:
  double plain(double share) const {
    double sum = 0;
    for (std::size_t k = 0; k < phase_.size(); ++k) {
      const auto order = static_cast<double>(k + 1);
      sum += std::cos(2 * std::numbers::pi * frequency_ * order * share + phase_[k]) / order;
    }
    return sum;
  }

  double frequency_, scale_ = 1, offset_ = 0;
  std::array<double, 3> phase_;
};

/// A path of two spheres with radii of 1 and 0.7 m: a random wave for each of its motions.
class EnergyPath {
 public:
  /// Bits of what the spheres do.
  enum Motion : unsigned { press = 1, part = 2, turn = 4, slip = 8, roll = 16, twist = 32 };

  /// `reach`: of the law at overlap 0 [m]. `motions`: bits of Motion; with `part` the spheres part and come back.
  EnergyPath(unsigned motions, bool closed, unsigned seed, double reach) {
    std::mt19937 random(seed);
    const auto wave = [&](unsigned motion, double low, double high) {
      const bool moves = (motions & motion) != 0;
      return Wave(random, closed, moves ? low : 0, moves ? high : 0);
    };
    const double apart = (motions & part) != 0 ? -1.5 * reach - 0.01 : 0.2 * deep;
    waves_ = {wave(press | part, apart - deep, deep),
              wave(turn, -0.02, 0.02),
              wave(turn, -0.02, 0.02),
              wave(slip, -0.05, 0.05),
              wave(slip, -0.05, 0.05),
              wave(roll, -0.1, 0.1),
              wave(roll, -0.1, 0.1),
              wave(twist, -0.1, 0.1)};
  }
  static constexpr double radius_a = 1, radius_b = 0.7, deep = 0.02;  ///< m; the overlap without waves

  /// The centre of b [m]; that of a is at rest.
  Vec3 centre(double share) const {
    const Vec3 normal = Vec3(waves_[1](share), waves_[2](share), 1).normalized();
    return (radius_a + radius_b - deep - waves_[0](share)) * normal;
  }
  /// Rotations of a and b between two shares of the path [rad].
  std::array<Vec3, 2> rotations(double from, double to) const {
    const auto change = [&](std::size_t k) { return waves_[k](to) - waves_[k](from); };
    const Vec3 slipped = Vec3(change(3), change(4), 0) / (radius_a + radius_b),
               rolled = Vec3(change(5), change(6), 0) / (radius_a + radius_b),
               twisted = 0.5 * change(7) * centre(0.5 * (from + to)).normalized();
    return {slipped - radius_b * rolled - twisted, slipped + radius_a * rolled + twisted};
  }

 private:
  std::vector<Wave> waves_;
};

/// Energies of two bodies on a path [J].
struct PathEnergies {
  double work = 0;    ///< done on them
  double stored = 0;  ///< elastic energy at the end less that at the start
  Losses lost;
  double turnover = 0;   ///< sum of the magnitudes of the work of all steps
  double returned = 0;   ///< largest decrease of one of the losses
  bool reports = false;  ///< whether there are losses in contacts that go on
  double missing() const { return work - stored - lost.friction - lost.rolling - lost.viscosity; }
};

/// Leads two spheres of 1 kg along a path in `duration` [s].
inline PathEnergies energies_along(const EnergyPath& path, const ContactLaw& law, double duration, int steps) {
  Pairs pairs(law, duration / steps);
  pairs.add({.radius = EnergyPath::radius_a});
  pairs.add({.position = path.centre(0), .radius = EnergyPath::radius_b});
  pairs.pair(0, 1);
  pairs.evaluate();
  const auto stored = [&] {
    if (!pairs.touching(0)) return 0.0;
    const PairSize size{.radius_a = EnergyPath::radius_a,
                        .radius_b = EnergyPath::radius_b,
                        .inverse_mass_a = 1,
                        .inverse_mass_b = 1,
                        .overlap = pairs.overlap(0)};
    return law.energy(size, 0, 0, pairs.state(0)).total();
  };
  PathEnergies result;
  Losses most;
  const double at_start = stored();
  pairs.losses = &result.lost;
  for (int step = 1; step <= steps; ++step) {
    const double from = double(step - 1) / steps, to = double(step) / steps;
    const Vec3 way = path.centre(to) - vec(pairs.position(1));
    const auto [turn_a, turn_b] = path.rotations(from, to);
    // Half of the work is that of the forces at the start of the step, half that of those at its end.
    const auto half = [&, a = turn_a, b = turn_b] {
      return -0.5 *
             (vec(pairs.row(0).force).dot(way) + vec(pairs.sum(0).moment).dot(a) + vec(pairs.row(0).moment).dot(b));
    };
    const double at_first = half();
    const bool touched = pairs.touching(0);
    const Losses before = result.lost;
    set(pairs.position(1), path.centre(to));
    set(pairs.velocity(1), way / pairs.dt), set(pairs.spin(0), turn_a / pairs.dt),
        set(pairs.spin(1), turn_b / pairs.dt);
    pairs.evaluate();
    const double share = at_first + half();
    result.work += share, result.turnover += std::abs(share);
    for (const auto kind : {&Losses::friction, &Losses::rolling, &Losses::viscosity}) {
      most.*kind = std::max(most.*kind, result.lost.*kind);
      result.returned = std::max(result.returned, most.*kind - result.lost.*kind);
      if (touched && pairs.touching(0) && result.lost.*kind != before.*kind) result.reports = true;
    }
  }
  result.stored = stored() - at_start;
  return result;
}

/// What is wrong with the energies that a law reports for bodies of its first material, in words; empty if they are
/// right. `losses`: whether the law reports what it dissipates; else no more is asked than that it creates no energy.
inline std::vector<std::string> energy_faults(const ContactLaw& law, bool losses = true) {
  using Path = EnergyPath;
  constexpr unsigned all = Path::turn | Path::slip | Path::roll | Path::twist;
  struct Kind {
    const char* name;
    unsigned motions;
  };
  constexpr Kind kinds[] = {{"pressed", Path::press},
                            {"pressed and parted", Path::part},
                            {"sheared", Path::slip},
                            {"rolled", Path::roll},
                            {"twisted", Path::twist},
                            {"pressed, sheared, rolled and twisted", Path::press | all},
                            {"pressed, sheared, rolled, twisted and parted", Path::part | all}};
  // Open paths of the first seed end less deep than they begin, of the second deeper.
  constexpr unsigned seeds[] = {2, 7};
  // Steps of the path, and four times as long ones. The error of a right law falls with the step.
  constexpr int fine = 2000, coarse = 500;
  constexpr double always_allowed = 1e-3, allowed = 3e-3, falls_to = 0.6, may_return = 1e-3, rounding = 1e-12;

  const PairSize size{Path::radius_a, Path::radius_b, 1, 1, Path::deep},
      touching{Path::radius_a, Path::radius_b, 1, 1, 0};
  // About the period of the two bodies, so that dashpots matter as springs do. The losses of dashpots take each step as
  // one of free motion, an error in proportion to their damping ratio.
  const Stiffness stiffness = law.stiffness(size, 0, 0);
  const double damping_ratio = std::max(stiffness.damping_ratio, stiffness.shear_damping_ratio);
  const double duration = 6 * std::sqrt(0.5 / stiffness.normal) / std::max(1.0, 2 * damping_ratio);
  struct Result {
    std::string name;
    PathEnergies fine, coarse;
  };
  std::vector<Result> results;
  double largest = 0;
  for (const Kind& kind : kinds)
    for (const bool closed : {false, true})
      for (const unsigned seed : seeds) {
        const Path path(kind.motions, closed, seed, law.reach(touching, 0, 0));
        const PathEnergies finely = energies_along(path, law, duration, fine);
        results.push_back({std::string(kind.name) + (closed ? ", and back to the start" : ""), finely,
                           energies_along(path, law, duration, coarse)});
        largest = std::max(largest, finely.turnover);
      }

  std::vector<std::string> faults;
  for (const auto& [name, now, before] : results) {
    const auto share = [&](const PathEnergies& one, double energy) {
      return energy / std::max({one.turnover, rounding * largest, 1e-300});
    };
    const auto note = [&, &name = name, &now = now](const std::string& what) {
      std::ostringstream text;
      text << "two bodies that are " << name << ": " << what << " (work " << now.work << " J, stored " << now.stored
           << " J, friction " << now.lost.friction << " J, rolling " << now.lost.rolling << " J, viscosity "
           << now.lost.viscosity << " J)";
      faults.push_back(text.str());
    };
    const auto percent = [](double part) {
      std::ostringstream text;
      text << 100 * part << " %";
      return text.str();
    };
    double error = share(now, now.missing()), coarse_error = share(before, before.missing());
    // What such a law dissipates is missing.
    if (!losses) error = std::min(error, 0.0), coarse_error = std::min(coarse_error, 0.0);
    const double size_of_error = std::abs(error);
    if (!(size_of_error <= allowed) ||
        (size_of_error > always_allowed && size_of_error > falls_to * std::abs(coarse_error)))
      note(percent(size_of_error) + " of the energy turned over " +
           (error < 0 ? "is reported without work" : "is reported nowhere") + ", " + percent(std::abs(coarse_error)) +
           " with steps four times as long; see losses() and energy()" +
           (losses && !now.reports && error > 0 ? "; a law without losses() says so by LawSetup::losses = false" : ""));
    if (share(now, now.returned) > may_return)
      note(percent(share(now, now.returned)) + " of the energy turned over was lost and came back; see losses()");
    if (!losses && now.reports) note("the law reports losses; set LawSetup::losses, so that they are tested");
  }
  return faults;
}

}  // namespace grit::test
