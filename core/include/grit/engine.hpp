// Engines: components that act on bodies in every step, such as gravity, local damping or added forces.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "grit/archive.hpp"
#include "grit/parameters.hpp"
#include "grit/world.hpp"

namespace grit {

/// When an engine acts. Engines of one phase act in the order of their names.
enum class Phase {
  settings,  ///< before a stage: sets up the integration of the kernel
  forces,    ///< in each step, after the contacts: adds forces and moments to bodies
  removal,   ///< at each neighbour search: removes bodies
};

/// Motion as a rigid body, about an axis that is fixed in space.
struct RigidMotion {
  Vec3 velocity = Vec3::Zero();  ///< m/s
  Vec3 spin = Vec3::Zero();      ///< rad/s
  Vec3 about = Vec3::Zero();     ///< a point of the axis of rotation [m]

  /// The velocity of the point `place`.
  Vec3 at(const Vec3& place) const { return velocity + spin.cross(place - about); }
  bool operator==(const RigidMotion&) const = default;
};

/// Settings of the kernel's integration, of all bodies or of a group; engines of phase `settings` write them.
struct MotionSettings {
  Vec3 gravity = Vec3::Zero();  ///< m/s²
  /// Density scaling: bodies of a smaller radius [m] have the mass and the moments of inertia of one of this radius,
  /// but their own weight.
  double scaled_radius = 0;
  double local_damping = 0;                ///< λ in F (1 − λ sgn(F v)), 0 … 1
  std::array<bool, 3> held_translation{};  ///< axes along which velocities stay constant
  std::array<bool, 3> held_rotation{};     ///< axes about which spins stay constant
  std::optional<RigidMotion> prescribed;   ///< bodies move so, whatever the forces on them are
  std::optional<int> flat;  ///< planar motion: axis (0, 1, 2) without translation; rotation is about it only

  bool holds() const {
    const auto any = [](const std::array<bool, 3>& axes) { return axes[0] || axes[1] || axes[2]; };
    return prescribed || any(held_translation) || any(held_rotation);
  }
  /// 1 along axes whose velocity engines keep or prescribe, 0 along others.
  Vec3 constrained_translation() const { return prescribed ? Vec3(Vec3::Ones()) : ones(held_translation); }
  /// The same about axes of rotation.
  Vec3 constrained_rotation() const { return prescribed ? Vec3(Vec3::Ones()) : ones(held_rotation); }
  /// 1 along axes along which forces accelerate bodies, 0 along others.
  Vec3 free_translation() const {
    Vec3 free = Vec3::Ones() - constrained_translation();
    if (flat) free[*flat] = 0;
    return free;
  }
  /// The same about axes of rotation.
  Vec3 free_rotation() const {
    const Vec3 free = Vec3::Ones() - constrained_rotation();
    return flat ? Vec3(free.cwiseProduct(Vec3::Unit(*flat))) : free;
  }
  /// The radius of a body over that which determines its mass [m]; for clumps, those of the enclosing sphere.
  double unscaled_ratio(double radius) const { return radius < scaled_radius ? radius / scaled_radius : 1; }
  /// Mass without density scaling over mass.
  double unscaled_share(double radius) const {
    const double ratio = unscaled_ratio(radius);
    return ratio * ratio * ratio;
  }
  /// Acceleration of the same body by gravity [m/s²].
  Vec3 gravity_on(double radius) const { return unscaled_share(radius) * gravity; }
  bool operator==(const MotionSettings&) const = default;

 private:
  static Vec3 ones(const std::array<bool, 3>& axes) { return Vec3(axes[0], axes[1], axes[2]); }
};

/// Upper bounds over all bodies of what an engine adds to their equations of motion.
struct EngineRates {
  double stiffness = 0;  ///< derivative of the force with position, over mass [1/s²]
  double damping = 0;    ///< derivative of the force with velocity, over mass [1/s]
};

/// Base class of plugins of kind "engine".
class Engine {
 public:
  virtual ~Engine() = default;
  /// Declares the parameters, and does nothing else. It is called when a description is read, and again between two
  /// steps on an engine in use: when a stage changes the engine, when a ramp of one of its numbers begins, and by
  /// Simulation::set(). The values are then set where the members are. The increments of a ramp, and a number that
  /// set() sets again, are set there without a call. So members must stay where they are, and what follows from them is
  /// computed when it is needed.
  virtual void declare(Parameters& parameters) = 0;
  virtual Phase phase() const = 0;
  /// State that the kernel must keep for this engine.
  virtual StateRequest needs() const { return {}; }
  /// Called in phase `settings`; for each group of bodies if engines act on some groups only.
  virtual void settings(MotionSettings&) const {}
  /// Called in phase `forces`. Adds to the force [N] and moment [N m] of each body; one row per body, by index. What it
  /// adds to bodies of groups on which it does not act is discarded. The result must not depend on the order in which
  /// bodies are stored.
  virtual void forces(const World&, std::span<Row> /*force*/, std::span<Row> /*moment*/) const {}
  /// Called in phase `removal` for each sphere and clump at a position [m]: whether it leaves the simulation.
  virtual bool removes(const World&, const Vec3& /*centre*/) const { return false; }
  /// Called in phase `forces` when the time step is set, at neighbour searches and after changes, with a world of the
  /// bodies on which the engine acts. The time step is stable with these rates.
  virtual EngineRates rates(const World&) const { return {}; }
  /// Passes each member that the engine keeps between steps to the archive, once. A resumed run is then identical to an
  /// uninterrupted one.
  virtual void serialize(Archive&) {}
};

}  // namespace grit
