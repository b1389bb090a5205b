#include "input/never_holds.hpp"

#include <algorithm>
#include <memory>
#include <variant>
#include <vector>

#include "scene/wall_ways.hpp"

namespace grit {
namespace {

struct Look {
  const SceneDescription& scene;
  const StageDescription& stage;
  const std::function<void(const std::string&, const std::string&)>& complain;

  void at(const Condition& condition, const std::string& pointer) const {
    const auto& is = condition.is.value();
    if (const auto* all = std::get_if<AllCondition>(&is)) each(all->of, pointer);
    if (const auto* any = std::get_if<AnyCondition>(&is)) each(any->of, pointer);
    if (const auto* displacement = std::get_if<DisplacementCondition>(&is)) look(*displacement, pointer);
    if (const auto* pressure = std::get_if<PressureCondition>(&is)) look(*pressure, pointer);
    if (std::holds_alternative<LeftCondition>(is) && scene.domain.open_sides.empty())
      complain(pointer,
               "found a wait for mass that leaves, and all sides of the domain hold bodies back; name those that "
               "let them through in /domain/open_sides");
  }

 private:
  void each(const std::vector<std::unique_ptr<Condition>>& parts, const std::string& pointer) const {
    for (std::size_t i = 0; i < parts.size(); ++i) at(*parts[i], pointer + "/of/" + std::to_string(i));
  }

  void look(const DisplacementCondition& c, const std::string& pointer) const {
    const bool ramped = std::ranges::any_of(
        stage.ramps, [](const RampDescription& ramp) { return ramp.pointer.starts_with("/walls/"); });
    const Ways way = ways(scene.walls, c.wall, c.axis.front());
    if (ramped || c.value == 0 || (c.value > 0 ? way.along : way.against)) return;
    complain(pointer, "found a wait for the wall \"" + c.wall + "\" to go along " + c.axis + ", where it " +
                          (way.none() ? "stands still" : "goes the other way") +
                          " in this stage; allowed is a displacement of the sign of a motion that it has: of /walls/" +
                          c.wall + "/motion, or of what the stage changes it to");
  }

  void look(const PressureCondition& c, const std::string& pointer) const {
    const WallDescription& wall = scene.walls.at(c.wall);
    const bool on_specimen = wall.motion.servo && wall.motion.servo->area == "specimen";
    if (on_specimen || c.value == 0 || wall.geometry->area() > 0) return;
    complain(pointer, "found a wait for the pressure on the wall \"" + c.wall +
                          "\", whose geometry has no area; allowed is a wall with one: a rectangle, or /walls/" +
                          c.wall + "/area where the geometry takes it");
  }
};

}  // namespace

void never_holds(const SceneDescription& scene, std::size_t stage,
                 const std::function<void(const std::string& pointer, const std::string& message)>& complain) {
  const StageDescription& described = scene.stages.at(stage);
  Look{scene, described, complain}.at(described.until, "/stages/" + std::to_string(stage) + "/until");
}

}  // namespace grit
