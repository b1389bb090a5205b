// What the targets of a calibration ask of a run, as numbers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "calibration/description.hpp"
#include "calibration/trials.hpp"
#include "study/metrics.hpp"

namespace grit {

/// One for each target with a value, and those of even abscissae for each with a curve. Throws FileError for a curve
/// that cannot be read.
std::vector<Observation> observations_of(const CalibrationDescription& calibration);

/// What a run has found, by observation. Throws NumericsError if its curve covers too little of the target curve.
std::vector<double> found_in(const CalibrationDescription& calibration, const std::vector<Observation>& observations,
                             const std::map<std::string, Metric>& metrics);

}  // namespace grit
