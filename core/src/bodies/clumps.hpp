// Rigid clumps: several spheres that move as one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grit/archive.hpp"
#include "grit/body_kind.hpp"
#include "grit/vec.hpp"
#include "grit/world.hpp"

namespace grit {

/// Centre, orientation, velocity and momentum are the state of the clump; those of its spheres follow from them.
struct Clump {
  std::uint32_t id = 0;
  std::uint32_t first = 0, last = 0;  ///< into Clumps::spheres
  Vec3 centre = Vec3::Zero();         ///< of mass [m]
  Vec3 velocity = Vec3::Zero();       ///< m/s, half a step before the centre
  Vec3 momentum = Vec3::Zero();       ///< angular [kg m²/s], half a step before the orientation
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Mat3 axes = Mat3::Identity();   ///< the same as a matrix
  Vec3 spin = Vec3::Zero();       ///< rad/s, mean of the last step
  Vec3 half_turn = Vec3::Zero();  ///< rotation of the last step: axis times the tangent of half the angle
  double chord_rate = 0;          ///< 2 / (time step · (1 + half_turn²)) [1/s]
  Vec3 inertia = Vec3::Ones();    ///< principal [kg m²]
  double inverse_mass = 1;        ///< 1/kg
  double radius = 0;              ///< of the enclosing sphere [m]
  double furthest = 0;            ///< largest distance of a sphere's surface from the centre [m]
  double volume = 0;              ///< m³

  Vec3 spin_of(const Vec3& of_momentum) const { return axes * (axes.transpose() * of_momentum).cwiseQuotient(inertia); }
  void serialize(Archive& archive) {
    archive(id, first, last, centre, velocity, momentum, orientation, axes, spin, half_turn, chord_rate, inertia,
            inverse_mass, radius, furthest, volume);
  }
};

/// Relation of a body to its clump.
struct ClumpSphere {
  std::uint32_t clump = no_clump;
  /// Shift by periods relative to its clump: few, as a clump has at most 64 spheres, each narrower than half a period.
  std::array<std::int8_t, 3> periods{};
  Vec3 place = Vec3::Zero();  ///< position along the clump's axes from its centre [m]
  void serialize(Archive& archive) { archive(clump, periods, place); }
};

struct Clumps {
  std::vector<Clump> clump;
  std::vector<std::uint32_t> spheres;   ///< bodies of all clumps by index, one clump after the other
  std::vector<ClumpSphere> of_body;     ///< by index; empty without clumps
  std::vector<double> volume_fraction;  ///< by index; empty without clumps

  void serialize(Archive& archive) { archive(clump, spheres, of_body, volume_fraction); }
  bool none() const { return clump.empty(); }
  std::uint32_t clump_of(std::size_t body) const { return of_body.empty() ? no_clump : of_body[body].clump; }
};

}  // namespace grit
