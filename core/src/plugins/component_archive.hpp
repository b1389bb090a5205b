// State of plugins in checkpoints.
#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "grit/archive.hpp"
#include "grit/error.hpp"

namespace grit {

/// Saves or restores the state of each component separately, so that one that reads more or less than it saved is named
/// and does not affect others. Throws PluginError.
template <class Component>
void serialize_component(const std::string& who, Component& component, Archive& archive) {
  archive.part(who, 1);
  std::vector<std::byte> own;
  if (!archive.restoring()) own = saved_state(component);
  archive(own);
  if (!archive.restoring()) return;
  try {
    restore_state(component, std::move(own));
  } catch (const std::exception& error) {
    throw PluginError(who + " cannot be restored from a checkpoint: " + error.what());
  }
}

}  // namespace grit
