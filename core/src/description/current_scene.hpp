// The description at some instant of its stages: one copy, advanced in place.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "description/stage_plan.hpp"
#include "plugins/parameter_values.hpp"

namespace grit {

class CurrentScene {
 public:
  /// As described, before any stage. The plans must outlive it.
  CurrentScene(const SceneDescription& described, const std::vector<StagePlan>& stages)
      : now_(described), stages_(&stages) {}
  CurrentScene(const CurrentScene&) = delete;
  CurrentScene& operator=(const CurrentScene&) = delete;

  const SceneDescription& now() const { return now_; }
  std::size_t stages() const { return stages_->size(); }
  /// Index of the stage that begins next; 0 before the first.
  std::size_t next_stage() const { return next_; }
  const StagePlan& plan(std::size_t stage) const { return (*stages_)[stage]; }

  /// Begins the next stage, with the ramps of the stage before completed.
  void begin_stage();

  /// Result of an advance of ramps: a number was set; the part that contains it may have been replaced first.
  struct Step {
    const RampPlan* ramp = nullptr;  ///< null if nothing changed
    bool replaced = false;
    double value = 0;
  };
  /// Advances the ramps of the present stage until `increments` of all their increments are done; never back.
  Step advance_ramps(std::size_t increments);
  std::size_t increments_done() const { return done_; }
  /// Declares the part that a number belongs to; `law` reads parameters of materials. False if there is no such part.
  bool declare(const NumberPointer& number, ContactLaw* law, Parameters& parameters);
  /// Changes parts independently of the stages. The changes persist until a stage or a ramp overwrites them.
  void apply(const SettingsChange& change);

 private:
  /// Finds the number of a ramp among the present values.
  void bind(const RampPlan& ramp);
  /// Sets the number of the active ramp.
  void set(const RampPlan& ramp, double value, Step& step);

  SceneDescription now_;
  const std::vector<StagePlan>* stages_;
  std::size_t next_ = 0, done_ = 0;
  std::size_t ramp_ = 0;               // the active one
  std::optional<NumberPlace> number_;  // its number, after it has begun
};

/// Calls `visit` with the description at the start of each stage and at the start and end of each ramp, until it
/// returns false. Returns whether it never did. `visit` gets the index of the present stage; the first call gets the
/// description before any stage, without an index.
bool through_stages(const SceneDescription& described, const std::vector<StagePlan>& stages,
                    const std::function<bool(const SceneDescription& now, std::optional<std::size_t> stage)>& visit);

}  // namespace grit
