// What plugins remember, in a checkpoint.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/memory.hpp"

namespace grit {

/// Of each by itself, so that one that asks for more or less than it saved is named, and disturbs no other. Throws
/// PluginError.
template <class Component>
void remember_by_itself(const std::string& who, Component& component, Memory& memory) {
  std::vector<std::byte> own;
  if (!memory.restoring()) own = saved_memory(component);
  memory(own);
  if (!memory.restoring()) return;
  try {
    restore_memory(component, std::move(own));
  } catch (const Error& error) {
    throw PluginError(who + " does not go on from a checkpoint: " + error.what());
  }
}

}  // namespace grit
