// A description as it is at some point of its stages: one copy, brought forward in place.
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
  /// Which begins next; 0 before the first.
  std::size_t next_stage() const { return next_; }
  const StagePlan& plan(std::size_t stage) const { return (*stages_)[stage]; }

  /// Begins the next stage, from where the ramps of the one before end.
  void begin_stage();

  /// What a step of ramps did: a number was set, in a part that had to be replaced first or not.
  struct Step {
    const RampPlan* ramp = nullptr;  ///< null where nothing changed
    bool replaced = false;
    double value = 0;
  };
  /// Brings the ramps of the present stage to where so many of all their increments are done; never fewer than before.
  Step advance_ramps(std::size_t increments);
  std::size_t increments_done() const { return done_; }
  /// Changes parts from outside the stages' plans. They stay until a stage or a ramp changes them.
  void apply(const SettingsChange& change);

 private:
  /// Finds the number of a ramp among the present values.
  void bind(const RampPlan& ramp);
  /// Of the ramp that goes on.
  void set(const RampPlan& ramp, double value, Step& step);

  SceneDescription now_;
  const std::vector<StagePlan>* stages_;
  std::size_t next_ = 0, done_ = 0;
  std::size_t ramp_ = 0;               // the one that goes on
  std::optional<NumberPlace> number_;  // its number, once it has begun
};

/// Calls `look` with the description as stages begin and as their ramps begin and end, until it returns false. Returns
/// whether it never did. `look` gets the number of the stage that goes on; the first call is of the description before
/// any stage, and has none.
bool through_stages(const SceneDescription& described, const std::vector<StagePlan>& stages,
                    const std::function<bool(const SceneDescription& now, std::optional<std::size_t> stage)>& look);

}  // namespace grit
