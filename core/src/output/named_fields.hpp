// Fields of probes that the output of a description names: as the colour of the picture, and for colour scales.
#pragma once

#include "description/description.hpp"
#include "grit/world.hpp"
#include "input/document.hpp"

namespace grit {

/// Throws DescriptionError with all names of fields that no probe has, or that are not there when the picture is drawn,
/// each with its location. Needs the world at the first instant; new instances of the probes are evaluated, so that
/// those of the run keep their state.
void check_fields(const Document& document, const SceneDescription& scene, const World& world);

}  // namespace grit
