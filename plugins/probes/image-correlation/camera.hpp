// Pictures of discs with speckles. See README.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image.hpp"

namespace grit {

/// A sphere as the camera sees it; lengths in pixels.
struct Disc {
  double x, y;       ///< of its centre in the picture
  double depth;      ///< of its centre, away from the camera, from where light begins to fade
  double radius;     ///< above 0
  double angle;      ///< by which it has turned, anticlockwise in the picture [rad]
  std::uint32_t id;  ///< says which speckles it has
};

/// Sees along parallel lines, without a lens's errors and without noise.
class Camera {
 public:
  /// `fade`: depth at which the light is half of what it is at the face, in pixels, above 0.
  Camera(std::uint64_t seed, double fade);
  /// The same bits for the same discs, in whatever order they come.
  Image picture(std::span<const Disc> discs, std::ptrdiff_t width, std::ptrdiff_t height) const;

 private:
  struct Skin;
  Skin skin(const Disc& disc) const;
  void shade(const Skin& skin, float x, float y, std::span<const float> depth, float* light) const;

  std::uint64_t seed_;
  float fade_;
  std::vector<std::int8_t> speckles_;  ///< a periodic pattern that every grain has a part of
};

}  // namespace grit
