#include "simulation/expected_stages.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <map>
#include <optional>
#include <variant>

#include "bodies/make_bodies.hpp"
#include "bodies/stream.hpp"
#include "description/current_scene.hpp"
#include "format/number.hpp"
#include "kernel/step_time.hpp"

namespace grit {
namespace {

/// Bodies as one possible course of the run has them.
class Course {
 public:
  Course(const std::vector<ExpectedStream>& streams, double bodies) : streams_(streams), bodies_(bodies) {}

  /// Begins a stage that adds `more` bodies.
  void begin(const std::string& stage, double more) {
    bodies_ += more;
    for (const ExpectedStream& stream : streams_)
      if (stream.stage == stage) flowing_.emplace(&stream, 0);
  }
  /// Lets time pass; returns the integral of the number of bodies [s].
  double pass(double time) {
    double sum = bodies_ * time;
    for (auto& [stream, flown] : flowing_) {
      sum += stream->body_time(flown, flown + time);
      flown += time;
    }
    return sum;
  }
  double bodies() const {
    double sum = bodies_;
    for (const auto& [stream, flown] : flowing_) sum += stream->entered(flown);
    return sum;
  }

 private:
  const std::vector<ExpectedStream>& streams_;
  double bodies_;
  std::map<const ExpectedStream*, double> flowing_;  // s since each began
};

}  // namespace

Durations duration_until(const Condition& condition, const SceneDescription& scene, double dt) {
  const auto combined = [&](const Conditions& conditions, auto choose) {
    std::optional<Durations> both;
    for (const Condition& one : conditions.of) {
      const Durations its = duration_until(one, scene, dt);
      both = both ? Durations{choose(both->least, its.least), choose(both->most, its.most)} : its;
    }
    return both.value_or(Durations{});
  };
  const auto exactly = [](double time) { return Durations{time, time}; };
  return std::visit(
      [&]<class C>(const C& is) -> Durations {
        if constexpr (std::same_as<C, TimeCondition>) return exactly(is.value);
        if constexpr (std::same_as<C, StepsCondition>) return exactly(static_cast<double>(is.value) * dt);
        if constexpr (std::same_as<C, AllCondition>)
          return combined(is, [](double a, double b) { return std::max(a, b); });
        if constexpr (std::same_as<C, AnyCondition>)
          return combined(is, [](double a, double b) { return std::min(a, b); });
        if constexpr (std::same_as<C, DisplacementCondition>) {
          const MotionDescription& motion = scene.walls.at(is.wall).motion;
          const int axis = is.axis[0] - 'x';
          const double speed = motion.velocity[axis];
          const bool swings = motion.oscillation && motion.oscillation->amplitude[axis] != 0;
          if (speed != 0 && !swings) return exactly(std::abs(is.value / speed) + 0.5 * motion.ramp_time);
        }
        return {};
      },
      condition.is.value());
}

void check_end(const std::string& stage, std::size_t index, double end, double dt) {
  if (advances(end, dt)) return;
  throw NumericsError("stage \"" + stage + '"',
                      "time never reaches " + number(end) + " s, the end of this stage, in steps of " + number(dt) +
                          " s, which double precision cannot add to it; end the stage sooner, or check the units of "
                          "stiffnesses, densities, sizes and velocities, of which the time step is a function",
                      Guard::none, {"stages", std::to_string(index), "until"});
}

void check_ends(const Scene& scene, double dt) {
  double end = 0;
  std::size_t next = 0;
  through_stages(*scene.description, scene.stages, [&](const SceneDescription& now, std::optional<std::size_t> i) {
    if (!i || *i < next) return true;
    const StageDescription& stage = scene.description->stages[*i];
    const double own = now.time_step.value.value_or(dt);
    end += duration_until(stage.until, now, own).least;
    check_end(stage.name, *i, end, own);
    next = *i + 1;
    return true;
  });
}

double ExpectedStream::entered(double time) const { return std::min(limit, rate * time); }

double ExpectedStream::body_time(double begin, double end) const {
  const double full = std::clamp(limit / rate, begin, end);
  return 0.5 * rate * (full * full - begin * begin) + (full < end ? limit * (end - full) : 0);
}

std::vector<ExpectedStream> expected_streams(const SceneDescription& scene, const Components& components) {
  std::vector<ExpectedStream> all;
  for (const auto& [name, group] : scene.bodies) {
    const auto* source = std::get_if<StreamSource>(&group.source.value());
    if (source == nullptr) continue;
    const auto& kind = components.body_kinds.at(name);
    const double spheres = kind->clump() != nullptr ? static_cast<double>(kind->clump()->spheres.size()) : 1;
    const std::size_t count = body_count(scene, name, kind);
    all.push_back({.name = name,
                   .stage = group.stage.empty() ? scene.stages.front().name : group.stage,
                   .rate = spheres * expected_rate(*source, GroupBuilder(scene, group, kind)),
                   .limit = count > 0 ? static_cast<double>(count) : std::numeric_limits<double>::infinity()});
  }
  return all;
}

std::vector<ExpectedStage> expected_stages(const Scene& scene, const Components& components, std::size_t bodies,
                                           double dt) {
  const SceneDescription& description = *scene.description;
  const std::vector<ExpectedStream> streams = expected_streams(description, components);
  std::map<std::string, std::size_t> coming;  // by stage
  for (const auto& [name, group] : description.bodies)
    if (!group.stage.empty() && !std::holds_alternative<StreamSource>(group.source.value()))
      coming[group.stage] += body_count(description, name, components.body_kinds.at(name));

  std::vector<ExpectedStage> all;
  Course least(streams, static_cast<double>(bodies)), most = least, shown = least;
  through_stages(description, scene.stages, [&](const SceneDescription& now, std::optional<std::size_t> i) {
    if (!i || all.size() > *i) return true;
    const StageDescription& stage = description.stages[*i];
    ExpectedStage one;
    one.dt = now.time_step.value.value_or(dt);
    const Durations bounds = duration_until(stage.until, now, one.dt);
    one.known = bounds.least == bounds.most;
    one.usual = !one.known && stage.typical_time;
    one.least = one.usual ? std::clamp(*stage.typical_time, bounds.least, bounds.most) : bounds.least;
    one.most = one.known ? bounds.most : std::min(bounds.most, stage.limit);
    one.arriving = coming[stage.name];
    for (Course* course : {&least, &most, &shown}) course->begin(stage.name, static_cast<double>(one.arriving));
    one.least_body_time = least.pass(one.least), one.most_body_time = most.pass(one.most);
    shown.pass(one.shown());
    one.bodies = shown.bodies();
    all.push_back(one);
    return true;
  });
  return all;
}

}  // namespace grit
