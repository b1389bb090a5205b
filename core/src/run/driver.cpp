#include "run/driver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "grit/error.hpp"
#include "run/conditions.hpp"
#include "run/number.hpp"
#include "run/stopwatch.hpp"

namespace grit {
namespace {

using Instant = std::chrono::steady_clock::time_point;

constexpr std::uint64_t contacts_counted_every = 100;

/// Says when something that happens again and again is due.
class Schedule {
 public:
  explicit Schedule(const Cadence& cadence) : cadence_(cadence) {}
  void restart(const Simulation& now) {
    first_time_ = now.time(), first_step_ = now.step(), first_left_ = now.share_left();
    count_ = 0, level_ = 0, began_ = true, due_ = false;
  }
  /// Decides about this step, and goes on to the next time. To be asked once a step, before forces, which may change
  /// the time step and let bodies leave: then it is due at the same steps, whoever else looks.
  void ask(const Simulation& now) {
    const bool by_time = due_by_time(now), by_mass = due_by_mass(now), by_displacement = due_by_displacement(now);
    due_ = by_time || by_mass || by_displacement || due_by_steps(now);
    if (by_time) ++count_;
    if (by_mass) count_ = static_cast<std::uint64_t>(shares(now)) + 1;  // one step may take several at once
    if (by_displacement) level_ += std::trunc(beyond(now)), began_ = false;
  }
  bool is_due() const { return due_; }
  bool never() const { return cadence_.never(); }

 private:
  // Counted, not summed up, so that the instants do not drift.
  bool due_by_time(const Simulation& now) const {
    return cadence_.every_time &&
           now.time() >= first_time_ + static_cast<double>(count_) * *cadence_.every_time - 0.5 * now.dt();
  }
  bool due_by_steps(const Simulation& now) const {
    return cadence_.every_steps > 0 &&
           (now.step() - first_step_) % static_cast<std::uint64_t>(cadence_.every_steps) == 0;
  }
  bool due_by_mass(const Simulation& now) const {
    return cadence_.every_left && shares(now) >= static_cast<double>(count_);
  }
  bool due_by_displacement(const Simulation& now) const {
    return cadence_.every_displacement && (began_ || std::abs(beyond(now)) >= 1);
  }

  /// Whole and part shares of the mass that have left since the stage began; a hair more, for rounding.
  double shares(const Simulation& now) const { return (now.share_left() - first_left_) / *cadence_.every_left + 1e-9; }
  /// Displacements since the last time, in its direction; a hair more, for rounding.
  double beyond(const Simulation& now) const {
    const auto& [wall, axis, value] = *cadence_.every_displacement;
    const auto found = std::ranges::find(now.walls(), wall, &WallView::name);
    const double gone = found->stage_position[axis[0] - 'x'] / value - level_;
    return gone + std::copysign(1e-9, gone);
  }

  Cadence cadence_;
  double first_time_ = 0, first_left_ = 0, level_ = 0;
  std::uint64_t first_step_ = 0, count_ = 0;
  bool began_ = true, due_ = false;
};

/// A probe of the description at work.
class Observer {
 public:
  Observer(const std::string& name, const ProbeDescription& description, const World& world)
      : name_(name), description_(&description), schedule_(description.cadence) {
    description.probe->prepare(world);
    for (const Channel& channel : description.probe->channels()) {
      std::size_t size = 1;
      for (const std::size_t n : channel.shape) size *= n;
      values_.emplace_back(size);
    }
  }
  ProbeGroup group() const { return {name_, description_->probe->channels()}; }
  bool watches(const std::string& stage) const {
    return description_->stages.empty() ||
           std::find(description_->stages.begin(), description_->stages.end(), stage) != description_->stages.end();
  }
  Schedule& schedule() { return schedule_; }
  void sample(std::size_t index, const World& world, Recorder& recorder) {
    if (last_step_ == world.step()) return;
    last_step_ = world.step();
    std::vector<std::span<double>> out(values_.begin(), values_.end());
    description_->probe->sample(world, out);
    const std::vector<std::span<const double>> in(values_.begin(), values_.end());
    recorder.sample(index, world, in);
  }
  bool in_frames() const { return description_->frames; }
  FieldGroup fields(const World& world) const { return {name_, description_->probe->fields(world)}; }

