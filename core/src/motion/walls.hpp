// Motion of walls.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contact/demand.hpp"
#include "contact/wall_contacts.hpp"
#include "description/components.hpp"
#include "description/description.hpp"
#include "grit/archive.hpp"
#include "grit/geometry.hpp"
#include "grit/world.hpp"

namespace grit {

/// A wall as in the description.
struct WallSetup {
  std::string name;
  std::shared_ptr<const Geometry> geometry;
  MotionDescription motion;
};
/// The walls of a description, in the order of their names.
std::vector<WallSetup> wall_setups(const SceneDescription& scene, const Components& components);
/// Throws grit::Error, naming the wall, for an oscillation that steps of dt [s] cannot follow.
void check_oscillations(const SceneDescription& scene, double dt);

/// State of a wall. pose.about is its reference point in the description; pose.shift is the displacement of that point.
struct WallState {
  Pose pose;
  Vec3 stage_start = Vec3::Zero();                                    ///< pose.shift at the start of the stage [m]
  double stage_time = 0;                                              ///< since the start of the stage [s]
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();                  ///< in the step that drive() started [m/s, rad/s]
  Vec3 surface_velocity = Vec3::Zero(), surface_spin = Vec3::Zero();  ///< of the surface relative to the wall, likewise
  Vec3 force = Vec3::Zero();                                          ///< by the bodies on the wall [N]
  Vec3 moment = Vec3::Zero();                                         ///< the same about the reference point [N m]
  Vec3 surface_force = Vec3::Zero(), surface_moment = Vec3::Zero();   ///< the parts that do work on a moving surface
  double stiffness = 0;                                               ///< sum of normal stiffnesses of contacts [N/m]
  double spring = 0, dashpot = 0;                  ///< sums in the stiffest directions of contacts [N/m, N s/m]
  double turning_spring = 0, turning_dashpot = 0;  ///< the same for free rotation [N m/rad, N m s/rad]
  double habit = 0;                                ///< of a servo: its velocity, averaged over recent steps [m/s]
  double swing_time = 0;                           ///< since the start of the oscillation [s]
  double swing_lead = 0;                           ///< phase advance by changes of frequency [periods]
  double swing_frequency = 0;                      ///< of the present oscillation [Hz]; 0: none
  Vec3 swing_phases = Vec3::Zero(), swing_angle_phases = Vec3::Zero();  ///< of displacement and rotation, by axis [rad]
  std::uint32_t contacts = 0;
  std::uint32_t near = 0;  ///< bodies that may come into contact before the next search
};
template <>
inline constexpr bool plain_numbers<WallState> = true;

/// Rigid motion of a wall: velocity of its reference point [m/s], and spin [rad/s].
struct WallMotion {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
};

/// The pose after a motion of `dt` [s].
Pose moved(Pose pose, const WallMotion& motion, double dt);

/// Owns the moving walls. A step is: clear_forces(), add() for all contacts, drive(dt), move(dt). Velocities are those
/// at the middle of the step, as for bodies. The velocity of an oscillation is the mean over the step, so that its
/// displacement is exactly sinusoidal at every step. Used by one thread.
class Walls {
 public:
  /// Begins a stage: walls get their new geometries and motions and keep poses and velocities by name; new walls start
  /// at their position in the description. Throws grit::Error, naming the wall, for motions that are not possible: two
  /// on one axis, two rotations, a wall that does not exist or follows itself, a servo for pressure on a wall without
  /// area or along its face, no mass. An oscillation continues from the previous stage unless it is new or its phase
  /// has changed.
  void apply(const SceneDescription& scene, const Components& components) { apply(wall_setups(scene, components)); }
  void apply(std::vector<WallSetup> setups);
  /// The same within a stage, e.g. for one increment of a ramp: time and start of the stage stay, and an oscillation
  /// continues at its present phase. Throws as apply() does.
  void change(const SceneDescription& scene, const Components& components) { change(wall_setups(scene, components)); }
  void change(std::vector<WallSetup> setups);

