#include "description/name_checks.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "format/names.hpp"
#include "format/number.hpp"
#include "grit/toolkit/did_you_mean.hpp"

namespace grit {
namespace {

/// Reports names that are not among `names`.
class References {
 public:
  References(std::string what, std::vector<std::string> names, const Complain& complain)
      : names_(std::move(names)), complain_(complain), what_(std::move(what)) {}
  template <class T>
  References(std::string what, const std::map<std::string, T>& named, const Complain& complain)
      : complain_(complain), what_(std::move(what)) {
    for (const auto& [name, _] : named) names_.push_back(name);
  }

  bool has(const std::string& name) const { return std::ranges::find(names_, name) != names_.end(); }
  void check(const std::string& key, const std::string& name) const {
    if (!has(name))
      complain_(key, "the " + what_ + ' ' + in_quotes(name) + ", which is not defined" + did_you_mean(name, names_),
                names_.empty() ? "none" : "one of " + listed(names_));
  }

 private:
  std::vector<std::string> names_;
  const Complain& complain_;
  std::string what_;
};

void check_walls_of(const Condition& condition, const std::string& key, const References& walls) {
  const auto each = [&](const std::vector<Condition>& parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) check_walls_of(parts[i], key + "/of/" + std::to_string(i), walls);
  };
  const auto& is = condition.is.value();
  if (const auto* displacement = std::get_if<DisplacementCondition>(&is))
    walls.check(key + "/wall", displacement->wall);
  if (const auto* pressure = std::get_if<PressureCondition>(&is)) walls.check(key + "/wall", pressure->wall);
  if (const auto* all = std::get_if<AllCondition>(&is)) each(all->of);
  if (const auto* any = std::get_if<AnyCondition>(&is)) each(any->of);
}

/// Reports walls that follow themselves through other walls.
void check_circles(const std::map<std::string, WallDescription>& walls, const Complain& complain) {
  for (const auto& [name, wall] : walls) {
    std::set<std::string> passed;
    const WallDescription* at = &wall;
    while (at->motion.follow && passed.insert(at->motion.follow->wall).second) {
      const auto next = walls.find(at->motion.follow->wall);
      if (next == walls.end()) break;
      at = &next->second;
    }
    if (passed.contains(name))
      complain("walls/" + name + "/motion/follow/wall", "a cycle of walls that follow each other",
               "a wall outside the cycle");
  }
}

}  // namespace

void check_number_of_materials(const SceneDescription& scene, const Complain& complain) {
  constexpr std::size_t most = 255;
  if (scene.materials.size() > most)
    complain("materials", counted(scene.materials.size(), "material", "materials"), std::to_string(most) + " or fewer");
}

void check_number_of_groups(const SceneDescription& scene, const Complain& complain) {
  constexpr std::size_t most = 65535;
  if (scene.bodies.size() > most)
    complain("bodies", counted(scene.bodies.size(), "group", "groups"), std::to_string(most) + " or fewer");
}

void check_interfaces(const SceneDescription& scene, const Complain& complain) {
  for (const auto& [name, _] : scene.materials)
    if (name.find('+') != std::string::npos)
      complain("materials/" + name, "a name with a +", "a name without +, which joins the materials of an interface");
  const References known("material", scene.materials, complain);
  std::set<std::pair<std::string, std::string>> pairs;
  for (const InterfaceDescription& one : scene.interfaces) {
    const std::string name = one.name(), key = "interfaces/" + name;
    if (one.b.empty()) {
      complain(key, in_quotes(name), "two materials joined by +, e.g. sand+steel");
      continue;
    }
    known.check(key, one.a);
    if (one.a != one.b) known.check(key, one.b);
    if (!pairs.insert(std::minmax(one.a, one.b)).second)
      complain(key, "an interface that is defined twice", "one definition, in either order");
  }
}

void check_materials_of_bodies(const SceneDescription& scene, const Complain& complain) {
  const References known("material", scene.materials, complain);
  for (const auto& [name, group] : scene.bodies) known.check("bodies/" + name + "/material", group.material);
}

void check_materials_of_walls(const SceneDescription& scene, const Complain& complain) {
  const References known("material", scene.materials, complain);
  for (const auto& [name, wall] : scene.walls) known.check("walls/" + name + "/material", wall.material);
}

void check_names_of_groups(const SceneDescription& scene, const Complain& complain) {
  const References known("group", scene.bodies, complain);
  const auto check = [&](const std::string& key, const std::vector<std::string>& groups) {
    for (std::size_t i = 0; i < groups.size(); ++i) known.check(key + "/groups/" + std::to_string(i), groups[i]);
  };
  for (const auto& [name, wall] : scene.walls) check("walls/" + name, wall.groups);
  for (const auto& [name, engine] : scene.engines) check("engines/" + name, engine.groups);
  for (const auto& [name, probe] : scene.probes) check("probes/" + name, probe.groups);
}

void check_followers(const SceneDescription& scene, const Complain& complain) {
  const References known("wall", scene.walls, complain);
  for (const auto& [name, wall] : scene.walls)
    if (wall.motion.follow) known.check("walls/" + name + "/motion/follow/wall", wall.motion.follow->wall);
  check_circles(scene.walls, complain);
}

void check_specimen(const SceneDescription& scene, const Complain& complain) {
  const References known("wall", scene.walls, complain);
  for (const auto& [key, side] : {std::pair("low", &scene.specimen.low), std::pair("high", &scene.specimen.high)})
    for (std::size_t k = 0; k < side->size(); ++k)
      if (!(*side)[k].empty()) known.check("specimen/" + std::string(key) + '/' + std::to_string(k), (*side)[k]);
}

void check_awaited_walls(const SceneDescription& scene, const Complain& complain) {
  const References known("wall", scene.walls, complain);
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    check_walls_of(scene.stages[i].until, "stages/" + std::to_string(i) + "/until", known);
  const auto check_cadence = [&](const std::string& key, const Cadence& cadence) {
    if (cadence.every_displacement) known.check(key + "/every_displacement/wall", cadence.every_displacement->wall);
  };
  for (const auto& [name, probe] : scene.probes) check_cadence("probes/" + name, probe.cadence);
  check_cadence("output/frames", scene.output.frames);
}

void check_unique_stages(const SceneDescription& scene, const Complain& complain) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    if (!names.insert(scene.stages[i].name).second)
      complain("stages/" + std::to_string(i) + "/name",
               in_quotes(scene.stages[i].name) + ", the name of an earlier stage", "a unique name");
}

void check_named_stages(const SceneDescription& scene, const Complain& complain) {
  std::vector<std::string> names;
  for (const auto& stage : scene.stages) names.push_back(stage.name);
  const References known("stage", names, complain);
  for (const auto& [name, group] : scene.bodies)
    if (!group.stage.empty()) known.check("bodies/" + name + "/stage", group.stage);
  for (const auto& [name, probe] : scene.probes)
    for (std::size_t i = 0; i < probe.stages.size(); ++i)
      known.check("probes/" + name + "/stages/" + std::to_string(i), probe.stages[i]);
}

}  // namespace grit
