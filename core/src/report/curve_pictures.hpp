// Curves and profiles of runs without a browser, as SVG.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/named_picture.hpp"
#include "report/run_results.hpp"

namespace grit {

/// Curves that the descriptions' pictures name, or else those of one number of "test", or else of the first probe; over
/// the picture's abscissa, or else time: a panel a curve, with all runs that have it and what their descriptions have
/// it compared with. Nothing where there is no curve. References that cannot be read are among the runs' problems.
std::optional<std::string> curves_picture(std::span<RunResults> runs);

/// Of each probe that has profiles a picture with a panel each: lists over places, a third and two thirds through the
/// samples and at the last.
std::vector<NamedPicture> profile_pictures(const RunResults& run);

/// The same of lists over directions, as polar plots.
std::vector<NamedPicture> direction_pictures(const RunResults& run);

}  // namespace grit