  /// Puts a wall where it was, with its motion in the last step.
  void put(std::size_t wall, const Pose& pose, const WallMotion& motion);
  /// Removes the walls of these names, before the next apply().
  void drop(const std::vector<std::string>& names);

  std::size_t size() const { return states_.size(); }
  const std::string& name(std::size_t wall) const { return setups_[wall].name; }
  const Geometry& geometry(std::size_t wall) const { return *setups_[wall].geometry; }
  const Pose& pose(std::size_t wall) const { return states_[wall].pose; }
  /// Present position of the reference point [m].
  Vec3 reference(std::size_t wall) const { return states_[wall].pose.about + states_[wall].pose.shift; }
  /// Motion in the last step.
  WallMotion motion(std::size_t wall) const { return {states_[wall].velocity, states_[wall].spin}; }
  /// The fastest motion foreseen in the description: at the end of its ramp, at the middle of an oscillation, of a
  /// servo before its first contact. A free wall keeps its motion.
  WallMotion expected_motion(std::size_t wall) const;
  /// Whether the surface moves, or moved in the last step, relative to the wall.
  bool surface_moves(std::size_t wall) const;
  /// Velocity of the wall at `point` [m/s].
  Vec3 point_velocity(std::size_t wall, const Vec3& point) const;

  void clear_forces();
  /// Adds the load of bodies on a wall; moments about reference().
  void add(std::size_t wall, const WallLoad& load);
  /// Whether a servo's pressure refers to the specimen's cross-section; then set_specimen() must be called.
  bool presses_on_specimen() const;
  bool any_servo() const;
  /// Sets the present lengths of the specimen [m].
  void set_specimen(const Vec3& lengths) { specimen_ = lengths; }
  /// Estimated normal force of the bodies, at their present positions, on a wall [N] after this displacement [m] and at
  /// this velocity [m/s].
  using Ahead = std::function<double(std::size_t wall, const Pose& there, const Vec3& velocity, double way)>;
  /// Throws PlacedError, naming the wall, for an oscillation that steps of dt [s] cannot follow.
  void check_oscillations(double dt) const;
  /// Sets the velocities of the next step of dt [s] from the forces, leaders before walls that follow them. With
  /// `ahead`, servos slow down before contacts that would exceed the target force within a step.
  void drive(double dt, const Ahead& ahead = nullptr);
  /// Demands of the present contacts on free walls, bodies held: the largest k/m and c/m, of a wall that also rotates
  /// freely plus those of its rotation. Added to the demands on bodies, walls held, this bounds those on all together:
  /// the largest eigenvalue of a positive semidefinite matrix is at most the sum of those of its two diagonal blocks.
  Demand demand() const;
  /// Moves and rotates the walls by one step of dt [s].
  void move(double dt);

  /// Message for each servo whose wall has contacts and misses its target by more than a twentieth at its maximum
  /// velocity; empty if there is none. Uses the present forces and the velocities of the last step.
  std::string fallen_behind() const;

  /// The walls as probes see them. Entries of `views` are reused.
  void view(std::vector<WallView>& views) const;

  const std::vector<WallState>& states() const { return states_; }
  /// Restores into the same walls; throws grit::Error if the number of walls differs.
  void serialize(Archive& archive);

 private:
  using Axes = std::array<bool, 3>;
  /// A checked motion with the data that it depends on.
  struct Drive {
    int servo_axis = -1;
    Axes follow{}, free{};
    std::size_t leader = 0;
    Vec3 free_axis = Vec3::Zero();  // unit; zero: no free rotation
  };
  /// Area on which the pressure on a wall acts [m²].
  double area(std::size_t wall) const;
  static Drive drive_of(const std::vector<WallSetup>& setups, const WallSetup& setup);
  static std::vector<std::size_t> leaders_first(const std::vector<WallSetup>& setups, const std::vector<Drive>& drives);

  std::vector<WallSetup> setups_;
  std::vector<WallState> states_;
  std::vector<Drive> drives_;
  std::vector<std::size_t> order_;
  Vec3 specimen_ = Vec3::Zero();
};

}  // namespace grit
