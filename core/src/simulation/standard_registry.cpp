#include "simulation/standard_registry.hpp"

#include "bodies/clump_body.hpp"
#include "bodies/sphere_body.hpp"
#include "motion/builtin.hpp"
#include "plugins/loader.hpp"

namespace grit {

std::unique_ptr<Registry> standard_registry(const std::vector<std::string>& plugin_path, const std::string& option) {
  auto registry = std::make_unique<Registry>(plugin_directories(plugin_path, library_directory()), option);
  registry->add(sphere_body());
  registry->add(clump_body());
  for (const PluginInfo& engine : builtin_engines()) registry->add(engine);
  return registry;
}

}  // namespace grit
