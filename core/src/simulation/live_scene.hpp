// A scene while it runs: its description as it is now, and its components, which follow it.
#pragma once

#include <cstddef>
#include <optional>

#include "input/scene.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// Made before a run, and brought forward by it. Not copied: a simulation refers to it.
class LiveScene {
 public:
  /// Makes all components as the run begins, and sees that those of all stages can be made and do what the stages ask
  /// of them. Throws DescriptionError with every fault; PluginError for a plugin that cannot be had.
  explicit LiveScene(const Scene& scene);
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  const SceneDescription& now() const { return current_.now(); }
  const Components& components() const { return components_; }
  const LiveGeometries& geometries() const { return geometries_; }

  /// Begins the next stage. Throws PlacedError where a geometry cannot be prepared any more.
  void begin_stage();
  /// Brings the present stage's ramps to where so many of all their increments are done. False if nothing changed.
  bool advance_ramps(std::size_t increments);
  /// Changes parts from outside the stages' plans.
  void apply(const SettingsChange& change);
  /// Goes from the start to this stage, with so many increments done.
  void go_to(std::size_t stage, std::size_t increments);

 private:
  void follow();

  CurrentScene current_;
  LiveLaw law_;
  LiveEngines engines_;
  LiveGeometries geometries_;
  Components components_;
  const RampPlan* bound_ = nullptr;    // the ramp that goes on, once it has begun
  std::optional<NumberPlace> number_;  // that it sets in a live law or engine
};

}  // namespace grit
