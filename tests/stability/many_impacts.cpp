// Undamped grains that collide repeatedly: the gain or loss of energy in one impact is random, but the mean over all
// phases of a step at which it may start is a gain.
//
// If two grains meet at a normal speed w with a phase φ, the fraction of the displacement w dt of a step after first
// contact, the leap-frog sum of the work of a force k δ^α differs from the integral by k (w dt)^(α+1) ζ(−α, φ), with
// Hurwitz's ζ (Euler–Maclaurin); at separation, by as much with the opposite sign. Over all φ the mean is zero and the
// variance is 2 Γ(1+α)² ζ(2+2α)/(2π)^(2+2α) (Hurwitz). The mean gain of an impact follows from its variance b(E):
// leap-frog conserves phase-space volume, dx dw = dt dφ dE on approach, so that a uniform distribution over E must stay
// uniform; diffusion then requires a drift of b'(E)/2, with b ~ E^(α+1).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "support/mapped.hpp"
#include "support/packing.hpp"

namespace grit::test::many_impacts_tests {
namespace {

using std::numbers::pi;

constexpr double density = 2500, modulus = 1e7, young = 1e8, poisson = 0.25;

struct Spring {
  std::string law;
  double exponent;  ///< α

  Description material() const {
    Description m{{"density", density}, {"friction_angle", 0}};
    if (exponent > 1) m["young_modulus"] = young, m["poisson_ratio"] = poisson;
    else m["contact_modulus"] = modulus;
    return m;
  }
  /// Duration of a head-on impact, from radii, reduced mass and speed [s].
  double duration(double a, double b, double mass, double fast) const {
    if (exponent == 1) return pi * std::sqrt(mass * (a + b) / (2 * modulus * a * b));
    const double stiffness = 4.0 / 3 * young / (2 * (1 - poisson * poisson)) * std::sqrt(a * b / (a + b));
    return hertz * std::pow(1.25 * mass * fast * fast / stiffness, 0.4) / fast;
  }
  /// Relative gain of energy in an impact of this many steps: mean over all phases of a step.
  double variance(double steps) const {
    // k dt^(α+1) w^(α−1) over the reduced mass.
    const double edge = exponent == 1 ? std::pow(pi / steps, 2) : 1.25 * std::pow(hertz / steps, 2.5);
    const double zeta = exponent == 1 ? std::pow(pi, 4) / 90 : 1.0369277551433699;
    const double of_an_edge = 2 * std::pow(std::tgamma(1 + exponent), 2) * zeta / std::pow(2 * pi, 2 + 2 * exponent);
    return 2 * 4 * edge * edge * of_an_edge;
  }
  double gain(double steps) const { return 0.5 * (exponent + 1) * variance(steps); }

  static constexpr double hertz = 2.943275;  ///< duration × speed over overlap

  friend void PrintTo(const Spring& spring, std::ostream* out) { *out << spring.law; }
};

constexpr double radius = 1e-3, speed = 0.1;  // of each of two grains that collide head-on
const double mass = density * 4 / 3 * pi * radius * radius * radius;

/// Adds the gains of impacts with this step that start at all phases; `first` in [0, 1) is the phase of the first.
void add_gains(const Spring& spring, double dt, double first, std::vector<double>& gains) {
  constexpr int phases = 128;
  std::vector<Grain> grains;
  for (int i = 0; i < phases; ++i) {
    const double x = radius + speed * dt * (1 + (i + first) / phases);
    for (const double side : {-1.0, 1.0})
      grains.push_back({{side * x, 3 * i * radius, 0}, radius, {-side * speed, 0, 0}});
  }
  Description d = description(spring.law, spring.material(), grains);
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"energy", 1e9}, {"travel", 1}, {"overlap", 1}};
  Trial t(d);
  t.step(static_cast<std::size_t>(spring.duration(radius, radius, mass / 2, 2 * speed) / dt) + 5);
  EXPECT_EQ(t.world().contacts().size(), 0u) << "all are separated";
  for (std::uint32_t i = 0; i < 2 * phases; i += 2) {
    const double fast = (t.velocity(i + 1) - t.velocity(i)).x() / (2 * speed);
    EXPECT_GT(fast, 0);
    gains.push_back(fast * fast - 1);
  }
}

