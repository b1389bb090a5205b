#include "simulation/unreachable_conditions.hpp"

#include <spdlog/fmt/fmt.h>

#include <variant>

#include "description/wall_ways.hpp"

namespace grit {
namespace {

using Complaints = std::vector<Complaint>;
using Parts = std::vector<Condition>;

struct Judge {
  const StageStates& states;

  Complaints at(const Condition& condition, const std::string& pointer) const {
    const auto complaints = [&](const std::string& message) {
      return message.empty() ? Complaints{} : Complaints{{pointer, message}};
    };
    const auto& is = condition.is.value();
    if (const auto* all = std::get_if<AllCondition>(&is)) return each(all->of, pointer, false);
    if (const auto* any = std::get_if<AnyCondition>(&is)) return each(any->of, pointer, true);
    if (const auto* time = std::get_if<TimeCondition>(&is)) return complaints(judge(*time));
    if (const auto* displacement = std::get_if<DisplacementCondition>(&is)) return complaints(judge(*displacement));
    if (const auto* pressure = std::get_if<PressureCondition>(&is)) return complaints(judge(*pressure));
    if (std::holds_alternative<LeftCondition>(is) && states.domain.open_sides.empty())
      return complaints(
          "found a wait for mass that leaves, and all sides of the domain hold bodies back; name those that let them "
          "through in /domain/open_sides");
    return {};
  }

 private:
  /// Where one of several is enough, only if none of them can come true.
  Complaints each(const Parts& parts, const std::string& pointer, bool one_is_enough) const {
    Complaints all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Complaints of_part = at(parts[i], pointer + "/of/" + std::to_string(i));
      if (one_is_enough && of_part.empty()) return {};
      all.insert(all.end(), of_part.begin(), of_part.end());
    }
    return all;
  }

  std::string judge(const TimeCondition& c) const {
    if (c.value <= states.stage.limit) return "";
    return fmt::format(
        "found a wait of {:g} s; allowed is at most the limit of the stage, {:g} s, beyond which it has failed",
        c.value, states.stage.limit);
  }

  std::string judge(const DisplacementCondition& c) const {
    Ways way;
    for (const auto& walls : states.walls) {
      const Ways then = ways(walls, c.wall, c.axis.front());
      way = {way.along || then.along, way.against || then.against};
    }
    if (c.value > 0 ? way.along : way.against) return "";
    return "found a wait for the wall \"" + c.wall + "\" to go along " + c.axis + ", where its reference point " +
           (way.none() ? "stands still" : "goes the other way") +
           " in this stage; allowed is a displacement of the sign of a motion that it has: of /walls/" + c.wall +
           "/motion, or of what the stage changes it to";
  }

  std::string judge(const PressureCondition& c) const {
    const WallDescription& wall = states.walls.front().at(c.wall);
    const auto geometry = states.geometries.find(c.wall);
    const bool on_specimen = wall.motion.servo && wall.motion.servo->area == "specimen",
               holds_at_none = c.value == 0 || c.within >= 1;
    if (on_specimen || holds_at_none || geometry == states.geometries.end() || geometry->second->area() > 0) return "";
    return "found a wait for the pressure on the wall \"" + c.wall +
           "\", whose geometry has no area; allowed is a wall with one: a rectangle, or /walls/" + c.wall +
           "/area where the geometry takes it";
  }
};

}  // namespace

std::vector<Complaint> unreachable_conditions(const StageStates& states, std::size_t stage) {
  return Judge{states}.at(states.stage.until, "/stages/" + std::to_string(stage) + "/until");
}

}  // namespace grit
