// Grains and maps of a run without a browser, as SVG.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/named_picture.hpp"
#include "report/run_results.hpp"

namespace grit {

/// The grains of the last frame that can be read, as the description's picture has them; by speed where nothing else is
/// kept. Nothing where there is no frame.
std::optional<std::string> grains_picture(RunResults& run);

/// The same, coloured by the layers in which grains were when the stage began in which some leave, or else the last
/// one. Nothing where there is no frame after that.
std::optional<std::string> layers_picture(RunResults& run);

/// The same, faint, under the contacts above the mean normal force, through the whole depth. Nothing where
/// there is none.
std::optional<std::string> force_chains_picture(RunResults& run);

/// The same under the links of the linear force chains that a probe tells of.
std::optional<std::string> chains_picture(RunResults& run);

/// The maps of the last frame that can be read, a picture a field with a panel a component. Seen as the description's
/// picture has it, cut through the middle, with the walls there. Fields that only count or number are left out.
std::vector<NamedPicture> map_pictures(RunResults& run);

}  // namespace grit
