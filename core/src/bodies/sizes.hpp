// Diameters of grains from a size distribution.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "bodies/random.hpp"
#include "description/description.hpp"

namespace grit {

/// Diameters [m] of `count` grains, in random order. They are not drawn at random: grain i is the quantile (i +
/// ½)/count, so that the grading of the sample is as close to the target as `count` allows (by mass: to the mass
/// fraction of the largest grain). Curves by mass are converted to numbers by 1/d³. Throws grit::Error for an invalid
/// sieve curve.
std::vector<double> draw_diameters(const UniformSizes& sizes, std::size_t count, Random& random);
std::vector<double> draw_diameters(const LinearSizes& sizes, std::size_t count, Random& random);
std::vector<double> draw_diameters(const LogNormalSizes& sizes, std::size_t count, Random& random);
std::vector<double> draw_diameters(const SieveSizes& sizes, std::size_t count, Random& random);
/// The listed diameters in their order, repeated as needed.
std::vector<double> draw_diameters(const ListSizes& sizes, std::size_t count, Random& random);
/// Of the chosen distribution. `shape_diameter`: of the clump as its shape was given [m]. Throws grit::Error if none
/// was chosen, or for sizes of a shape that has none.
std::vector<double> draw_diameters(const Sizes& sizes, std::size_t count, Random& random,
                                   std::optional<double> shape_diameter = {});
/// The largest diameter that the chosen distribution may give [m], with the same arguments and errors.
double largest_diameter(const Sizes& sizes, std::optional<double> shape_diameter = {});

}  // namespace grit
