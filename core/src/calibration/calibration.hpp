// A calibration from its first trial to what it has found.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/description.hpp"
#include "calibration/search.hpp"
#include "calibration/trials.hpp"
#include "calibration/uncertainty.hpp"
#include "grit/description.hpp"

namespace grit {

struct CalibrationOutcome {
  SearchEnd end = SearchEnd::trials;
  std::size_t optimum = 0;  ///< index of the trial
  Uncertainty uncertainty;
};

/// Trials beyond those of the search, at most.
std::size_t most_further_trials(std::size_t parameters);

/// Searches, and explores the optimum. Throws NumericsError if all trials of the search failed, and what an evaluation
/// throws.
CalibrationOutcome calibrate(Trials& trials, const OptimizerDescription& optimizer);

/// Whether all targets are met.
bool is_met(const Trials& trials, const CalibrationOutcome& outcome);

/// "friction_angle: 18.2 ± 0.4 deg" of each parameter, with its bound if it is at one.
std::vector<std::string> parameter_texts(const CalibrationDescription& calibration, const Trials& trials,
                                         const CalibrationOutcome& outcome);

/// "peak: 748 ± 5, target 750 ± 20, misfit 0.01" of each target, in the units of the channels.
std::vector<std::string> target_texts(const CalibrationDescription& calibration, const Trials& trials,
                                      const CalibrationOutcome& outcome);

/// The verdict in sentences: whether the targets are met, what they cannot tell apart, parameters at a bound, trials
/// that failed, the cost.
std::vector<std::string> verdict(const CalibrationDescription& calibration, const Trials& trials,
                                 const CalibrationOutcome& outcome);

/// calibration.json. `written`: the description of the calibration; `outcome`: null before its end.
Description to_json(const CalibrationDescription& calibration, const Description& written, const Trials& trials,
                    const CalibrationOutcome* outcome);

/// A description that extends the base, found at `base` from its own folder, by the values of a trial.
Description fitted_description(const CalibrationDescription& calibration, const std::filesystem::path& base,
                               const std::vector<double>& values);

}  // namespace grit
