#include "app/idle_settings.hpp"

#include <spdlog/fmt/fmt.h>

#include <iostream>

#include "app/run_setup.hpp"
#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "kernel/kernel.hpp"
#include "simulation/live_scene.hpp"
#include "simulation/prepared_sample.hpp"

namespace grit {

std::vector<UnusedSetting> idle_settings(const SceneSource& source) try {
  const Scene scene = source.with({});
  const LiveScene live(scene);
  const Components& components = live.components();
  const Kernel kernel(*scene.description, components,
                      prepare(live, source.registry, run_state(*scene.description, components)), 1);
  return without_effect(scene, components, kernel, source);
} catch (const PlacedError&) {
  return {};
} catch (const NumericsError&) {
  return {};
} catch (const DescriptionError&) {
  return {};
}

std::optional<std::string> why_idle(const std::vector<UnusedSetting>& idle, const std::string& pointer) {
  for (const UnusedSetting& one : idle)
    if ((pointer + '/').starts_with(one.pointer + '/')) return fmt::format("{}: {}", one.pointer, one.why);
  return std::nullopt;
}

void warn_of_idle(const Document& written, const std::string& where, const std::string& why) {
  Problem problem = written.problem(where, "without effect: " + why);
  problem.pointer = where;
  std::cerr << "grit: warning: " << DescriptionError({problem}).what() << std::endl;
}

}  // namespace grit