 private:
  std::string name_;
  const ProbeDescription* description_;
  Schedule schedule_;
  std::vector<std::vector<double>> values_;
  std::uint64_t last_step_ = ~0ull;
};

class Run {
 public:
  Run(const Scene& scene, Simulation& simulation, Recorder& recorder, const RunControl& control)
      : scene_(scene),
        simulation_(simulation),
        recorder_(recorder),
        control_(control),
        frames_(scene.description->output.frames) {
    phases_ = {{"probes", 0}, {"output", 0}};
  }

  RunSummary operator()() {
    RunSummary summary;
    for (const auto& [name, probe] : scene_.description->probes) observers_.emplace_back(name, probe, simulation_);
    std::vector<ProbeGroup> groups;
    for (const Observer& observer : observers_) groups.push_back(observer.group());
    recorder_.begin(simulation_, groups);
    summary.status = "done";
    try {
      simulation_.find_forces();
      for (std::size_t i = 0; i < scene_.stages.size() && !interrupted(); ++i) stage(i);
      if (interrupted()) summary.status = "interrupted";
    } catch (const NumericsError& error) {
      summary.status = "failed", summary.message = error.what();
    }
    observe(true);
    if (!frames_.never()) frame();
    fill(summary);
    recorder_.finish(simulation_, summary);
    return summary;
  }

 private:
  bool interrupted() const { return control_.interrupted != nullptr && control_.interrupted->load(); }

  void stage(std::size_t index) {
    const StagePlan& plan = scene_.stages[index];
    const StageDescription& stage = scene_.description->stages[index];
    simulation_.begin_stage(stage.name, *plan.start);
    start_ = {simulation_.time(), simulation_.step(), simulation_.share_left()};  // with what has come
    for (Observer& observer : observers_) observer.schedule().restart(simulation_);
    frames_.restart(simulation_);
    ramped_ = 0;
    wall_start_ = last_report_ = std::chrono::steady_clock::now();
    last_report_steps_ = simulation_.step();

    for (;;) {
      ramp(stage, plan);
      // Asked before forces, whose time step may be another: a stage ends the same, whoever looks.
      const bool may_end = may_be_met(stage.until, simulation_, start_);
      ask_who_looks();
      if (!may_end && !is_looked_at(stage)) {
        step_on();
        report(index, stage);
        continue;
      }
      step_forces();
      const bool met = may_end && is_met(stage.until, simulation_, start_);
      observe(met);
      if (met) break;
      if (interrupted()) return;  // here, where positions and forces are of one instant
      if (too_late(stage))
        throw NumericsError("stage \"" + stage.name + "\" did not end within its limit of " + number(stage.limit) +
                            " s; " + reached() + "; give it more time (/stages/" + std::to_string(index) +
                            "/limit) or a condition that it can reach");
      step_bodies();
      report(index, stage);
    }
    const std::string what = reached();
    recorder_.stage_ended(simulation_, what);
    if (stage.expect.void_ratio) {
      const double e = void_ratio(simulation_, simulation_.interior(simulation_.mean_diameter()));
      if (!(std::abs(e - *stage.expect.void_ratio) <= stage.expect.within))
        throw NumericsError("stage \"" + stage.name + "\" was to end at a void ratio of " +
                            number(*stage.expect.void_ratio) + " ± " + number(stage.expect.within) + " and reached " +
                            number(e) + "; wish for another one, or prepare the specimen otherwise");
    }
  }

  bool too_late(const StageDescription& stage) const { return simulation_.time() - start_.time > stage.limit; }
  bool is_time_to_count() const { return simulation_.step() % contacts_counted_every == 0; }
  void ask_who_looks() {
    frames_.ask(simulation_);
    for (Observer& observer : observers_) observer.schedule().ask(simulation_);
  }
  /// Whether somebody may ask for the forces of this instant.
  bool is_looked_at(const StageDescription& stage) {
    return interrupted() || too_late(stage) || is_time_to_count() || frames_.is_due() ||
           std::any_of(observers_.begin(), observers_.end(), [&](Observer& observer) {
             return observer.watches(simulation_.stage()) && observer.schedule().is_due();
           });
  }

  void step_on() {
    const Stopwatch watch(stepping_);
    simulation_.step_on();
  }
  void step_forces() {
    const Stopwatch watch(stepping_);
    simulation_.find_forces();
  }
  void step_bodies() {
    const Stopwatch watch(stepping_);
    simulation_.advance();
  }

  /// Applies the increments of the stage's ramps that are due; ramps follow one another.
  void ramp(const StageDescription& stage, const StagePlan& plan) {
    double since = simulation_.time() - start_.time;
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
    simulation_.change(*plan.ramp[due - 1]);
  }

