// What the targets of a calibration ask of a run, as numbers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "calibration/description.hpp"
#include "calibration/trials.hpp"
#include "input/document.hpp"
#include "study/metrics.hpp"

namespace grit {

/// One for each target with a value, and those of even abscissae for each with a curve. `units`: of the channels, as
/// PROBE/CHANNEL. Throws DescriptionError with all curves that cannot be read, and all numbers that cannot be computed
/// with.
std::vector<Observation> observations_of(const CalibrationDescription& calibration, const Document& written,
                                         const std::map<std::string, std::string>& units);

/// What a run has found, by observation. Throws NumericsError if its curve covers too little of the target curve.
std::vector<double> found_in(const CalibrationDescription& calibration, const std::vector<Observation>& observations,
                             const std::map<std::string, Metric>& metrics);

}  // namespace grit
