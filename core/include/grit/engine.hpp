// Engines: components that act on bodies in every step, such as gravity, local damping or added forces.
#pragma once

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
};

/// Settings of the kernel's integration; engines of phase `settings` write them.
struct MotionSettings {
  Vec3 gravity = Vec3::Zero();    ///< m/s²
  double local_damping = 0;       ///< λ in F (1 − λ sgn(F v)), 0 … 1
  bool hold_rotation = false;     ///< spins stay constant
  bool hold_translation = false;  ///< velocities stay constant
  std::optional<int> flat;        ///< planar motion: axis (0, 1, 2) without translation; rotation is about it only
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
  /// Called in phase `settings`.
  virtual void settings(MotionSettings&) const {}
  /// Called in phase `forces`. Adds to the force [N] and moment [N m] of each body; one row per body, by index. The
  /// result must not depend on the order in which bodies are stored.
  virtual void forces(const World&, std::span<Row> /*force*/, std::span<Row> /*moment*/) const {}
  /// Called in phase `forces` when the time step is set, at neighbour searches and after changes. The time step is
  /// stable with these rates.
  virtual EngineRates rates(const World&) const { return {}; }
  /// Passes each member that the engine keeps between steps to the archive, once. A resumed run is then identical to an
  /// uninterrupted one.
  virtual void serialize(Archive&) {}
};

}  // namespace grit