struct Gain {
  double mean = 0, variance = 0;

  explicit Gain(const std::vector<double>& gains) {
    for (const double gain : gains) mean += gain / static_cast<double>(gains.size());
    for (const double gain : gains) variance += (gain - mean) * (gain - mean) / static_cast<double>(gains.size());
  }
  Gain(double mean, double variance) : mean(mean), variance(variance) {}
};

/// For impacts of this many steps, plus or minus half a step, equally distributed.
Gain gain_of_pairs(const Spring& spring, double steps) {
  constexpr int lengths = 16;
  std::vector<double> gains;
  for (int length = 0; length < lengths; ++length) {
    const double now = steps - 0.5 + (length + 0.5) / lengths;
    // With different phases for each: the kink at φ = 0 would have too much or too little weight.
    add_gains(spring, spring.duration(radius, radius, mass / 2, 2 * speed) / now,
              std::fmod((length + 0.5) * std::numbers::phi, 1), gains);
  }
  return Gain(gains);
}

class ManyImpacts : public testing::TestWithParam<Spring> {};

TEST_P(ManyImpacts, GainInTheMeanWhatTheirVarianceAsksFor) {
  const Spring& spring = GetParam();
  const std::string map = "mean gain of an impact, of its energy|steps that the contact lasts";
  double worst = 0;
  for (const double steps : {5.0, 7.0, 10.0, 14.0, 20.0, 30.0, 40.0, 60.0}) {
    const Gain found = gain_of_pairs(spring, steps);
    const double predicted = spring.gain(steps);
    // Neglected terms: 1/n² of the mean, and 1/n of the variance for Hertz.
    EXPECT_NEAR(found.mean / predicted, 1, 0.02 + 7 / (steps * steps)) << steps;
    EXPECT_NEAR(found.variance / spring.variance(steps), 1, 0.01 + 1.1 / steps + 3 / (steps * steps)) << steps;
    if (steps >= 7) worst = std::max(worst, std::abs(found.mean / predicted - 1));
    map_point(map, spring.law, steps, found.mean);
    map_point(map, "predicted, " + spring.law, steps, predicted);
  }
  figure("mean gain of impacts of seven steps or more, distance from what is predicted, of it", worst);
}

/// Isolated pairs take the same number of steps at any speed, so that the phase at contact determines that at
/// separation: the variance is between zero and twice that of random phases, and its change with speed contributes to
/// the mean.
TEST_P(ManyImpacts, GainLessAtASmallerSafety) {
  const Spring& spring = GetParam();
  for (const double safety : {0.8, 0.4, 0.2, 0.1}) {
    Description d =
        description(spring.law, spring.material(),
                    {{{-1.01 * radius, 0, 0}, radius, {speed, 0, 0}}, {{1.01 * radius, 0, 0}, radius, {-speed, 0, 0}}});
    d["time_step"]["safety"] = safety;
    const double dt = Trial(d).world().dt(), steps = spring.duration(radius, radius, mass / 2, 2 * speed) / dt;
    std::vector<double> gains;
    add_gains(spring, dt, 0.5, gains);
    const Gain found(gains);
    EXPECT_LT(std::abs(found.mean), (2.5 + pi / 10 * steps) * spring.variance(steps) * (1 + 7 / (steps * steps)));
    map_point("steps of a head-on impact of two alike without friction|safety", spring.law, safety, steps);
    map_point("size of the mean gain of a head-on impact of two alike, of its energy|safety", spring.law, safety,
              std::abs(found.mean));
    if (safety < 0.8) continue;
    figure("steps of a frictionless impact at the usual safety, " + spring.law, steps);
    figure("mean gain of a frictionless impact at the usual safety, " + spring.law, found.mean);
    figure("most that a frictionless impact gains at the usual safety, " + spring.law, std::ranges::max(gains));
  }
}