  void observe(bool all) {
    sample(all);
    if (frames_.is_due()) frame();
  }

  void sample(bool all) {
    const Stopwatch watch(phases_[0].seconds);
    for (std::size_t i = 0; i < observers_.size(); ++i) {
      Observer& observer = observers_[i];
      if (!observer.watches(simulation_.stage())) continue;
      if (all || observer.schedule().is_due()) observer.sample(i, simulation_, recorder_);
    }
    if (is_time_to_count() && simulation_.positions().size() > 0)
      contact_sum_ +=
          2.0 * static_cast<double>(simulation_.pair_count()) / static_cast<double>(simulation_.positions().size()),
          ++contact_samples_;
  }

  void frame() {
    if (last_frame_ == simulation_.step()) return;
    last_frame_ = simulation_.step();
    const Stopwatch watch(phases_[1].seconds);
    std::vector<FieldGroup> fields;
    for (const Observer& observer : observers_)
      if (observer.in_frames() && observer.watches(simulation_.stage())) fields.push_back(observer.fields(simulation_));
    recorder_.frame(simulation_, fields);
  }

  void report(std::size_t index, const StageDescription& stage) {
    if (!control_.progress || simulation_.step() % 8 != 0) return;
    const double since = seconds_since(last_report_);
    if (since < control_.progress_every) return;
    Progress now;
    now.stage = stage.name, now.stage_number = index + 1, now.stages = scene_.stages.size();
    now.fraction = progress(stage.until, simulation_, start_);
    const double wall = seconds_since(wall_start_);
    if (now.fraction && *now.fraction > 1e-3) now.seconds_left = wall * (1 - *now.fraction) / *now.fraction;
    now.time = simulation_.time();
    now.particle_steps_per_second = static_cast<double>(simulation_.step() - last_report_steps_) *
                                    static_cast<double>(simulation_.positions().size()) / since;
    last_report_ = std::chrono::steady_clock::now(), last_report_steps_ = simulation_.step();
    control_.progress(now);
  }

  /// What the specimen is like, in words.
  std::string reached() const {
    const Unrest now = unrest(simulation_);
    std::string text = "unbalanced force " + number(now.unbalanced_force);
    const double e = void_ratio(simulation_, simulation_.interior(simulation_.mean_diameter()));
    const double overall = void_ratio(simulation_, simulation_.specimen());
    if (std::isfinite(e) && std::isfinite(overall))
      text = "void ratio " + number(e) + " (overall " + number(overall) + "), " + text;
    const auto comes_later = [](const auto& group) { return !group.second.stage.empty(); };
    if (std::ranges::any_of(scene_.description->bodies, comes_later))
      text = std::to_string(simulation_.positions().size()) + " bodies, " + text;
    return text + ", time " + number(simulation_.time() - start_.time) + " s";
  }

  void fill(RunSummary& summary) const {
    const std::size_t bodies = simulation_.positions().size();
    summary.stage = simulation_.stage();
    summary.time = simulation_.time(), summary.steps = simulation_.step();
    summary.time_step = simulation_.dt(), summary.critical_time_step = simulation_.clock().critical_time_step;
    summary.bodies = bodies;
    summary.contacts_per_body = contact_samples_ > 0 ? contact_sum_ / static_cast<double>(contact_samples_) : 0;
    summary.wall_seconds = stepping_;
    summary.particle_steps_per_second = stepping_ > 0 ? simulation_.body_steps() / stepping_ : 0;
    summary.rebuilds = simulation_.clock().rebuilds;
    summary.threads = simulation_.threads();
    summary.model = simulation_.model();
    summary.phases = simulation_.phases();
    summary.phases.insert(summary.phases.end(), phases_.begin(), phases_.end());
  }

  const Scene& scene_;
  Simulation& simulation_;
  Recorder& recorder_;
  const RunControl& control_;
  Schedule frames_;
  std::deque<Observer> observers_;
  StageStart start_;
  std::size_t ramped_ = 0;
  std::uint64_t last_frame_ = ~0ull, last_report_steps_ = 0, contact_samples_ = 0;
  Instant wall_start_, last_report_;
  double stepping_ = 0, contact_sum_ = 0;
  std::vector<PhaseTime> phases_;
};

}  // namespace

RunSummary run(const Scene& scene, Simulation& simulation, Recorder& recorder, const RunControl& control) {
  return Run(scene, simulation, recorder, control)();
}

}  // namespace grit
