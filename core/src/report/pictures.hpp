// Pictures of grains and maps of a run, as SVG, without a browser.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/named_picture.hpp"
#include "report/run_results.hpp"

namespace grit {

/// The grains of the last readable frame, as defined by the description's picture; coloured by speed if nothing else is
/// stored. Empty if there is no frame.
std::optional<std::string> grains_picture(RunResults& run);

/// The same, coloured by layers at the start of the stage in which grains begin to leave, or else of the last stage.
/// Empty if there is no later frame.
std::optional<std::string> layers_picture(RunResults& run);

/// The same, faint, below the contacts above the mean normal force, through the whole depth. Empty if there is none.
std::optional<std::string> force_chains_picture(RunResults& run);

/// The same below the links of the linear force chains of a probe.
std::optional<std::string> chains_picture(RunResults& run);

/// The maps of the last readable frame: a picture per field with a panel per component. The view is that of the
/// description's picture, in a section through the middle, with the walls. Fields that only count or number are
/// omitted.
std::vector<NamedPicture> map_pictures(RunResults& run);

}  // namespace grit
