// Engines act in a step, in a fixed order of phases.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "grit/memory.hpp"
#include "grit/parameters.hpp"
#include "grit/world.hpp"

namespace grit {

/// Where in a step an engine acts. Within a phase, in the order of their names.
enum class Phase {
  settings,  ///< before a stage: what the kernel's own passes shall do
  forces,    ///< after the contacts: adds to forces and moments of bodies
};

/// What the kernel's own integration does; engines of phase `settings` write it.
struct MotionSettings {
  Vec3 gravity = Vec3::Zero();    ///< m/s²
  double local_damping = 0;       ///< λ in F (1 − λ sgn(F v))
  bool hold_rotation = false;     ///< spins stay as they are
  bool hold_translation = false;  ///< velocities stay as they are
  std::optional<int> flat;        ///< axis along which nothing moves, and about which alone bodies turn
};

class Engine {
 public:
  virtual ~Engine() = default;
  virtual void declare(Parameters& parameters) = 0;
  virtual Phase phase() const = 0;
  virtual StateRequest needs() const { return {}; }
  virtual void settings(MotionSettings&) const {}
  /// Adds to force and moment of each body (rows by index). Must give the same sums in whatever order bodies are
  /// stored.
  virtual void forces(const World&, std::span<Row> /*force*/, std::span<Row> /*moment*/) const {}
  /// Names what it keeps from one step for the next, each once, so that a run that goes on from a checkpoint is the
  /// same as one that was never stopped.
  virtual void remember(Memory&) {}
};

}  // namespace grit
