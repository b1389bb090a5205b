// Plots error against cost.
#pragma once

#include <string>

#include "study/study_result.hpp"

namespace grit {

/// SVG of one metric's errors, or of the largest error of each variant if `metric` is empty. Empty without any cost.
std::string error_chart(const StudyResult& result, const std::string& metric);

/// The colour of a variant: that of the only setting that it varies.
const char* colour_of(const StudyResult& result, const VariantResult& outcome);

}  // namespace grit
