#include "input/never_holds.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <memory>
#include <variant>

#include "scene/wall_ways.hpp"

namespace grit {
namespace {

using Complaints = std::vector<Complaint>;
using Parts = std::vector<std::unique_ptr<Condition>>;

struct Look {
  const StagePlan& plan;
  const SceneDescription& scene;
  const StageDescription& stage;

  Complaints at(const Condition& condition, const std::string& pointer) const {
    const auto told = [&](const std::string& message) {
      return message.empty() ? Complaints{} : Complaints{{pointer, message}};
    };
    const auto& is = condition.is.value();
    if (const auto* all = std::get_if<AllCondition>(&is)) return each(all->of, pointer, false);
    if (const auto* any = std::get_if<AnyCondition>(&is)) return each(any->of, pointer, true);
    if (const auto* time = std::get_if<TimeCondition>(&is)) return told(look(*time));
    if (const auto* displacement = std::get_if<DisplacementCondition>(&is)) return told(look(*displacement));
    if (const auto* pressure = std::get_if<PressureCondition>(&is)) return told(look(*pressure));
    if (std::holds_alternative<LeftCondition>(is) && scene.domain.open_sides.empty())
      return told(
          "found a wait for mass that leaves, and all sides of the domain hold bodies back; name those that let them "
          "through in /domain/open_sides");
    return {};
  }

 private:
  /// Where one of several is enough, only if none of them can come true.
  Complaints each(const Parts& parts, const std::string& pointer, bool one_is_enough) const {
    Complaints all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Complaints of_part = at(*parts[i], pointer + "/of/" + std::to_string(i));
      if (one_is_enough && of_part.empty()) return {};
      all.insert(all.end(), of_part.begin(), of_part.end());
    }
    return all;
  }

  std::string look(const TimeCondition& c) const {
    if (c.value <= stage.limit) return "";
    return fmt::format(
        "found a wait of {:g} s; allowed is at most the limit of the stage, {:g} s, beyond which it has failed",
        c.value, stage.limit);
  }

  std::string look(const DisplacementCondition& c) const {
    Ways way = ways(scene.walls, c.wall, c.axis.front());
    for (const auto& increment : plan.ramp) {
      const Ways then = ways(increment->walls, c.wall, c.axis.front());
      way = {way.along || then.along, way.against || then.against};
    }
    if (c.value > 0 ? way.along : way.against) return "";
    return "found a wait for the wall \"" + c.wall + "\" to go along " + c.axis + ", where its reference point " +
           (way.none() ? "stands still" : "goes the other way") +
           " in this stage; allowed is a displacement of the sign of a motion that it has: of /walls/" + c.wall +
           "/motion, or of what the stage changes it to";
  }

  std::string look(const PressureCondition& c) const {
    const WallDescription& wall = scene.walls.at(c.wall);
    const bool on_specimen = wall.motion.servo && wall.motion.servo->area == "specimen",
               holds_at_none = c.value == 0 || c.within >= 1;
    if (on_specimen || holds_at_none || wall.geometry->area() > 0) return "";
    return "found a wait for the pressure on the wall \"" + c.wall +
           "\", whose geometry has no area; allowed is a wall with one: a rectangle, or /walls/" + c.wall +
           "/area where the geometry takes it";
  }
};

}  // namespace

std::vector<Complaint> never_holds(const StagePlan& plan, std::size_t stage) {
  const StageDescription& described = plan.start->stages.at(stage);
  return Look{plan, *plan.start, described}.at(described.until, "/stages/" + std::to_string(stage) + "/until");
}

}  // namespace grit
