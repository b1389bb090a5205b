// Walls and their motions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grit/parameters.hpp"
#include "grit/vec.hpp"
#include "plugins/component.hpp"

namespace grit {

struct ServoDescription {
  std::string axis = "z";
  std::optional<double> pressure{};  ///< Pa, compression positive
  std::optional<double> force{};     ///< N, of the wall on the bodies, along the axis
  double max_velocity = 0;           ///< m/s
  double gain = 1;                   ///< fraction of the force error corrected per step if contacts are elastic
  std::string area = "geometry";
  void declare(Parameters& p);
};
struct FollowDescription {
  std::string wall, axes = "z";
  void declare(Parameters& p);
};
struct FreeDescription {
  std::string axes = "z";
  double mass = 0;
  Vec3 load = Vec3::Zero();
  void declare(Parameters& p);
};
/// Rotation under the moment of bodies, about an axis through the reference point of the wall.
struct FreeRotationDescription {
  Vec3 axis = Vec3::Zero();  ///< of any length above 0
  double inertia = 0;        ///< kg m²
  double moment = 0;         ///< external, N m
  void declare(Parameters& p);
};
/// Added to velocity and spin. The displacement after t is amplitude × (sin(2π f t + φ) − sin(φ)) along each axis, the
/// rotation the same with angle.
struct OscillationDescription {
  Vec3 amplitude = Vec3::Zero(), angle = Vec3::Zero();              ///< of displacement [m], of rotation vector [rad]
  double frequency = 0;                                             ///< Hz
  double phase = 0;                                                 ///< rad
  Vec3 amplitude_phase = Vec3::Zero(), angle_phase = Vec3::Zero();  ///< added to phase, by axis [rad]
  Vec3 phases_of_displacement() const { return amplitude_phase.array() + phase; }
  Vec3 phases_of_rotation() const { return angle_phase.array() + phase; }
  void declare(Parameters& p);
};
/// Along each axis a wall is fixed, has a velocity or oscillates, follows another wall, is servo-controlled, or is
/// free.
struct MotionDescription {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  /// Of the surface relative to the wall, in the axes of the wall [m/s, rad/s]; bodies feel the part along the surface.
  Vec3 surface_velocity = Vec3::Zero(), surface_spin = Vec3::Zero();
  std::optional<Vec3> about{};
  double ramp_time = 0;
  std::optional<OscillationDescription> oscillation{};
  std::optional<ServoDescription> servo{};
  std::optional<FollowDescription> follow{};
  std::optional<FreeDescription> free{};
  std::optional<FreeRotationDescription> free_rotation{};
  bool surface_moves() const { return !surface_velocity.isZero(0.0) || !surface_spin.isZero(0.0); }
  void declare(Parameters& p);
};
struct WallDescription {
  Component<Geometry> geometry;
  std::string material;
  std::vector<std::string> groups;  ///< of bodies on which it acts; empty: all
  MotionDescription motion;
  explicit WallDescription(const Registry& registry);
  void declare(Parameters& p);
};

}  // namespace grit
