#include "simulation/preflight.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "description/servo_face.hpp"
#include "input/places.hpp"
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
      if (const MotionDescription& motion = wall.motion;
          !motion.spin.isZero(0.0) || (motion.oscillation && !motion.oscillation->angle.isZero(0.0)))
        turned_.insert(name);
  }

 private:
  Faults& faults_;
  std::set<std::string> turned_, reported_;  // names of walls
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
    std::string pointer;
    for (const std::string& key : keys) pointer += '/' + pointer_token(key);
    add({pointer}, stages, message);
  };
}

void Faults::throw_if_any() {
  if (!problems_.empty()) throw DescriptionError(std::move(problems_));
}

void check_stages(const Scene& scene, LiveGeometries geometries, Faults& faults) {
  ServoCheck servos(faults);
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
    if (begins) servos.note_turns(now);
    return true;
  });
  end_stage();
}

}  // namespace grit
