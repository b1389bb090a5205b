// Pictures of curves and profiles of runs, as SVG, without a browser.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/named_picture.hpp"
#include "report/run_results.hpp"

namespace grit {

/// The curves named by the descriptions' pictures; otherwise the scalar channels of "test", or of the first probe. The
/// abscissa is that of the picture, or time. A panel per curve, with all runs that have it and the references. Empty if
/// there is no curve. Unreadable references are added to the runs' problems.
std::optional<std::string> curves_picture(std::span<RunResults> runs);

/// For each probe with profiles (lists over positions) a picture with a panel per profile, with the samples at one and
/// two thirds and the last one.
std::vector<NamedPicture> profile_pictures(const RunResults& run);

/// The same for lists over directions, as polar plots.
std::vector<NamedPicture> direction_pictures(const RunResults& run);

}  // namespace grit
