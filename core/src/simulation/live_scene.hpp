// A scene during a run: its present description, and the components that follow it.
#pragma once

#include <cstddef>
#include <optional>

#include "input/scene.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// Made before a run and advanced by it. Not copied: a simulation refers to it.
class LiveScene {
 public:
  /// Makes all components at the start of the run, and checks that those of all stages can be made and are compatible
  /// with the stages. Throws DescriptionError with every fault; PluginError for a plugin that is not available.
  explicit LiveScene(const Scene& scene);
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  const SceneDescription& now() const { return current_.now(); }
  const Components& components() const { return components_; }
  const LiveGeometries& geometries() const { return geometries_; }

  /// Begins the next stage. Throws PlacedError if a geometry cannot be prepared.
  void begin_stage();
  /// Advances the ramps of the present stage until `increments` of all their increments are done. False if nothing
  /// changed.
  bool advance_ramps(std::size_t increments);
  /// Changes parts independently of the stages.
  void apply(const SettingsChange& change);
  /// Advances from the start to this stage, with `increments` done.
  void go_to(std::size_t stage, std::size_t increments);

 private:
  void follow();

  CurrentScene current_;
  LiveLaw law_;
  LiveEngines engines_;
  LiveGeometries geometries_;
  Components components_;
  const RampPlan* bound_ = nullptr;    // the active ramp, after it has begun
  std::optional<NumberPlace> number_;  // set by the ramp in a live law or engine
};

}  // namespace grit
