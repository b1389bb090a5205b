// Runs the stages of a scene: ramps, conditions, probes, frames, checkpoints.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grit/checkpoint.hpp"
#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "run/conditions.hpp"
#include "run/observer.hpp"
#include "run/recorder.hpp"
#include "run/schedule.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

class StageRunner {
 public:
  /// `live` is the scene at its beginning, and the kernel was made of it.
  StageRunner(const Scene& scene, LiveScene& live, Kernel& kernel, Recorder& recorder);

  /// Prepares the probes. Throws PlacedError for all that they refuse.
  void prepare();
  /// Finds the first forces, begins the first stage, then the recording; after prepare().
  void start();
  /// Instead of both: continues from a checkpoint. Throws Error if it is of another scene.
  void resume(const Checkpoint& checkpoint);
  /// Restores the kernel alone, also from the state of a complete run.
  void restore_kernel(const Checkpoint& checkpoint);

  enum class Event { stepped, stage_ended, stopped };
  /// One step of the present stage, or its end and the start of the next. If `stop`, stops instead, where positions and
  /// forces are of one instant. Throws NumericsError if a guard trips, the stage takes longer than its limit, or misses
  /// what it expects.
  Event next(bool stop);
  /// Finds the forces of the present instant. Which step ends the stage or is sampled does not depend on it.
  void show_instant();

  /// Whether an exception ended a step, or the start of a stage, midway: next() cannot be called again.
  bool is_midway() const { return midway_; }
  bool done() const { return stage_ == scene_.stages.size(); }
  /// Index of the present stage, and how many have begun.
  std::size_t stage() const { return stage_; }
  std::size_t stages_begun() const { return stages_begun_; }
  const StageDescription& description() const { return scene_.description->stages[stage_]; }
  /// Calls an observer at the given cadence, or at the end of each stage where it is none. Not part of checkpoints:
  /// after resume() the cadence counts from there.
  void call(const Cadence& cadence, std::function<void(const World&)> observer);
  /// Sets a value of the description from now on. Throws DescriptionError.
  void set(const std::string& pointer, const Description& value);
  /// Adds, replaces or removes an engine of the program, as LiveScene::set_engine().
  void set_engine(const std::string& name, std::shared_ptr<Engine> engine);
  /// Fraction of the present stage that is done, where its end can be foreseen.
  std::optional<double> progress() const;

  /// Has the recorder keep what was recorded, and returns the present state. Between two steps.
  StateToSave to_save();
  /// Samples and frame of the last instant, and the summary.
  void finish(RunSummary& summary);
  /// All figures of the summary but status and message.
  void fill(RunSummary& summary) const;
  /// The probes, in the order of the recorder; after prepare().
  std::vector<ProbeGroup> probes() const;
  double output_seconds() const { return phases_[1].seconds; }

 private:
  void restore_kernel(Archive& archive);
  /// A value that was set from outside, and where in the stages.
  struct Set {
    std::size_t stage, increments;
    std::string pointer, value;
    bool in_place;
    void serialize(Archive& archive) { archive(stage, increments, pointer, value, in_place); }
  };
  struct Callback {
    Schedule schedule;
    std::function<void(const World&)> call;
  };
  /// What has been done at the present instant, which is done once.
  struct Instant {
    bool is_decided = false;  // ramps are set, and schedules know whether they are due
    bool may_end = false;     // the stage
    bool has_forces = false;
  };
  void begin_recording();
  /// `start`: on the run's clock [s].
  void begin_stage(double start);
  /// Where the present stage ends on the run's clock [s]: as planned if time ends it, otherwise now.
  double stage_end(const StageDescription& stage) const;
  void enter_stage();
  void end_stage(const StageDescription& stage);
  void ramp();
  void decide();
  void find_forces();
  /// One step of the kernel, by `work`.
  template <class Work>
  void step(Work work);
  /// Keeps a value that was set, and drops the one that it replaces.
  void note(Set set);
  void serialize(Archive& archive);
  void refuse_without_a_step(const StageDescription& stage) const;
  /// If time cannot reach the end of the present stage.
  void refuse_without_an_end() const;
  [[noreturn]] void fail_late(const StageDescription& stage) const;
  std::string advice_when_late(const StageDescription& stage) const;
  bool too_late(const StageDescription& stage) const { return world_.time() - start_.time > stage.limit; }
  bool counts_contacts() const;
  void ask_schedules();
  bool forces_are_needed(const StageDescription& stage) const;
  void observe(bool all);
  void sample(bool all);
  void frame();
  /// Notes a probe that leaves out fields.
  void note_fields(Observer& observer);
  /// State of the specimen in words.
  std::string reached() const;

  const Scene& scene_;
  LiveScene& live_;
  Kernel& kernel_;
  const World& world_;
  Recorder& recorder_;
  Schedule frames_;
  std::deque<Observer> observers_;
  std::vector<Callback> callbacks_;
  std::vector<Observer*> watching_;  // those that sample in the present stage
  std::size_t stage_ = 0, stages_begun_ = 0;
  Instant instant_;
  bool midway_ = false;  // between two instants
  StageStart start_;
  std::size_t increments_ = 0;  // of the stage's ramps, done
  std::vector<Set> sets_;
  std::uint64_t last_frame_ = ~0ull, contact_samples_ = 0;
  double stepping_ = 0, contact_sum_ = 0;  // s; sum of contacts per body
  std::vector<PhaseTime> phases_;
  std::map<std::string, std::string> left_out_;  // of frames, by probe: why
};

}  // namespace grit
