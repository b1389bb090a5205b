#include "simulation/preflight.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <set>
#include <tuple>

#include "contact/critical_step.hpp"
#include "description/servo_face.hpp"
#include "description/wall_ways.hpp"
#include "format/number.hpp"
#include "input/places.hpp"
#include "simulation/mixed_law.hpp"
#include "simulation/unreachable_conditions.hpp"

namespace grit {
namespace {

/// Checks the servos of all stages.
class ServoCheck {
 public:
  explicit ServoCheck(Faults& faults) : faults_(faults) {}

  void check(const SceneDescription& now, const LiveGeometries& geometries, std::size_t stages) {
    for (const auto& [name, wall] : now.walls) {
      const MotionDescription& motion = wall.motion;
      const auto geometry = geometries.all().find(name);
      if (!motion.servo || !motion.servo->pressure || geometry == geometries.all().end()) continue;
      const Vec3 normal = turned_.contains(name) ? Vec3(Vec3::Ones()) : geometry->second->normal();
      const std::string& axis = motion.servo->axis;
      const std::string why = presses_on_specimen(motion) && !specimen_ends_across(now, axis)
                                  ? lacks_cross_section(axis)
                                  : presses_with_nothing(motion, *geometry->second, normal);
      if (why.empty() || !reported_.insert(name).second) continue;
      const std::string at = "/walls/" + pointer_token(name);
      std::vector<std::string> causes{at + "/motion/servo", at + "/type", at + "/material"};
      for (const auto& [key, value] : wall.geometry.values().items()) causes.push_back(at + '/' + pointer_token(key));
      faults_.add(causes, stages, why);
    }
  }

  /// The normal of a wall after a rotation is known only during the run.
  void note_turns(const SceneDescription& now) {
    for (const auto& [name, wall] : now.walls)
      if (turns(wall.motion)) turned_.insert(name);
  }

 private:
  Faults& faults_;
  std::set<std::string> turned_, reported_;  // names of walls
};

/// Checks a prescribed time step against groups that appear later, and materials that change. The first instant is
/// checked with all contacts.
class TimeStepCheck {
 public:
  TimeStepCheck(const Scene& scene, const Components& components, Faults& faults)
      : stages_(scene.description->stages), components_(components), faults_(faults), law_(*scene.description) {}

  void check(const SceneDescription& now, std::size_t stage) {
    const TimeStepDescription& wish = now.time_step;
    if (reported_ || !wish.value || wish.allow_unstable || !is_complete(now)) return;
    bool changed = law_.follow(now) || *wish.value != checked_;
    for (const auto& [name, group] : now.bodies)
      if (!groups_.contains(name) && (group.stage.empty() ? !is_file(group) : group.stage == stages_[stage].name)) {
        groups_.emplace(name, smallest_of(now, name));
        changed = true;
      }
    if (!changed) return;
    checked_ = *wish.value;
    for (const auto& [name, bodies] : groups_) {
      const double critical = demand_without_contacts(bodies, law_.law()).critical_time_step();
      if (*wish.value <= critical) continue;
      reported_ = true;
      if (stage == 0 && now.bodies.at(name).stage.empty()) return;
      faults_.add({"/time_step/value", "/materials/" + pointer_token(now.bodies.at(name).material)}, stage + 1,
                  "the time step " + number(*wish.value) + " s is above the critical one of group \"" + name +
                      "\" in stage \"" + stages_[stage].name + "\", " + number(critical) +
                      " s; remove /time_step/value, or set /time_step/allow_unstable to true");
      return;
    }
  }

 private:
  /// A file may be a pipe, which can be read only once, for the run.
  static bool is_file(const BodiesDescription& group) {
    return std::holds_alternative<FileSource>(group.source.value());
  }
  /// A file that cannot be read is reported when the bodies are made.
  Bodies smallest_of(const SceneDescription& now, const std::string& group) const {
    try {
      return smallest_bodies(now, components_, {group});
    } catch (const PlacedError&) {
      return {};
    }
  }
  /// Whether all body kinds could be made; others have been reported.
  bool is_complete(const SceneDescription& now) const {
    return std::ranges::all_of(now.bodies, [this](const auto& group) {
      const auto kind = components_.body_kinds.find(group.first);
      return kind != components_.body_kinds.end() && kind->second != nullptr;
    });
  }

  const std::deque<StageDescription>& stages_;
  const Components& components_;
  Faults& faults_;
  MixedLaw law_;
  std::map<std::string, Bodies> groups_;  // the smallest body of each group that has appeared
  double checked_ = 0;                    // s
  bool reported_ = false;
};

}  // namespace

void Faults::add(const std::string& pointer, const std::string& message) {
  Problem problem = document_->problem(pointer, message);
  const auto is_known = [&](const Problem& known) {
    return std::tie(known.file, known.line, known.pointer, known.message) ==
           std::tie(problem.file, problem.line, problem.pointer, problem.message);
  };
  if (std::ranges::none_of(problems_, is_known)) problems_.push_back(std::move(problem));
}

void Faults::add(const std::vector<std::string>& pointers, std::size_t stages, const std::string& message) {
  add(written_last(*document_, pointers, stages), message);
}

ReportFault Faults::report_of(std::size_t stages) {
  return [this, stages](const std::vector<std::string>& keys, const std::string& message) {
    add({pointer_of(keys)}, stages, message);
  };
}

void Faults::throw_if_any() {
  if (!problems_.empty()) throw DescriptionError(std::move(problems_));
}

void check_stages(const Scene& scene, const Components& components, LiveGeometries geometries, Faults& faults) {
  ServoCheck servos(faults);
  TimeStepCheck time_step(scene, components, faults);
  std::optional<StageStates> states;
  std::size_t stage = 0;
  const auto end_stage = [&] {
    if (!states) return;
    for (const auto& [pointer, message] : unreachable_conditions(*states, stage)) faults.add(pointer, message);
  };
  through_stages(*scene.description, scene.stages, [&](const SceneDescription& now, std::optional<std::size_t> number) {
    if (!number) return true;
    const bool begins = !states || stage != *number;
    if (begins) {
      end_stage();
      stage = *number;
      states.emplace(StageStates{scene.description->stages[stage], now.domain, {}, {}});
    }
    geometries.follow(now, faults.report_of(stage + 1));
    if (begins) states->geometries = geometries.all();
    states->walls.push_back(now.walls);
    if (!begins) servos.note_turns(now);
    servos.check(now, geometries, stage + 1);
    time_step.check(now, stage);
    if (begins) servos.note_turns(now);
    return true;
  });
  end_stage();
}

}  // namespace grit
