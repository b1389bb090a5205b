// Sizes and masses of all bodies that ever entered the domain.
#pragma once

#include <cstddef>

#include "bodies/bodies.hpp"
#include "grit/archive.hpp"

namespace grit {

/// A clump counts as one particle, of the diameter of its enclosing sphere.
struct PopulationStatistics {
  std::size_t particles = 0;                       ///< single spheres and clumps
  double mass = 0, diameters = 0, solids = 0;      ///< sums over particles: kg, m, m³
  double mean_diameter = 0, solid_density = 0;     ///< m, kg/m³
  double largest_radius = 0, smallest_radius = 0;  ///< of spheres [m]
  double heaviest = 0;  ///< largest mass over radius cubed of a sphere, or of the clump of a sphere [kg/m³]
  bool one_material = true;

  /// Counts the bodies from `first` on, and the clumps from `first_clump` on.
  void add(const Bodies& bodies, std::size_t first, std::size_t first_clump);
  /// All lengths have grown by `factor`; `mass_inside` [kg] has grown by its cube.
  void grow(double factor, double mass_inside);

  /// Throws Error unless restored statistics fit restored bodies.
  void check_restored(const Bodies& bodies) const;
  void serialize(Archive& archive) {
    archive(particles, mass, diameters, solids, mean_diameter, solid_density, largest_radius, smallest_radius, heaviest,
            one_material);
  }
};

}  // namespace grit
