// Two spheres, or a sphere and a plane, that meet head-on, integrated by leap-frog.
#pragma once

#include <algorithm>
#include <limits>

#include "grit/testing/pairs.hpp"

namespace grit::test {

struct Collision {
  double restitution, duration, overlap, force;  ///< speed after over before; s; the largest [m], [N]
};

/// Spheres of radius_a, mass_a and radius_b, mass_b at the given relative speed.
inline Collision collide(const ContactLaw& law, const Ball& a, const Ball& b, double speed, double dt) {
  Pairs pairs(law, dt);
  Ball still = a, coming = b;
  still.position = Vec3::Zero(), coming.position = {0, 0, a.radius + b.radius};
  coming.velocity = {0, 0, -speed};
  pairs.add(still), pairs.add(coming), pairs.pair(0, 1);
  Collision result{0, 0, 0, 0};
  // The first step ends inside; the speed at touch is that of free flight.
  do {
    pairs.step();
    pairs.kick();
    result.duration += dt;
    result.overlap = std::max(result.overlap, pairs.overlap(0));
    result.force = std::max(result.force, pairs.row(0).force.w);
  } while (pairs.row(0).force.w > 0);
  result.restitution = (pairs.velocity(1).z - pairs.velocity(0).z) / speed;
  return result;
}

/// The same with a wall of the given material.
inline Collision collide_with_wall(const ContactLaw& law, Ball ball, double speed, double dt,
                                   std::uint32_t material = 0) {
  ball.position = {0, 0, ball.radius}, ball.velocity = {0, 0, -speed};
  WallPair pair(law, ball, dt);
  pair.touch.material = material;
  Collision result{0, 0, 0, 0};
  do {
    pair.position.z += dt * pair.velocity.z;
    pair.touch.overlap = ball.radius - pair.position.z;
    if (pair.touch.overlap <= 0) break;
    pair.evaluate();
    pair.velocity.z += dt * pair.velocity.w * pair.sum.force.z;
    result.duration += dt;
    result.overlap = std::max(result.overlap, pair.touch.overlap);
    result.force = std::max(result.force, pair.row.force.w);
  } while (pair.row.force.w > 0);
  result.restitution = pair.velocity.z / speed;
  return result;
}

}  // namespace grit::test
