#include "domain/population_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies/restored.hpp"

namespace grit {

void PopulationStatistics::find_heaviest(const Bodies& bodies, std::size_t first) {
  for (std::size_t i = first; i < bodies.count(); ++i)
    if (const double per_mass = bodies.velocity[i].w, r = bodies.position[i].w; per_mass > 0)
      heaviest = std::max(heaviest, 1 / (per_mass * r * r * r));
}

void PopulationStatistics::add(const Bodies& bodies, std::size_t first, std::size_t first_clump,
                               std::span<const double> unscaled_shares) {
  const auto count = [&](std::size_t body, double inverse_mass) {
    mass += (unscaled_shares.empty() ? 1 : unscaled_shares[body]) / inverse_mass, scaled_mass += 1 / inverse_mass;
  };
  find_heaviest(bodies, first);
  for (std::size_t i = first; i < bodies.count(); ++i) {
    const double r = bodies.position[i].w;
    largest_radius = std::max(largest_radius, r);
    smallest_radius = smallest_radius == 0 ? r : std::min(smallest_radius, r);
    one_material = one_material && bodies.material[i] == 0;
    if (bodies.clumps.clump_of(i) != no_clump) continue;
    ++particles;
    count(i, bodies.velocity[i].w);
    diameters += 2 * r, solids += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  }
  for (std::size_t c = first_clump; c < bodies.clumps.clump.size(); ++c) {
    const Clump& clump = bodies.clumps.clump[c];
    ++particles;
    count(bodies.clumps.spheres[clump.first], clump.inverse_mass);
    diameters += 2 * clump.radius, solids += clump.volume;
  }
  if (particles > 0) mean_diameter = diameters / static_cast<double>(particles), solid_density = scaled_mass / solids;
}

void PopulationStatistics::scale(const Bodies& bodies, double gained) {
  scaled_mass += gained;
  if (particles > 0) solid_density = scaled_mass / solids;
  heaviest = 0;
  find_heaviest(bodies, 0);
}

void PopulationStatistics::check_restored(const Bodies& bodies) const {
  constexpr double rounding = 1e-6;  // growth multiplies these and the radii one by one
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    const double radius = bodies.position[i].w;
    expect_restored(radius <= (1 + rounding) * largest_radius && radius >= (1 - rounding) * smallest_radius,
                    "a body is larger or smaller than all that ever entered");
  }
  expect_restored(std::isfinite(largest_radius) && std::isfinite(mean_diameter) && std::isfinite(mass) &&
                      std::isfinite(solid_density) && (particles == 0 || (smallest_radius > 0 && mean_diameter > 0)) &&
                      (particles > 0 || bodies.count() == 0),
                  "the sizes or the masses of all bodies are not numbers");
}

void PopulationStatistics::grow(double factor, double mass_inside) {
  const double gained = (factor * factor * factor - 1) * mass_inside;
  mass += gained, scaled_mass += gained, solids += gained / solid_density;
  diameters *= factor, mean_diameter *= factor;
  largest_radius *= factor, smallest_radius *= factor;
}

}  // namespace grit
