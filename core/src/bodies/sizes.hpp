// Diameters of grains from a size distribution.
#pragma once

#include <cstddef>
#include <vector>

#include "bodies/random.hpp"
#include "description/description.hpp"

namespace grit {

/// Diameters [m] of `count` grains, in random order. They are not drawn one by one: each of `count` equal shares of the
/// number gives its middle grain, at the quantile (i + ½)/count, so that the sample's curve keeps to the wanted one as
/// closely as `count` allows (by mass: to the share of the largest grain). Curves by mass become numbers by 1/d³.
/// Throws grit::Error where a sieve curve is none.
std::vector<double> draw_diameters(const UniformSizes& sizes, std::size_t count, Random& random);
std::vector<double> draw_diameters(const LinearSizes& sizes, std::size_t count, Random& random);
std::vector<double> draw_diameters(const LogNormalSizes& sizes, std::size_t count, Random& random);
std::vector<double> draw_diameters(const SieveSizes& sizes, std::size_t count, Random& random);
/// As given, again and again, in the order given.
std::vector<double> draw_diameters(const ListSizes& sizes, std::size_t count, Random& random);
/// Of whatever was chosen. Throws grit::Error if nothing was.
std::vector<double> draw_diameters(const Sizes& sizes, std::size_t count, Random& random);

}  // namespace grit
