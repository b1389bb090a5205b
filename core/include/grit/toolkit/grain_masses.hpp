// Sums over the masses of grains.
#pragma once

#include "grit/world.hpp"

namespace grit {

/// Sum of mass times `of(centre)` over all grains, without density scaling; a clump counts once, as a whole.
template <class Of>
double over_masses(const World& world, Of of) {
  double sum = 0;
  const auto clump_of = world.clump_of();
  const auto shares = world.unscaled_shares();
  for (std::size_t i = 0; i < world.positions().size(); ++i)
    if (clump_of.empty() || clump_of[i] == no_clump)
      sum += of(xyz(world.positions()[i])) * (shares.empty() ? 1 : shares[i]) / world.velocities()[i].w;
  for (const ClumpView& clump : world.clumps()) sum += of(clump.centre) * clump.unscaled_mass;
  return sum;
}

/// Mass of all grains in the domain, without density scaling [kg].
inline double mass_of(const World& world) {
  return over_masses(world, [](const Vec3&) { return 1.0; });
}

/// Mass of all bodies that left through open sides [kg].
inline double departed_mass_of(const World& world) {
  double sum = 0;
  for (const Departure& gone : world.departures()) sum += gone.mass;
  return sum;
}

}  // namespace grit