/// Undamped grains of several sizes in a periodic cell. Each impact is assumed to gain the mean; the standard deviation
/// is the root of the sum of the variances.
TEST_P(ManyImpacts, HeatAGasByTheirSum) {
  const Spring& spring = GetParam();
  constexpr double spacing = 2.6e-3, fast = 0.5;
  constexpr int side = 5;
  auto grains = jumble({side, side, side}, spacing, fast, 3);
  Random random(1);
  for (Grain& g : grains) g.radius = spacing * (0.26 + 0.14 * random.uniform()), g.spin = Vec3::Zero();
  Description d = description(spring.law, spring.material(), grains);
  d["domain"] = {
      {"low", {0, 0, 0}}, {"high", vector(Vec3::Constant(side * spacing))}, {"periodic", {true, true, true}}};
  // Large steps, for fast heating. Linear impacts take 4 to 6 of these steps; the number for Hertz depends on the
  // speed.
  const double middle = 0.33 * spacing, half = 0.5 * density * 4 / 3 * pi * middle * middle * middle;
  const double dt = spring.duration(middle, middle, half, 1.15 * fast) / (spring.exponent == 1 ? 5 : 4.3);
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"energy", 1e9}, {"travel", 1}, {"overlap", 1}};
  Trial t(d);
  const World& world = t.world();
  const auto energy = [&] {
    double sum = equilibrium(world).kinetic_energy;
    for (const Contact& c : world.contacts()) sum += c.normal_force * c.overlap / (spring.exponent + 1);
    return sum;
  };
  std::vector<Gain> by_steps;
  constexpr double least = 3, most = 12;
  for (double steps = least; steps <= most; ++steps) by_steps.push_back(gain_of_pairs(spring, steps));
  const auto gain_of = [&](double steps) {
    if (steps >= most) return Gain(spring.gain(steps), spring.variance(steps));
    const double place = std::max(steps - least, 0.0), part = place - std::floor(place);
    const auto a = by_steps.begin() + static_cast<std::ptrdiff_t>(place), b = a + 1;
    return Gain(a->mean * std::pow(b->mean / a->mean, part), a->variance * std::pow(b->variance / a->variance, part));
  };
  const double before = energy();
  double predicted = 0, variance = 0;
  std::size_t impacts = 0;
  using Touching = std::set<std::pair<std::uint32_t, std::uint32_t>>;
  for (Touching touched; impacts < 1000 || predicted < 10 * std::sqrt(variance);) {
    t.step();
    Touching now;
    for (const Contact& c : world.contacts()) {
      const auto pair = std::minmax(world.ids()[c.a], world.ids()[c.b]);
      if (now.insert(pair); touched.contains(pair)) continue;
      const Row &va = world.velocities()[c.a], &vb = world.velocities()[c.b];  // before the first force of this contact
      const double closing = (xyz(va) - xyz(vb)).dot(c.normal), reduced = 1 / (va.w + vb.w);
      if (closing <= 0) continue;
      const double own = 0.5 * reduced * closing * closing;
      const Gain gain =
          gain_of(spring.duration(world.positions()[c.a].w, world.positions()[c.b].w, reduced, closing) / dt);
      predicted += own * gain.mean, variance += own * own * gain.variance;
      ++impacts;
    }
    touched = std::move(now);
  }
  const double grown = energy() - before, chance = std::sqrt(variance);
  EXPECT_NEAR(grown, predicted, 3 * chance);
  figure("growth of the energy of a gas over what its impacts are predicted to gain, " + spring.law, grown / predicted);
  figure("chance in that, " + spring.law, chance / predicted);
}

INSTANTIATE_TEST_SUITE_P(All, ManyImpacts,
                         testing::Values(Spring{"linear-frictional", 1}, Spring{"hertz-mindlin", 1.5}),
                         [](const auto& info) { return std::string(info.index == 0 ? "linear" : "hertz"); });

}  // namespace
}  // namespace grit::test::many_impacts_tests
