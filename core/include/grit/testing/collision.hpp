// Head-on collisions of two spheres, or of a sphere and a plane, by leap-frog integration.
#pragma once

#include <algorithm>
#include <limits>

#include "grit/testing/pairs.hpp"

namespace grit::test {

/// Results of a collision of two spheres.
struct Collision {
  double restitution;     ///< speed after over speed before
  double duration;        ///< s
  double overlap, force;  ///< maxima [m], [N]
};

/// Two spheres at rest and in motion with the given relative speed [m/s]; positions and velocities of a and b are
/// ignored.
inline Collision collide(const ContactLaw& law, const Ball& a, const Ball& b, double speed, double dt) {
  Pairs pairs(law, dt);
  Ball still = a, coming = b;
  still.position = Vec3::Zero(), coming.position = {0, 0, a.radius + b.radius};
  coming.velocity = {0, 0, -speed};
  pairs.add(still), pairs.add(coming), pairs.pair(0, 1);
  Collision result{0, 0, 0, 0};
  // The spheres just touch at the start; the first step ends with an overlap.
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

/// The same with a wall of the material of this index.
inline Collision collide_with_wall(const ContactLaw& law, Ball ball, double speed, double dt,
                                   std::uint32_t material = 0) {
  ball.position = {0, 0, ball.radius}, ball.velocity = {0, 0, -speed};
  WallPair pair(law, ball, dt);
  pair.contact.material = material;
  Collision result{0, 0, 0, 0};
  do {
    pair.position.z += dt * pair.velocity.z;
    pair.contact.overlap = ball.radius - pair.position.z;
    if (pair.contact.overlap <= 0) break;
    pair.evaluate();
    pair.velocity.z += dt * pair.velocity.w * pair.sum.force.z;
    result.duration += dt;
    result.overlap = std::max(result.overlap, pair.contact.overlap);
    result.force = std::max(result.force, pair.row.force.w);
  } while (pair.row.force.w > 0);
  result.restitution = pair.velocity.z / speed;
  return result;
}

}  // namespace grit::test
