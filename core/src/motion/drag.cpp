#include "motion/drag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grit {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

void Drag::declare(Parameters& p) {
  p.add("viscosity", viscosity_).unit("Pa s").symbol("mu").above(0).required().doc("dynamic viscosity of the fluid");
  p.add("density", density_)
      .unit("kg/m^3")
      .symbol("rho")
      .at_least(0)
      .doc("density of the fluid; Stokes drag ignores it");
  p.add("velocity", velocity_).unit("m/s").symbol("u").doc("velocity of the fluid");
  p.add("law", law_)
      .one_of({"stokes", "schiller-naumann"})
      .doc(
          "Stokes: 3 pi mu d u; Schiller and Naumann: 1 + 0.15 Re^0.687 times as much, and at least a drag coefficient "
          "of 0.44, which governs above Re = 1000");
}

double Drag::coefficient(double diameter, double speed) const {
  const double stokes = 3 * pi * viscosity_ * diameter;
  if (law_ == "stokes") return stokes;
  const double reynolds = density_ * speed * diameter / viscosity_;
  // Newton's regime, C_D = 0.44, is C_D Re / 24 times Stokes' drag.
  const double transitional = 1 + 0.15 * std::pow(std::min(reynolds, 1000.0), 0.687);
  return stokes * std::max(transitional, 0.44 * reynolds / 24);
}

/// Calls use(Grain, indices of its bodies, weights that add up to 1) for each single sphere and each clump.
template <class Use>
void Drag::each_grain(const World& world, Use use) const {
  const auto positions = world.positions(), velocities = world.velocities(), spins = world.spins();
  const auto clump_of = world.clump_of();
  const auto clumps = world.clumps();
  const auto fractions = world.volume_fractions();
  const auto cubed = [&](std::size_t i) {
    return std::pow(2 * positions[i].w, 3) * (fractions.empty() ? 1 : fractions[i]);
  };
  std::vector<std::vector<std::size_t>> spheres(clumps.size());
  std::vector<double> weights{1};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!clump_of.empty() && clump_of[i] != no_clump) {
      spheres[clump_of[i]].push_back(i);
      continue;
    }
    const std::size_t alone[] = {i};
    use(Grain{2 * positions[i].w, xyz(velocities[i]), xyz(spins[i]), velocities[i].w, spins[i].w},
        std::span<const std::size_t>(alone), std::span<const double>(weights.data(), 1));
  }
  for (std::size_t c = 0; c < clumps.size(); ++c) {
    double volume = 0;
    weights.clear();
    for (const std::size_t i : spheres[c]) weights.push_back(cubed(i)), volume += weights.back();
    for (double& weight : weights) weight /= volume;
    use(Grain{std::cbrt(volume), clumps[c].velocity, clumps[c].spin, 1 / clumps[c].mass,
              1 / clumps[c].inertia.minCoeff()},
        std::span<const std::size_t>(spheres[c]), std::span<const double>(weights));
  }
}

void Drag::forces(const World& world, std::span<Row> force, std::span<Row> moment) const {
  each_grain(world, [&](const Grain& grain, std::span<const std::size_t> bodies, std::span<const double> weights) {
    const Vec3 slip = velocity_ - grain.velocity;
    const Vec3 drag = coefficient(grain.diameter, slip.norm()) * slip,
               torque = -pi * viscosity_ * std::pow(grain.diameter, 3) * grain.spin;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const Vec3 f = weights[k] * drag, m = weights[k] * torque;
      force[bodies[k]] += Row{f.x(), f.y(), f.z(), 0}, moment[bodies[k]] += Row{m.x(), m.y(), m.z(), 0};
    }
  });
}

EngineRates Drag::rates(const World& world) const {
  // The derivative of c(u) u is at most 2 c: drag grows at most with the square of the speed.
  const double steepest = law_ == "stokes" ? 1 : 2;
  EngineRates rates;
  each_grain(world, [&](const Grain& grain, std::span<const std::size_t>, std::span<const double>) {
    const double c = coefficient(grain.diameter, (velocity_ - grain.velocity).norm());
    rates.damping = std::max({rates.damping, steepest * c * grain.inverse_mass,
                              pi * viscosity_ * std::pow(grain.diameter, 3) * grain.inverse_inertia});
  });
  return rates;
}

}  // namespace grit
