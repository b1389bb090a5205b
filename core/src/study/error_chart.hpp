// Error against cost, drawn.
#pragma once

#include <string>

#include "study/chart.hpp"

namespace grit {

/// SVG of one figure's errors, or of the largest of each variant where `figure` is empty. Empty if nothing has a cost.
std::string error_chart(const Chart& chart, const std::string& figure);

/// The colour of a variant: that of the setting which it varies alone.
const char* colour_of(const Chart& chart, const VariantResult& result);

}  // namespace grit
