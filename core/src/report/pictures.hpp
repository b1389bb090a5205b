// Pictures of a run without a browser, as SVG.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/run_results.hpp"

namespace grit {

/// Curves that the description's picture names, or else those of one number of "test", or else of the first probe; over
/// the picture's abscissa, or else time. Nothing where there is no curve.
std::optional<std::string> curves_picture(const RunResults& run);

/// The grains of the last frame that can be read, as the description's picture has them; by speed where nothing else is
/// kept. Nothing where there is no frame.
std::optional<std::string> grains_picture(RunResults& run);

/// The same, coloured by the layers in which grains were when the stage began in which some leave, or else the last
/// one. Nothing where there is no frame after that.
std::optional<std::string> layers_picture(RunResults& run);

struct NamedPicture {
  std::string name;  ///< for a file: "map-packing-void_ratio"
  std::string svg;
};

/// The maps of the last frame that can be read, a picture a field with a panel a component. Seen as the description's
/// picture has it, cut through the middle.
std::vector<NamedPicture> map_pictures(RunResults& run);

}  // namespace grit
