// What moves the walls.
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
#include "grit/geometry.hpp"
#include "grit/memory.hpp"
#include "grit/world.hpp"

namespace grit {

/// A wall as the description has it.
struct WallSetup {
  std::string name;
  std::shared_ptr<const Geometry> geometry;
  MotionDescription motion;
};
/// The walls of a scene, in the order of their names.
std::vector<WallSetup> wall_setups(const SceneDescription& scene, const Components& components);
/// Throws grit::Error, naming the wall, for an oscillation that steps of dt [s] cannot follow.
void check_oscillations(const SceneDescription& scene, double dt);

/// All that a wall remembers. pose.about is its reference point, where the description puts it;
/// pose.shift is how far that point has moved.
struct WallState {
  Pose pose;
  Vec3 stage_start = Vec3::Zero();                    ///< pose.shift when the stage began [m]
  double stage_time = 0;                              ///< since the stage began [s]
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  ///< of the step that drive() began [m/s, rad/s]
  Vec3 force = Vec3::Zero();                          ///< that the bodies exert on the wall [N]
  Vec3 moment = Vec3::Zero();                         ///< the same about the reference point [N m]
  double stiffness = 0;                               ///< sum over the touches, normal [N/m]
  double spring = 0, dashpot = 0;                     ///< the same in their stiffest directions [N/m, N s/m]
  double habit = 0;                                   ///< of a servo: its velocity, averaged over recent steps [m/s]
  double swing_time = 0;                              ///< since the oscillation began [s]
  double swing_lead = 0;                              ///< periods by which changes of frequency have set it ahead
  double swing_frequency = 0, swing_phase = 0;        ///< of the oscillation that goes on [Hz, rad]; 0 Hz: none
  std::uint32_t touches = 0;
  std::uint32_t near = 0;  ///< bodies that may come to touch it before the next search
};
template <>
inline constexpr bool plain_numbers<WallState> = true;

/// Owns the walls while they move. A step is: clear_forces(), touch and add() for all bodies, drive(dt), move(dt).
/// Velocities are those of the middle of the step, as the bodies' are; that of an oscillation is the mean over the
/// step, so that its path is that of the sine at every step. Used by one thread.
class Walls {
 public:
  /// Begins a stage: walls get their new geometries and motions, and keep their poses and velocities by name; new walls
  /// stand where the description puts them. Throws grit::Error, naming the wall, for motions that cannot be: two on one
  /// axis, a wall that is unknown or follows itself, a servo on a pressure without an area or along the wall's face, no
  /// mass. An oscillation goes on from the stage before, unless it was not there or has another phase.
  void apply(const SceneDescription& scene, const Components& components) { apply(wall_setups(scene, components)); }
  void apply(std::vector<WallSetup> setups);
  /// The same within a stage, e.g. for one increment of a ramp: the stage's time and start stay, and an oscillation
  /// goes on from where it is. Throws as apply() does.
  void change(const SceneDescription& scene, const Components& components) { change(wall_setups(scene, components)); }
  void change(std::vector<WallSetup> setups);

  std::size_t size() const { return states_.size(); }
  const std::string& name(std::size_t wall) const { return setups_[wall].name; }
  const Geometry& geometry(std::size_t wall) const { return *setups_[wall].geometry; }
  const Pose& pose(std::size_t wall) const { return states_[wall].pose; }
  /// Where the reference point is now [m].
  Vec3 reference(std::size_t wall) const { return states_[wall].pose.about + states_[wall].pose.shift; }
  /// Velocity of the point of the wall that is now at `point` [m/s].
  Vec3 point_velocity(std::size_t wall, const Vec3& point) const;

  void clear_forces();
  /// Adds what bodies do to a wall, moments about reference().
  void add(std::size_t wall, const WallLoad& load);
  /// Whether some servo presses on the specimen's cross-section. Then set_specimen() must keep up.
  bool presses_on_specimen() const;
  bool any_servo() const;
  /// Lengths of the specimen as it is now [m].
  void set_specimen(const Vec3& lengths) { specimen_ = lengths; }
  /// What bodies, as they are now, would press on a wall with [N], were it there after a step of this way [m] and moved
  /// at this velocity [m/s].
  using Ahead = std::function<double(std::size_t wall, const Pose& there, const Vec3& velocity, double way)>;
  /// Throws PlacedError, naming the wall, for an oscillation that steps of dt [s] cannot follow.
  void check_oscillations(double dt) const;
  /// Sets the velocities of the coming step of dt [s] from the forces, leaders before those that follow them. With
  /// `ahead` servos brake before what they would press too hard at once.
  void drive(double dt, const Ahead& ahead = nullptr);
  /// What springs and dashpots that now touch free walls ask of them, bodies held: the largest of k/m and c/m. Added to
  /// what they ask of the bodies, walls held, it bounds what they ask of all together: of a matrix without negative
  /// eigenvalues the largest is at most the sum of those of two blocks on its diagonal.
  Demand demand() const;
  /// Moves and turns the walls by one step of dt [s].
  void move(double dt);

  /// Words for each servo whose wall touches something and is off what it keeps by more than a twentieth, though it
  /// moves as fast as it may; empty without such. Of the forces of now, and the velocities of the step before.
  std::string fallen_behind() const;

  /// What probes see. Entries of `views` are reused.
  void view(std::vector<WallView>& views) const;

  const std::vector<WallState>& states() const { return states_; }
  /// Restored into the same walls; throws grit::Error if their number is not that of the walls.
  void remember(Memory& memory);

 private:
  using Axes = std::array<bool, 3>;
  /// A motion, checked, and what it takes from elsewhere.
  struct Drive {
    int servo_axis = -1;
    Axes follow{}, free{};
    std::size_t leader = 0;
  };
  /// What the pressure on a wall acts on [m²].
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
