#include "simulation/stage_runner.hpp"

#include <algorithm>
#include <cmath>

#include "description/placed_error.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"
#include "run/falling.hpp"
#include "run/unclosed_balance.hpp"
#include "simulation/expected_stages.hpp"
#include "storage/parsed_json.hpp"
#include "threads/stopwatch.hpp"

namespace grit {
namespace {

constexpr std::uint64_t contacts_counted_every = 100;  // steps

[[noreturn]] void refuse_texts() {
  throw Error("the saved state is damaged or was altered: a text is not JSON; use another checkpoint, or start again");
}

double interior_void_ratio(const World& world) { return void_ratio(world, world.interior(world.mean_diameter())); }

}  // namespace

StageRunner::StageRunner(const Scene& scene, LiveScene& live, Kernel& kernel, Recorder& recorder)
    : scene_(scene),
      live_(live),
      kernel_(kernel),
      world_(kernel.world()),
      recorder_(recorder),
      frames_(scene.description->output.frames),
      phases_{{"probes", 0}, {"output", 0}} {}

void StageRunner::prepare() {
  std::vector<PlacedError::Fault> faults;
  for (const auto& [name, probe] : scene_.description->probes) {
    try {
      Observer& observer = observers_.emplace_back(name, probe, live_.components().probes.at(name), world_);
      if (probe.frames && !scene_.description->output.frames.never()) observer.check_fields(world_);
    } catch (const PlacedError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw PlacedError(std::move(faults));
}

void StageRunner::start() {
  {
    const Stopwatch watch(stepping_);
    kernel_.find_forces();
  }
  check_ends(scene_, world_.dt());
  begin_stage(world_.time());
  begin_recording();
}

std::vector<ProbeGroup> StageRunner::probes() const {
  std::vector<ProbeGroup> groups;
  for (const Observer& observer : observers_) groups.push_back(observer.group());
  return groups;
}

void StageRunner::begin_recording() {
  kernel_.complete_world();  // the first rank alone records
  const auto alone = kernel_.alone();
  recorder_.begin(world_, probes());
}

void StageRunner::resume(const Checkpoint& checkpoint) try {
  Archive archive(checkpoint.state);
  restore_kernel(archive);
  serialize(archive);
  // The first rank alone records, and its records are the last in it.
  if (kernel_.is_first_rank() && !archive.at_end())
    throw Error("a checkpoint holds more than this simulation restores");
  begin_recording();
  if (!done()) enter_stage();
} catch (const Description::exception&) {
  refuse_texts();
}

void StageRunner::restore_kernel(const Checkpoint& checkpoint) try {
  Archive archive(checkpoint.state);
  restore_kernel(archive);
} catch (const Description::exception&) {
  refuse_texts();
}

void StageRunner::restore_kernel(Archive& archive) {
  archive.part("stages", 1);
  archive(stage_, increments_, sets_);
  const std::size_t stage = std::min(stage_, scene_.stages.size() - 1);  // the last one if all are complete
  stages_begun_ = stage + 1;
  if (stage_ > scene_.stages.size() || increments_ > scene_.stages[stage].increments())
    throw Error("a checkpoint in stage " + std::to_string(stage_ + 1) + ", but the description has " +
                std::to_string(scene_.stages.size()) + "; continue with the description that wrote it");
  for (const Set& set : sets_) {
    if (set.stage > stage || set.increments > scene_.stages[set.stage].increments())
      throw Error("a checkpoint with a value that was set in stage " + std::to_string(set.stage + 1) +
                  ", which it has not reached; it is damaged or was altered");
    live_.go_to(set.stage, set.increments);
    const Description value = parsed_json(set.value);
    if (value.is_discarded()) refuse_texts();
    if (set.in_place) live_.restore(set.pointer, value.get<double>());
    else live_.set(set.pointer, value);
  }
  live_.go_to(stage, increments_);
  kernel_.restore(live_.now(), live_.components(), archive);
}

void StageRunner::begin_stage(double start) {
  stages_begun_ = stage_ + 1;
  live_.begin_stage();
  kernel_.begin_stage(description().name, live_.now(), live_.components());
  start_ = {start, world_.step(), kernel_.state().discharged_fraction()};  // with bodies that have appeared
  for (Observer& observer : observers_) observer.schedule().restart(kernel_);
  for (Callback& one : callbacks_) one.schedule.restart(kernel_);
  frames_.restart(kernel_);
  increments_ = 0;
  instant_ = {};
  enter_stage();
}

void StageRunner::enter_stage() {
  watching_.clear();
  for (Observer& observer : observers_)
    if (observer.watches(description().name)) watching_.push_back(&observer);
}

template <class Work>
void StageRunner::step(Work work) try {
  const Stopwatch watch(stepping_);
  midway_ = true;
  work();
  midway_ = false;
} catch (const NumericsError& error) {
  midway_ = error.guard() != Guard::critical_step;  // the time step is checked before anything moves
  throw;
}

StageRunner::Event StageRunner::next(bool stop) {
  const StageDescription& stage = description();
  decide();
  if (!instant_.may_end && !stop && !instant_.has_forces && !forces_are_needed(stage)) {
    step([this] { kernel_.step_on(); });
    instant_ = {};
    return Event::stepped;
  }
  // Before forces are found: a checkpoint that is saved now gives the same bits.
  if (instant_.may_end || frames_.is_due()) recorder_.expect_room();
  find_forces();
  const bool met = instant_.may_end && is_met(stage.until, kernel_, start_);
  observe(met);
  if (met) {
    end_stage(stage);
    return Event::stage_ended;
  }
  if (stop) return Event::stopped;
  if (too_late(stage)) fail_late(stage);
  step([this] { kernel_.advance(); });
  instant_ = {};
  return Event::stepped;
}

void StageRunner::show_instant() {
  if (!done()) decide();
  find_forces();
}

void StageRunner::decide() {
  if (instant_.is_decided) return;
  instant_.is_decided = true;
  if (world_.step() == start_.step + 1) refuse_without_an_end();  // now that the stage has its own time step
  ramp();
  // Before forces, which may change the time step: a stage ends at the same step, whoever samples.
  instant_.may_end = may_be_met(description().until, kernel_, start_);
  ask_schedules();
}

void StageRunner::find_forces() {
  if (instant_.has_forces) return;
  step([this] { kernel_.find_forces(); });
  instant_.has_forces = true;
}

void StageRunner::end_stage(const StageDescription& stage) {
  refuse_without_a_step(stage);
  const std::string by = ended_by(stage.until, kernel_, start_), behind = kernel_.fallen_behind();
  kernel_.end_stage();
  const std::string what = (by.empty() ? "" : "by " + by + ", ") + reached() + (behind.empty() ? "" : "; " + behind) +
                           in_flight(stage.until, world_);
  kernel_.complete_world();
  {
    const auto alone = kernel_.alone();
    recorder_.stage_ended(world_, what);
  }
  if (stage.expect.void_ratio) {
    const double e = interior_void_ratio(world_);
    if (!(std::abs(e - *stage.expect.void_ratio) <= stage.expect.within))
      throw NumericsError("stage \"" + stage.name + "\" was to end at a void ratio of " +
                          number(*stage.expect.void_ratio) + " ± " + number(stage.expect.within) + " and reached " +
                          number(e) + "; wish for another one, or prepare the specimen otherwise");
  }
  const double end = stage_end(stage);
  midway_ = true;
  ++stage_;
  if (!done()) begin_stage(end);
  midway_ = false;
}

double StageRunner::stage_end(const StageDescription& stage) const {
  // A stage has whole steps. Its difference from the planned end must not add up over stages.
  const auto lasts = duration(stage.until);
  const double planned = start_.time + lasts.value_or(0),
               step = std::max(world_.dt(), kernel_.state().time.previous_dt);
  return lasts && std::abs(world_.time() - planned) <= step ? planned : world_.time();
}

void StageRunner::ramp() {
  double since = world_.time() - start_.time;
  std::size_t due = 0;
  for (const RampPlan& one : scene_.stages[stage_].ramps) {
    const auto increments = static_cast<double>(one.increments);
    const double past = std::floor(std::clamp(since / one.duration, 0.0, 1.0) * increments + 1e-9);
    due += static_cast<std::size_t>(past);
    if (past < increments) break;
    since -= one.duration;
  }
  if (due == increments_) return;
  increments_ = due;
  if (live_.advance_ramps(due)) kernel_.change(live_.now(), live_.components());
}

void StageRunner::call(const Cadence& cadence, std::function<void(const World&)> observer) {
  callbacks_.push_back({Schedule(cadence), std::move(observer)});
  callbacks_.back().schedule.restart(kernel_);
  if (instant_.is_decided) callbacks_.back().schedule.ask(kernel_);
}

void StageRunner::set(const std::string& pointer, const Description& value) {
  const bool in_place = live_.set(pointer, value, [this] { kernel_.change(live_.now(), live_.components()); });
  instant_.has_forces = false;
  note({stage_, increments_, pointer, value.dump(), in_place});
}

void StageRunner::set_engine(const std::string& name, std::shared_ptr<Engine> engine) {
  live_.set_engine(name, std::move(engine), [this] { kernel_.change(live_.now(), live_.components()); });
  instant_.has_forces = false;
}

void StageRunner::note(Set set) {
  // Numbers that are set where they are do not depend on each other. Other values may depend on all before them.
  for (std::size_t i = sets_.size(); set.in_place && i > 0 && sets_[i - 1].in_place; --i)
    if (sets_[i - 1].pointer == set.pointer) {
      sets_.erase(sets_.begin() + static_cast<std::ptrdiff_t>(i - 1));
      break;
    }
  sets_.push_back(std::move(set));
}

std::optional<double> StageRunner::progress() const { return grit::progress(description().until, kernel_, start_); }

StateToSave StageRunner::to_save() {
  recorder_.flush();
  return {world_.stage(), world_.time(), world_.step(), [this](Archive& archive) {
            const Stopwatch watch(phases_[1].seconds);
            archive.part("stages", 1);
            archive(stage_, increments_, sets_);
            kernel_.save(archive);
            serialize(archive);
          }};
}

void StageRunner::serialize(Archive& archive) {
  archive.part("probes", 1);
  archive(instant_.is_decided, instant_.may_end);
  archive(start_.time, start_.step, start_.discharged_fraction, frames_, last_frame_, contact_samples_, contact_sum_,
          stepping_, left_out_);
  for (PhaseTime& phase : phases_) archive(phase.seconds);
  for (Observer& observer : observers_) observer.serialize(archive);
  archive.part("results", 1);
  recorder_.serialize(archive);
}

void StageRunner::refuse_without_a_step(const StageDescription& stage) const {
  if (world_.step() > start_.step) return;
  if (const auto lasts = duration(stage.until); lasts && *lasts <= 0.5 * world_.dt())
    throw NumericsError("stage \"" + stage.name + "\" lasts " + number(*lasts) +
                        " s, less than half of the time step of " + number(world_.dt()) +
                        " s, so that it would take no step; give it more time (/stages/" + std::to_string(stage_) +
                        "/until) or a shorter step (/time_step)");
}

void StageRunner::refuse_without_an_end() const {
  const StageDescription& stage = description();
  const double least = duration_until(stage.until, live_.now(), world_.dt()).least;
  check_end(stage.name, stage_, start_.time + least, world_.dt());
}

void StageRunner::fail_late(const StageDescription& stage) const {
  throw NumericsError("stage \"" + stage.name + "\" did not end within its limit of " + number(stage.limit) + " s: " +
                      still_wanting(stage.until, kernel_, start_) + " (" + reached() + "); " + advice_when_late(stage));
}

std::string StageRunner::advice_when_late(const StageDescription& stage) const {
  if (waits_for_contacts(stage.until)) {
    const Falling falling = falling_grains(world_);
    if (2 * falling.grains > falling.all)
      return std::to_string(falling.grains) + " of " + std::to_string(falling.all) +
             " bodies have no contact and fall, at up to " + number(falling.speed) +
             " m/s: is there a floor below them, and does gravity point towards it?";
    if (falling.all > 0 && !std::isfinite(support(world_).unbalance))
      return "without gravity or another force (/engines) bodies do not come to rest on each other";
  }
  if (const auto blocked = kernel_.blocked_streams(); !blocked.empty()) return blocked.front();
  return "give it more time (/stages/" + std::to_string(stage_) + "/limit) or a condition that it can reach";
}

bool StageRunner::counts_contacts() const { return world_.step() % contacts_counted_every == 0; }

void StageRunner::ask_schedules() {
  frames_.ask(kernel_);
  for (Callback& one : callbacks_) one.schedule.ask(kernel_);
  for (Observer* observer : watching_) observer->schedule().ask(kernel_);
}

bool StageRunner::forces_are_needed(const StageDescription& stage) const {
  return too_late(stage) || counts_contacts() || frames_.is_due() ||
         std::ranges::any_of(callbacks_, [](const Callback& one) { return one.schedule.is_due(); }) ||
         std::ranges::any_of(watching_, [](Observer* observer) { return observer->schedule().is_due(); });
}

void StageRunner::observe(bool all) {
  sample(all);
  if (frames_.is_due()) frame();
  for (Callback& one : callbacks_)
    if (one.schedule.take() || (all && one.schedule.never())) one.call(world_);
}

void StageRunner::sample(bool all) {
  const Stopwatch watch(phases_[0].seconds);
  for (std::size_t i = 0; i < observers_.size(); ++i) {
    Observer& observer = observers_[i];
    if (!observer.watches(world_.stage())) continue;
    if (all || observer.schedule().is_due()) observer.sample(i, world_, recorder_);
  }
  if (counts_contacts() && kernel_.bodies() > 0)
    contact_sum_ += 2.0 * static_cast<double>(kernel_.contact_count()) / static_cast<double>(kernel_.bodies()),
        ++contact_samples_;
}

void StageRunner::frame() {
  if (last_frame_ == world_.step()) return;
  last_frame_ = world_.step();
  const Stopwatch watch(phases_[1].seconds);
  std::vector<FieldGroup> fields;
  for (Observer& observer : observers_)
    if (observer.in_frames() && observer.watches(world_.stage())) {
      note_fields(observer);
      fields.push_back(observer.fields(world_));
    }
  kernel_.complete_world(), kernel_.collect_contacts();
  const auto alone = kernel_.alone();
  recorder_.frame(world_, fields);
}

void StageRunner::note_fields(Observer& observer) {
  try {
    observer.check_fields(world_);
  } catch (const PlacedError& error) {
    left_out_.try_emplace(observer.name(), "probe \"" + observer.name() + "\": averages are left out of frames from " +
                                               number(world_.time()) + " s on: " + error.what());
  }
}

std::string StageRunner::reached() const {
  std::string text = "unbalanced force " + number(equilibrium(world_).unbalanced_force);
  const double e = interior_void_ratio(world_), overall = void_ratio(world_, world_.specimen());
  if (e < most_void_ratio && overall < most_void_ratio)
    text = "void ratio " + number(e) + " (overall " + number(overall) + "), " + text;
  const auto appears_later = [](const auto& group) {
    return !group.second.stage.empty() || std::holds_alternative<StreamSource>(group.second.source.value());
  };
  if (std::ranges::any_of(scene_.description->bodies, appears_later))
    text = std::to_string(kernel_.bodies()) + " bodies, " + text;
  if (const double fraction = kernel_.state().discharged_fraction(); fraction > 0)
    text += ", " + number(100 * fraction) + " % of the mass discharged";
  if (const std::string waiting = kernel_.waiting_bodies(); !waiting.empty()) text += ", " + waiting;
  // A stage that begins at the planned end of another one may end before it.
  return text + ", time " + number(std::max(0.0, world_.time() - start_.time)) + " s";
}

void StageRunner::finish(RunSummary& summary) {
  sample(true);
  if (!scene_.description->output.frames.never()) frame();
  kernel_.collect_sharing();
  fill(summary);
  if (summary.status == "done") {
    summary.warnings = kernel_.blocked_streams();
    for (const auto& [probe, why] : left_out_) summary.warnings.push_back(why);
    if (kernel_.keeps_energy_balance())
      if (const std::string fault = unclosed_balance(world_.energies(), live_.now().contacts.type()); !fault.empty())
        summary.warnings.push_back(fault);
  }
  kernel_.complete_world();
  const auto alone = kernel_.alone();
  recorder_.finish(world_, summary);
}

void StageRunner::fill(RunSummary& summary) const {
  summary.stage = world_.stage();
  summary.time = world_.time(), summary.steps = world_.step();
  summary.time_step = world_.dt(), summary.critical_time_step = kernel_.critical_time_step();
  summary.bodies = kernel_.bodies();
  summary.contacts_per_body = contact_samples_ > 0 ? contact_sum_ / static_cast<double>(contact_samples_) : 0;
  summary.wall_seconds = stepping_;
  summary.particle_steps_per_second = stepping_ > 0 ? kernel_.body_steps() / stepping_ : 0;
  summary.rebuilds = kernel_.state().lists.rebuilds();
  summary.threads = kernel_.threads(), summary.ranks = kernel_.ranks();
  summary.sharing = kernel_.sharing();
  summary.model = kernel_.model();
  summary.phases = kernel_.phases();
  double in_phases = 0;
  for (const PhaseTime& phase : summary.phases) in_phases += phase.seconds;
  summary.phases.push_back({"other", std::max(0.0, stepping_ - in_phases)});
  summary.phases.insert(summary.phases.end(), phases_.begin(), phases_.end());
  for (const Observer& observer : observers_) summary.probes.push_back(observer.cost());
}

}  // namespace grit
