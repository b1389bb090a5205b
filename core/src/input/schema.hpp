// The JSON Schema (draft-07) of descriptions, for editors, from the same declarations that reading goes by.
#pragma once

#include "grit/description.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// The schema of a whole description with everything installed: a plain scene, a scenario with what is merged onto it,
/// or, with "extends", a part of either. Names that must exist, ranges of quantities in texts, and checks between
/// parameters are beyond it. Loads every plugin; throws PluginError as Registry::make does.
Description scene_schema(const Registry& registry);

}  // namespace grit
