#include "run/driver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "format/number.hpp"
#include "grit/error.hpp"
#include "kernel/stopwatch.hpp"
#include "run/conditions.hpp"
#include "run/observer.hpp"
#include "run/schedule.hpp"
#include "scene/placed_error.hpp"

namespace grit {
namespace {

using Instant = std::chrono::steady_clock::time_point;

constexpr std::uint64_t contacts_counted_every = 100;
// However short the time between checkpoints, they shall not take more than this share of it.
constexpr double most_for_checkpoints = 0.01;

class Run {
 public:
  Run(const Scene& scene, Kernel& kernel, Recorder& recorder, const RunControl& control)
      : scene_(scene),
        kernel_(kernel),
        recorder_(recorder),
        control_(control),
        frames_(scene.description->output.frames) {
    phases_ = {{"probes", 0}, {"output", 0}};
  }

  RunSummary operator()() try {
    RunSummary summary;
    for (const auto& [name, probe] : scene_.description->probes) observers_.emplace_back(name, probe, world_);
    std::vector<ProbeGroup> groups;
    for (const Observer& observer : observers_) groups.push_back(observer.group());
    const bool resumes = control_.resume != nullptr;
    if (resumes) restore(*control_.resume);
    recorder_.begin(world_, groups);
    summary.status = "done";
    saved_ = std::chrono::steady_clock::now();
    try {
      if (!resumes) {
        kernel_.find_forces();
        begin_stage();
      }
      while (go_through_stage())
        if (++stage_ == scene_.stages.size()) break;
        else begin_stage();
      if (stage_ < scene_.stages.size()) summary.status = "interrupted";
    } catch (const NumericsError& error) {
      summary.status = "failed", summary.message = error.what();
    } catch (const PlacedError& error) {
      summary.status = "failed", summary.message = error.what();
      fill(summary);
      recorder_.finish(world_, summary);
      throw;
    }
    observe(true);
    if (!frames_.never()) frame();
    fill(summary);
    recorder_.finish(world_, summary);
    return summary;
  } catch (PlacedError& error) {
    error.begun(stages_begun_);
    throw;
  }

 private:
  bool interrupted() const { return control_.interrupted != nullptr && control_.interrupted->load(); }

  const StagePlan& plan() const { return scene_.stages[stage_]; }

  void begin_stage() {
    stages_begun_ = stage_ + 1;
    kernel_.begin_stage(scene_.description->stages[stage_].name, *plan().start);
    start_ = {world_.time(), world_.step(), kernel_.state().discharged_fraction()};  // with what has come
    for (Observer& observer : observers_) observer.schedule().restart(kernel_);
    frames_.restart(kernel_);
    ramped_ = 0;
  }

  /// Returns false if it was interrupted.
  bool go_through_stage() {
    const StageDescription& stage = scene_.description->stages[stage_];
    watching_.clear();
    for (Observer& observer : observers_)
      if (observer.watches(stage.name)) watching_.push_back(&observer);
    wall_start_ = last_report_ = std::chrono::steady_clock::now();
    last_report_steps_ = world_.step();
    begun_at_ = control_.progress ? progress(stage.until, kernel_, start_).value_or(0) : 0;

    for (;;) {
      // Asked once a step: what is saved is where the run stops.
      const bool stops = interrupted();
      if (stops || checkpoint_is_due()) save();
      ramp(stage);
      // Asked before forces, whose time step may be another: a stage ends the same, whoever looks.
      const bool may_end = may_be_met(stage.until, kernel_, start_);
      ask_who_looks();
      if (!may_end && !stops && !is_looked_at(stage)) {
        step_on();
        report(stage);
        continue;
      }
      step_forces();
      const bool met = may_end && is_met(stage.until, kernel_, start_);
      observe(met);
      if (met) {
        refuse_without_a_step(stage);
        break;
      }
      if (stops) return false;  // here, where positions and forces are of one instant
      if (too_late(stage))
        throw NumericsError("stage \"" + stage.name + "\" did not end within its limit of " + number(stage.limit) +
                            " s: " + still_wanting(stage.until, kernel_, start_) + " (" + reached() +
                            "); give it more time (/stages/" + std::to_string(stage_) +
                            "/limit) or a condition that it can reach");
      step_bodies();
      report(stage);
    }
    const std::string by = ended_by(stage.until, kernel_, start_), behind = kernel_.state().walls.fallen_behind();
    kernel_.end_stage();
    recorder_.stage_ended(world_,
                          (by.empty() ? "" : "by " + by + ", ") + reached() + (behind.empty() ? "" : "; " + behind));
    if (stage.expect.void_ratio) {
      const double e = void_ratio(world_, world_.interior(world_.mean_diameter()));
      if (!(std::abs(e - *stage.expect.void_ratio) <= stage.expect.within))
        throw NumericsError("stage \"" + stage.name + "\" was to end at a void ratio of " +
                            number(*stage.expect.void_ratio) + " ± " + number(stage.expect.within) + " and reached " +
                            number(e) + "; wish for another one, or prepare the specimen otherwise");
    }
    return true;
  }

