// A scene during a run: its present description, and the components that follow it.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "input/scene.hpp"
#include "simulation/checked_number.hpp"
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
  /// Sets a value independently of the stages, as a stage's change would. A number that was set before is set in place,
  /// without reading anything, unless other parts have to change with it. `take` applies the present values. Returns
  /// whether it was set in place. Throws DescriptionError, also for a value without effect from now on; nothing has
  /// changed then.
  bool set(
      const std::string& pointer, const Description& value, const std::function<void()>& take = [] {});
  /// Adds, replaces or removes (null) an engine of the program; `take` applies it. Throws Error for the name of an
  /// engine of the description; nothing has changed then.
  void set_engine(const std::string& name, std::shared_ptr<Engine> engine, const std::function<void()>& take);
  /// Sets a number in place without checks, as set() did in the run that was saved.
  void restore(const std::string& pointer, double value);
  /// Advances from the start to this stage, with `increments` done.
  void go_to(std::size_t stage, std::size_t increments);

 private:
  /// A number as described and, of an engine or a law, in the live instance.
  struct Number {
    CheckedNumber described;
    std::optional<CheckedNumber> live;
  };
  void follow();
  void refuse_idle(const std::string& pointer, const SettingsChange& change) const;
  /// Whether a body of this material is made in a later stage.
  bool appears_later(const std::string& material) const;
  bool set_in_place(const std::string& pointer, double value);
  /// Binds a number, once while parts stay where they are; null if it cannot be set in place.
  const Number* bind(const std::string& pointer);
  std::optional<Number> found(const NumberPointer& place);

  CurrentScene current_;
  LiveLaw law_;
  LiveEngines engines_;
  LiveGeometries geometries_;
  Components components_;
  const RampPlan* bound_ = nullptr;    // the active ramp, after it has begun
  std::optional<NumberPlace> number_;  // set by the ramp in a live law or engine
  std::set<std::string> known_;        // pointers that set() has set
  std::map<std::string, std::optional<Number>> numbers_;
};

}  // namespace grit
