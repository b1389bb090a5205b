// Plots metrics of a sweep against a setting.
#pragma once

#include <string>

#include "study/study_result.hpp"

namespace grit {

/// SVG of a metric with one value against the levels of a setting, with standard errors: one line for each combination
/// of the other settings. Empty without any value.
std::string sweep_chart(const StudyResult& result, const std::string& metric, const std::string& setting);

/// SVG of the mean curves of a metric: one for each level of a setting, the others at their usual levels. Empty without
/// any curve.
std::string sweep_curves(const StudyResult& result, const std::string& metric, const std::string& setting);

}  // namespace grit