  // Between two steps, and by the wall clock alone: nothing that is simulated depends on when.
  bool checkpoint_is_due() const {
    if (!(control_.checkpoint_every > 0)) return false;
    const double since = seconds_since(saved_);
    return since >= control_.checkpoint_every && most_for_checkpoints * since >= saving_;
  }

  void save() {
    const Instant began = std::chrono::steady_clock::now();
    {
      const Stopwatch watch(phases_[1].seconds);
      recorder_.flush();
      Memory memory;
      memory(stage_, ramped_);
      kernel_.save(memory);
      remember(memory);
      recorder_.checkpoint({world_.stage(), world_.time(), world_.step(), memory.bytes()});
    }
    saved_ = std::chrono::steady_clock::now(), saving_ = seconds_since(began);
  }

  void restore(const Checkpoint& checkpoint) {
    Memory memory(checkpoint.memory);
    memory(stage_, ramped_);
    stages_begun_ = stage_ + 1;
    if (stage_ >= scene_.stages.size() || ramped_ > plan().ramp.size())
      throw Error("a checkpoint in stage " + std::to_string(stage_ + 1) + ", but the description has " +
                  std::to_string(scene_.stages.size()) + "; continue with the description that wrote it");
    kernel_.restore(ramped_ > 0 ? *plan().ramp[ramped_ - 1] : *plan().start, memory);
    remember(memory);
    if (!memory.at_end()) throw Error("a checkpoint has more in it than the run remembers");
  }

  void remember(Memory& memory) {
    memory(start_.time, start_.step, start_.share_left, frames_, last_frame_, contact_samples_, contact_sum_);
    memory(stepping_);
    for (PhaseTime& phase : phases_) memory(phase.seconds);
    for (Observer& observer : observers_) observer.remember(memory);
    recorder_.remember(memory);
  }

  void refuse_without_a_step(const StageDescription& stage) const {
    if (world_.step() > start_.step) return;
    if (const auto lasts = time_without_a_step(stage.until, kernel_))
      throw NumericsError("stage \"" + stage.name + "\" lasts " + number(*lasts) +
                          " s, less than half of the time step of " + number(world_.dt()) +
                          " s, so that it would take no step; give it more time (/stages/" + std::to_string(stage_) +
                          "/until) or a shorter step (/time_step)");
  }
  bool too_late(const StageDescription& stage) const { return world_.time() - start_.time > stage.limit; }
  bool is_time_to_count() const { return world_.step() % contacts_counted_every == 0; }
  void ask_who_looks() {
    frames_.ask(kernel_);
    for (Observer* observer : watching_) observer->schedule().ask(kernel_);
  }
  /// Whether somebody may ask for the forces of this instant.
  bool is_looked_at(const StageDescription& stage) {
    return too_late(stage) || is_time_to_count() || frames_.is_due() ||
           std::ranges::any_of(watching_, [](Observer* observer) { return observer->schedule().is_due(); });
  }

  void step_on() {
    const Stopwatch watch(stepping_);
    kernel_.step_on();
  }
  void step_forces() {
    const Stopwatch watch(stepping_);
    kernel_.find_forces();
  }
  void step_bodies() {
    const Stopwatch watch(stepping_);
    kernel_.advance();
  }

  /// Applies the increments of the stage's ramps that are due; ramps follow one another.
  void ramp(const StageDescription& stage) {
    double since = world_.time() - start_.time;
    std::size_t due = 0;
    for (const RampDescription& one : stage.ramps) {
      const auto increments = static_cast<double>(one.increments);
      const double done = std::floor(std::clamp(since / one.duration, 0.0, 1.0) * increments + 1e-9);
      due += static_cast<std::size_t>(done);
      if (done < increments) break;
      since -= one.duration;
    }
    if (due == ramped_) return;
    ramped_ = due;
    kernel_.change(*plan().ramp[due - 1]);
  }

  void observe(bool all) {
    sample(all);
    if (frames_.is_due()) frame();
  }

