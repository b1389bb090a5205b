#include "simulation/unreachable_conditions.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "description/wall_ways.hpp"

namespace grit {
namespace {

/// Relative error of products of values in a description.
constexpr double rounding = 1e-9;

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
    if (std::holds_alternative<DischargedCondition>(is) && states.domain.open_sides.empty())
      return complaints(
          "found a condition on discharged mass, but no side of the domain is open; set /domain/open_sides");
    return {};
  }

 private:
  /// If one of several is enough, complaints only if none of them can be met.
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
    return fmt::format("found a time of {:g} s; allowed is at most the limit of the stage, {:g} s", c.value,
                       states.stage.limit);
  }

  std::string judge(const DisplacementCondition& c) const {
    Ways way;
    for (const auto& walls : states.walls) {
      const Ways then = ways(walls, c.wall, c.axis.front());
      way = {way.along || then.along, way.against || then.against, std::max(way.speed, then.speed)};
    }
    if (c.value > 0 ? way.along : way.against) {
      const double limit = states.stage.limit;
      if (std::abs(c.value) <= way.speed * limit * (1 + rounding)) return "";
      return fmt::format(
          "found a displacement of {:g} m, but wall \"{}\" moves {:g} m at most, at {:g} m/s until the limit "
          "of the stage, {:g} s; allowed is a limit of {:.4g} s or more",
          c.value, c.wall, way.speed * limit, way.speed, limit, std::abs(c.value) / way.speed);
    }
    return "found a condition on the displacement of wall \"" + c.wall + "\" along " + c.axis +
           ", but its reference point " + (way.none() ? "does not move along it" : "moves in the opposite direction") +
           " in this stage; allowed is a displacement in the direction of the motion in /walls/" + c.wall +
           "/motion or in the change of the stage";
  }

  std::string judge(const PressureCondition& c) const {
    const WallDescription& wall = states.walls.front().at(c.wall);
    const auto geometry = states.geometries.find(c.wall);
    const bool on_specimen = wall.motion.servo && wall.motion.servo->area == "specimen",
               holds_at_none = c.value == 0 || c.within >= 1;
    if (on_specimen || holds_at_none || geometry == states.geometries.end() || geometry->second->area() > 0) return "";
    return "found a condition on the pressure on wall \"" + c.wall +
           "\", whose geometry has no area; allowed is a wall with an area: a rectangle, or /walls/" + c.wall +
           "/area if the geometry has it";
  }
};

}  // namespace

std::vector<Complaint> unreachable_conditions(const StageStates& states, std::size_t stage) {
  return Judge{states}.at(states.stage.until, "/stages/" + std::to_string(stage) + "/until");
}

}  // namespace grit
