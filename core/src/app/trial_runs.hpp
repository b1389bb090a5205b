// The runs of a calibration's trials: processes of their own, whose folders are read again when it continues.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "calibration/trials.hpp"
#include "input/document.hpp"
#include "input/scene.hpp"
#include "study/run_command.hpp"

namespace grit {

/// The user has interrupted the runs, which have saved their state.
struct Interrupted {};

/// A calibration and where its runs are.
struct CalibrationPlace {
  CalibrationDescription calibration;
  Document written;  ///< what the file says
  std::filesystem::path out;
  std::vector<Observation> observations;
};

struct CheckedTrials {
  Scene first;
  std::vector<Observation> observations;
};

class TrialRuns {
 public:
  /// `waiting` is called several times a second with the number of a trial's runs that have ended.
  TrialRuns(const CalibrationPlace& place, RunProgram program, std::size_t at_once, const Registry& registry,
            const std::atomic<bool>& interrupted, std::function<void(std::size_t)> waiting);

  /// Checks the pointers of the parameters, the ends of their ranges, and the targets. Returns the
  /// scene of the first trial, and what the targets ask of each run. Throws DescriptionError.
  CheckedTrials check() const;

  /// Does the runs of a trial that its folder does not have; see EvaluateTrial. Throws Interrupted, and FileError for a
  /// run that failed by other means than its numerics, and if the base has been edited.
  std::vector<TrialSample> operator()(std::size_t number, const std::vector<double>& values) const;

 private:
  std::vector<std::string> sets(const std::vector<double>& values, double seed) const;
  /// A fault of a value that the calibration sets is reported where the calibration names it.
  Scene scene(const std::vector<double>& values) const;
  /// Where the calibration names values on which no run depends, and why, with these values of the parameters.
  std::map<std::string, std::string> ignored(const std::vector<double>& values) const;
  /// Throws DescriptionError if a parameter is one of them; warns of others.
  void refuse_ignored(const std::vector<double>& first) const;
  std::vector<TrialSample> results(const std::filesystem::path& folder) const;

  const CalibrationPlace& place_;
  Description base_;  ///< as it was at first
  RunProgram program_;
  std::size_t at_once_;
  const Registry& registry_;
  const std::atomic<bool>& interrupted_;
  std::function<void(std::size_t)> waiting_;
};

/// Throws FileError if the folders of trials hold runs that grit did not begin.
void refuse_foreign_trials(const std::filesystem::path& out);

/// Removes the runs of trials; all other files stay. Throws FileError.
void remove_trials(const std::filesystem::path& out);

}  // namespace grit
