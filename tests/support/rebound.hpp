// A sphere that comes down on a plane and leaves it again.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "support/scene.hpp"

namespace grit::test {

struct Rebound {
  Vec3 velocity, spin;
};

/// A sphere that comes down on a rigid plane; it is a share `away` of a step's way above it at first.
inline Rebound from_plane(const std::string& law, const Description& material, const Description& rigid, double radius,
                          const Vec3& velocity, const Vec3& spin, double dt, double away = 0) {
  const double gap = -velocity.z() * dt * away;
  Description d = description(law, material, {{{0, 0, radius + gap}, radius, velocity, spin}});
  d["materials"]["rigid"] = rigid;
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ(), "rigid");
  d["time_step"]["value"] = dt;
  d["guards"] = {{"energy", 1}};
  Trial t(d);
  bool touched = away == 0;
  do t.step(), touched = touched || t.position(0).z() < radius;
  while (!touched || t.position(0).z() < radius);
  return {t.velocity(0), t.spin(0)};
}

/// Degrees from the normal of the plane.
inline Vec3 aslant(double speed, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {speed * std::sin(angle), 0, -speed * std::cos(angle)};
}

}  // namespace grit::test
