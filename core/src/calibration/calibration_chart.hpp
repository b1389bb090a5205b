// Plots of a calibration.
#pragma once

#include <string>
#include <vector>

#include "calibration/calibration.hpp"

namespace grit {

/// SVG of the misfit of each trial, and of the best one so far.
std::string misfit_chart(const Trials& trials, std::size_t optimum);

/// SVG of a target that is a curve: the target with its tolerance, and the first and the best trial.
std::string target_chart(const Trials& trials, std::size_t optimum, std::size_t target, const std::string& name,
                         const MetricDescription& metric);

/// SVG of the deviations of all targets over tolerance and scatter, of the first and the best trial.
std::string deviation_chart(const Trials& trials, std::size_t optimum, const std::vector<std::string>& targets);

}  // namespace grit
