// Fields of a continuum that grains and their contacts make, on a grid of points.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "grit/world.hpp"

namespace grit {

/// Points at first + (i, j, k) · step, k running fastest.
struct PointGrid {
  Vec3 first, step;  ///< m
  std::array<std::size_t, 3> count{0, 0, 0};

  std::size_t size() const { return count[0] * count[1] * count[2]; }
  Vec3 at(std::size_t i, std::size_t j, std::size_t k) const {
    return first + step.cwiseProduct(Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
  }
};

/// At one point. See README.md.
struct CoarseFields {
  double density = 0;              ///< kg/m³
  Vec3 momentum = Vec3::Zero();    ///< kg/(m² s)
  Mat3 kinetic = Mat3::Zero();     ///< stress of fluctuations, Pa, compression positive
  Mat3 contact = Mat3::Zero();     ///< stress of contacts, Pa, compression positive
  Vec3 wall_force = Vec3::Zero();  ///< that walls exert on grains, N/m³

  Vec3 velocity() const { return density > 0 ? Vec3(momentum / density) : Vec3::Zero(); }
};

/// By points of the grid, smoothed over `cutoff` [m]. Periodic images count.
std::vector<CoarseFields> coarse_fields(const World& world, const PointGrid& grid, double cutoff);

}  // namespace grit
