// Speeds of the surfaces of walls, where bodies are near.
#pragma once

#include <cstddef>
#include <vector>

#include "bodies/restored.hpp"
#include "grit/archive.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Upper bounds of the speeds of walls' surfaces near bodies. A wall that spins moves faster further from its axis, so
/// the bounds use the distances of the axis from the bodies that the wall may reach before candidates at walls are
/// found again.
class WallSpeeds {
 public:
  /// After a change of walls or of their motions.
  void reset(std::size_t walls) { arms_.assign(walls, {}); }
  /// After a neighbour search, or one at walls only. `gone`: upper bound of the displacement of bodies since the
  /// former [m].
  void rebuild(const State& state, double gone, Ranks& ranks);
  /// Speed in any direction [m/s].
  double speed(const State& state, std::size_t wall, const WallMotion& motion, double gone, Ranks& ranks);
  /// Speed along the normal of the surface [m/s]: a flat wall may move in its own plane at any speed.
  double normal_speed(const State& state, std::size_t wall, const WallMotion& motion, double gone, Ranks& ranks);

  /// Throws Error unless restored speeds are of so many walls.
  void check_restored(std::size_t walls) const { expect_restored(arms_.size() == walls, "speeds are of other walls"); }
  void serialize(Archive& archive) { archive(arms_); }

 private:
  struct Arm {
    Vec3 axis = Vec3::Zero();  // direction for which it was found; zero: not found
    double length = 0;         // from the axis to the furthest place where one of these bodies was since the search [m]

    void serialize(Archive& archive) { archive(axis, length); }
  };
  double turning(const State& state, std::size_t wall, const Vec3& spin, double gone, Ranks& ranks);

  std::vector<Arm> arms_;  // by wall
};

/// The fastest approach of a wall's surface to a body that it may reach before candidates at walls are found again.
struct Approach {
  double speed = 0;  ///< m/s
  double rate = 0;   ///< largest of speed over the body's radius [1/s]
};
/// Measured as the change of overlaps in a step of `dt` [s], with bodies at rest and larger by their skins. A surface
/// that slides along itself, such as a drum that spins, does not approach; a groove that slides across does.
Approach approach(const State& state, std::size_t wall, const WallMotion& motion, double dt, Passes& passes);

}  // namespace grit
