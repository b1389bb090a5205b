// The results of a calibration as a self-contained HTML page without scripts.
#pragma once

#include <string>

#include "calibration/calibration.hpp"

namespace grit {

std::string calibration_page(const CalibrationDescription& calibration, const Trials& trials,
                             const CalibrationOutcome& outcome);

}  // namespace grit
