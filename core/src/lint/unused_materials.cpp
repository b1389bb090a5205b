#include "lint/unused_materials.hpp"

#include <spdlog/fmt/fmt.h>

#include <set>

#include "lint/small_changes.hpp"
#include "scene/make_bodies.hpp"

namespace grit {
namespace {

/// All that contacts of a scene know of materials.
void add_mixed(const SceneDescription& scene, std::vector<double>& all) {
  const auto names = material_names(scene);
  ContactLaw& law = *scene.contacts.get();
  law.mix(materials_in_use(scene, names), materials_of_bodies(scene));
  const auto number = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  std::set<std::size_t> bodies, walls;
  for (const auto& [name, group] : scene.bodies) bodies.insert(number(group.material));
  for (const auto& [name, wall] : scene.walls) walls.insert(number(wall.material));
  for (const std::size_t a : bodies) {
    for (const std::size_t b : bodies) std::ranges::copy(law.mixed(a, b, false), std::back_inserter(all));
    for (const std::size_t b : walls) std::ranges::copy(law.mixed(a, b, true), std::back_inserter(all));
  }
}

/// Of its stages, and of its start, with which the law is left.
std::vector<double> mixed(const Scene& scene) {
  std::vector<double> all;
  for (const StagePlan& stage : scene.stages) {
    add_mixed(*stage.start, all);
    for (const auto& increment : stage.ramp) add_mixed(*increment, all);
  }
  add_mixed(*scene.description, all);
  return all;
}

}  // namespace

std::vector<std::string> unused_materials(const Scene& scene, const std::function<bool(const std::string&)>& is_written,
                                          const std::function<Scene(const std::string&)>& with) {
  const Description values = resolved(*scene.description);
  const std::vector<double> now = mixed(scene);
  std::vector<std::string> lines;
  for (const char* section : {"materials", "interfaces"})
    for (const auto& [name, one] : values.at(section).items())
      for (const auto& [key, value] : one.items()) {
        const std::string pointer = fmt::format("/{}/{}/{}", section, pointer_token(name), key);
        if (key == "density" || !value.is_number() || !is_written(pointer)) continue;
        if (changes_nothing(value, [&](const std::string& other) { return mixed(with(pointer + '=' + other)) == now; }))
          lines.push_back(pointer + ": no contact depends on it: what meets takes it of the other material, of an " +
                          "interface, or not at all");
      }
  return lines;
}

}  // namespace grit