  void sample(bool all) {
    const Stopwatch watch(phases_[0].seconds);
    for (std::size_t i = 0; i < observers_.size(); ++i) {
      Observer& observer = observers_[i];
      if (!observer.watches(world_.stage())) continue;
      if (all || observer.schedule().is_due()) observer.sample(i, world_, recorder_);
    }
    if (is_time_to_count() && world_.positions().size() > 0)
      contact_sum_ += 2.0 * static_cast<double>(kernel_.state().pairs.touching_count()) /
                      static_cast<double>(world_.positions().size()),
          ++contact_samples_;
  }

  void frame() {
    if (last_frame_ == world_.step()) return;
    last_frame_ = world_.step();
    const Stopwatch watch(phases_[1].seconds);
    std::vector<FieldGroup> fields;
    for (const Observer& observer : observers_)
      if (observer.in_frames() && observer.watches(world_.stage())) fields.push_back(observer.fields(world_));
    recorder_.frame(world_, fields);
  }

  void report(const StageDescription& stage) {
    if (!control_.progress || world_.step() % 8 != 0) return;
    const double since = seconds_since(last_report_);
    if (since < control_.progress_every) return;
    Progress now;
    now.stage = stage.name, now.stage_number = stage_ + 1, now.stages = scene_.stages.size();
    now.fraction = progress(stage.until, kernel_, start_);
    const double wall = seconds_since(wall_start_);
    if (const double gone = now.fraction.value_or(0) - begun_at_; gone > 1e-3)
      now.seconds_left = wall * (1 - *now.fraction) / gone;
    now.time = world_.time();
    now.particle_steps_per_second = static_cast<double>(world_.step() - last_report_steps_) *
                                    static_cast<double>(world_.positions().size()) / since;
    last_report_ = std::chrono::steady_clock::now(), last_report_steps_ = world_.step();
    control_.progress(now);
  }

  /// What the specimen is like, in words.
  std::string reached() const {
    const Unrest now = unrest(world_);
    std::string text = "unbalanced force " + number(now.unbalanced_force);
    const double e = void_ratio(world_, world_.interior(world_.mean_diameter()));
    const double overall = void_ratio(world_, world_.specimen());
    if (std::isfinite(e) && std::isfinite(overall))
      text = "void ratio " + number(e) + " (overall " + number(overall) + "), " + text;
    const auto comes_later = [](const auto& group) { return !group.second.stage.empty(); };
    if (std::ranges::any_of(scene_.description->bodies, comes_later))
      text = std::to_string(world_.positions().size()) + " bodies, " + text;
    if (kernel_.state().discharged_fraction() > 0)
      text += ", " + number(100 * kernel_.state().discharged_fraction()) + " % of the mass has left";
    return text + ", time " + number(world_.time() - start_.time) + " s";
  }

  void fill(RunSummary& summary) const {
    const std::size_t bodies = world_.positions().size();
    summary.stage = world_.stage();
    summary.time = world_.time(), summary.steps = world_.step();
    summary.time_step = world_.dt(), summary.critical_time_step = kernel_.critical_time_step();
    summary.bodies = bodies;
    summary.contacts_per_body = contact_samples_ > 0 ? contact_sum_ / static_cast<double>(contact_samples_) : 0;
    summary.wall_seconds = stepping_;
    summary.particle_steps_per_second = stepping_ > 0 ? kernel_.body_steps() / stepping_ : 0;
    summary.rebuilds = kernel_.state().lists.rebuilds();
    summary.threads = kernel_.threads();
    summary.model = kernel_.model();
    summary.phases = kernel_.phases();
    summary.phases.insert(summary.phases.end(), phases_.begin(), phases_.end());
    for (const Observer& observer : observers_) summary.probes.push_back(observer.cost());
  }

  const Scene& scene_;
  Kernel& kernel_;
  const World& world_ = kernel_.world();
  Recorder& recorder_;
  const RunControl& control_;
  Schedule frames_;
  std::deque<Observer> observers_;
  std::vector<Observer*> watching_;  // those that look at the stage that runs
  std::size_t stage_ = 0;            // the one that runs
  std::size_t stages_begun_ = 0;
  StageStart start_;
  std::size_t ramped_ = 0;
  std::uint64_t last_frame_ = ~0ull, last_report_steps_ = 0, contact_samples_ = 0;
  Instant wall_start_, last_report_, saved_;
  double saving_ = 0;    // s, the last checkpoint
  double begun_at_ = 0;  // share of the stage that was done when wall_start_ was
  double stepping_ = 0, contact_sum_ = 0;
  std::vector<PhaseTime> phases_;
};

}  // namespace

RunSummary run(const Scene& scene, Kernel& kernel, Recorder& recorder, const RunControl& control) {
  return Run(scene, kernel, recorder, control)();
}

}  // namespace grit
