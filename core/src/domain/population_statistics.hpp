// Sizes and masses of all bodies that ever entered the domain.
#pragma once

#include <cstddef>
#include <span>

#include "bodies/bodies.hpp"
#include "grit/archive.hpp"

namespace grit {

/// A clump counts as one particle, of the diameter of its enclosing sphere.
struct PopulationStatistics {
  std::size_t particles = 0;                       ///< single spheres and clumps
  double mass = 0, diameters = 0, solids = 0;      ///< sums over particles, without density scaling: kg, m, m³
  double scaled_mass = 0;                          ///< the same with density scaling [kg]
  double mean_diameter = 0, solid_density = 0;     ///< m, kg/m³ with density scaling
  double largest_radius = 0, smallest_radius = 0;  ///< of spheres [m]
  double heaviest = 0;  ///< largest mass over radius cubed of a sphere, or of the clump of a sphere [kg/m³]
  bool one_material = true;

  /// Counts the bodies from `first` on, and the clumps from `first_clump` on. `unscaled_shares`: mass without density
  /// scaling over mass of each body; empty if all are 1.
  void add(const Bodies& bodies, std::size_t first, std::size_t first_clump, std::span<const double> unscaled_shares);
  /// The masses of the bodies, those that have left aside, have changed by `gained` in all [kg].
  void scale(const Bodies& bodies, double gained);
  /// All lengths have grown by `factor`; `mass_inside` [kg] has grown by its cube.
  void grow(double factor, double mass_inside);

  /// Throws Error unless restored statistics fit restored bodies.
  void check_restored(const Bodies& bodies) const;
  void serialize(Archive& archive) {
    archive(particles, mass, scaled_mass, diameters, solids, mean_diameter, solid_density, largest_radius,
            smallest_radius, heaviest, one_material);
  }

 private:
  void find_heaviest(const Bodies& bodies, std::size_t first);
};

}  // namespace grit
