// The JSON Schema (draft-07) of descriptions, for editors, from the same declarations as the reader.
#pragma once

#include "grit/description.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// The schema of a complete description with everything installed: a plain scene, a scenario with keys merged onto it,
/// or, with "extends", a part of either. It does not cover names that must exist, ranges of quantities in texts, and
/// checks between parameters. Loads every plugin; throws PluginError as Registry::make does.
Description scene_schema(const Registry& registry);

}  // namespace grit
