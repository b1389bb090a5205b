// All values of a description without effect.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// What a scene was read from: a file, and the values of --set. It can be read again with others.
struct SceneSource {
  std::filesystem::path file;
  std::vector<std::string> sets;
  const Registry& registry;

  Scene with(const std::vector<std::string>& more) const;
};

/// `components` and `kernel` are those of the initial scene.
std::vector<UnusedSetting> without_effect(const Scene& scene, const Components& components, const Kernel& kernel,
                                          const SceneSource& source);

}  // namespace grit
