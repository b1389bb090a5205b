#include "lint/without_effect.hpp"

#include <algorithm>
#include <iterator>

#include "lint/late_densities.hpp"
#include "lint/repeated_geometry.hpp"
#include "lint/unused_materials.hpp"
#include "lint/unused_motions.hpp"
#include "lint/unused_scenario_parameters.hpp"
#include "lint/unused_settings.hpp"

namespace grit {

Scene SceneSource::with(const std::vector<std::string>& more) const {
  auto all = sets;
  all.insert(all.end(), more.begin(), more.end());
  return load_scene(file, all, registry);
}

std::vector<UnusedSetting> without_effect(const Scene& scene, const Components& components, const Kernel& kernel,
                                          const SceneSource& source) {
  auto idle = unused_settings(scene, components, kernel);
  std::ranges::move(unused_motions(scene), std::back_inserter(idle));
  std::ranges::move(late_densities(scene), std::back_inserter(idle));
  const Description now = resolved(*scene.description);
  const auto same = [&](const std::vector<std::string>& more) {
    return resolved(*source.with(more).description) == now;
  };
  Document written = Document::load(source.file);
  for (const std::string& set : source.sets) written.set(set);
  const auto is_written = [&](const std::string& pointer) {
    return written.json().contains(Description::json_pointer(pointer));
  };
  for (UnusedSetting& one : unused_materials(scene, is_written)) {
    // Skips values that are listed already, or belong to something that is.
    if (std::ranges::none_of(idle, [&](const UnusedSetting& known) {
          return known.pointer == one.pointer || one.pointer.starts_with(known.pointer + '/');
        }))
      idle.push_back(std::move(one));
  }
  std::ranges::move(repeated_geometry(scene, is_written), std::back_inserter(idle));
  std::ranges::move(unused_scenario_parameters(written, same), std::back_inserter(idle));
  return idle;
}

}  // namespace grit
