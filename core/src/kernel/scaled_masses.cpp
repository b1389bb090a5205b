#include "kernel/scaled_masses.hpp"

#include <cmath>

#include "kernel/body_groups.hpp"

namespace grit {
namespace {

bool scales(const Settings& settings) {
  return settings.any_motion([](const MotionSettings& motion) { return motion.scaled_radius > 0; });
}

}  // namespace

std::vector<double> unscaled_shares(const Bodies& bodies, const Settings& settings) {
  if (!scales(settings)) return {};
  const std::vector<std::uint16_t> group = groups_of(bodies, settings.groups);
  std::vector<double> shares(bodies.count());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const std::uint32_t c = bodies.clumps.clump_of(i);
    const double radius = c == no_clump ? bodies.position[i].w : bodies.clumps.clump[c].radius;
    shares[i] = settings.motion_of(group[i]).unscaled_share(radius);
  }
  return shares;
}

double scale_masses(Bodies& bodies, const Settings& before, const Settings& now) {
  if (!scales(before) && !scales(now)) return 0;
  double gained = 0;
  const std::vector<std::uint16_t> group = groups_of(bodies, now.groups);
  // Of the radii that determine mass and inertia, before over now.
  const auto ratio = [&](std::size_t body, double radius) {
    return now.motion_of(group[body]).unscaled_ratio(radius) / before.motion_of(group[body]).unscaled_ratio(radius);
  };
  for (std::size_t i = 0; i < bodies.count(); ++i)
    if (bodies.clumps.clump_of(i) == no_clump) {
      const double of = ratio(i, bodies.position[i].w);
      gained -= 1 / bodies.velocity[i].w;
      bodies.velocity[i].w *= std::pow(of, 3), bodies.spin[i].w *= std::pow(of, 5);
      gained += 1 / bodies.velocity[i].w;
    }
  for (Clump& clump : bodies.clumps.clump) {
    const double of = ratio(bodies.clumps.spheres[clump.first], clump.radius), of_inertia = std::pow(of, 5);
    gained -= 1 / clump.inverse_mass;
    clump.inverse_mass *= std::pow(of, 3);
    gained += 1 / clump.inverse_mass;
    clump.inertia /= of_inertia, clump.momentum /= of_inertia;
    for (std::uint32_t k = clump.first; k < clump.last; ++k) {
      const std::uint32_t i = bodies.clumps.spheres[k];
      bodies.velocity[i].w = clump.inverse_mass, bodies.spin[i].w *= of_inertia;
    }
  }
  return gained;
}

}  // namespace grit
