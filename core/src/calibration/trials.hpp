// The trials of a calibration: places in the space of the parameters, and how well the runs there meet the targets.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "calibration/description.hpp"
#include "format/symbols.hpp"

namespace grit {

/// A number that a run is to meet: a target, or a point of a target that is a curve.
struct Observation {
  std::size_t target = 0;                                ///< index in the order of names
  double at = std::numeric_limits<double>::quiet_NaN();  ///< abscissa of the point of a curve
  double value = 0, tolerance = 1;
  double weight = 1;      ///< those of the points of a curve add up to 1: it counts as one target
  std::string unit = "";  ///< of value and tolerance; empty if it is not known
};

/// A unit in which the numbers of an observation are read easily.
ReadableUnit readable(const Observation& observation);

/// One run of a trial.
struct TrialSample {
  double seed = 0;
  std::vector<double> found;  ///< by observation; empty if the run failed
  std::string failure;        ///< why
  double core_seconds = 0;
};

enum class TrialPurpose {
  search,  ///< a step of the optimiser
  design,  ///< around the optimum, for its uncertainty
  check,   ///< where the local model expects the optimum
};
const char* word_of(TrialPurpose purpose);

struct Trial {
  TrialPurpose purpose = TrialPurpose::search;
  std::vector<double> values;  ///< of the parameters, in the units of the description
  Eigen::VectorXd place;       ///< 0 to 1 in each range
  std::vector<TrialSample> samples;
  Eigen::VectorXd mean;  ///< over the samples, by observation; empty if a sample failed

  bool failed() const { return mean.size() == 0; }
  /// "seed 2: …" of the first failed sample.
  std::string failure() const;
  double core_seconds() const;
};

/// Runs the samples of a trial, of which `number` counts from 0. Samples with a NaN or a number beyond most_magnitude
/// count as failed.
using EvaluateTrial = std::function<std::vector<TrialSample>(std::size_t number, const std::vector<double>& values)>;

/// Trials in their order; each place is evaluated once.
class Trials {
 public:
  Trials(std::vector<ParameterDescription> parameters, std::vector<Observation> observations, EvaluateTrial evaluate);

  /// The trial at a place, which is evaluated unless it has been. Returns its index. Passes on what the evaluation
  /// throws.
  std::size_t at(const Eigen::VectorXd& place, TrialPurpose purpose);

  const std::vector<ParameterDescription>& parameters() const { return parameters_; }
  const std::vector<Observation>& observations() const { return observations_; }
  std::size_t targets() const { return observations_.back().target + 1; }
  const std::vector<Trial>& all() const { return all_; }

  /// Variance of each observation between samples, pooled over all trials: a scatter that is small by chance gives no
  /// trial a large weight. 0 with one sample each, whose scatter is unknown.
  const Eigen::VectorXd& variance() const { return variance_; }
  /// Variance of the mean over a trial's samples.
  Eigen::VectorXd variance_of_mean() const;
  /// Variance of the difference between a trial and its targets: tolerance² + scatter²/samples.
  Eigen::VectorXd uncertainty_squared() const;
  /// (found − target) over the square root of that. Not for failed trials.
  Eigen::VectorXd deviations(const Trial& trial) const;
  /// Mean square of a target's deviations, by target.
  Eigen::VectorXd misfits(const Trial& trial) const;
  /// Sum of the misfits; infinite for failed trials.
  double misfit(const Trial& trial) const;
  /// Whether the misfits are at most 1 in the mean, and none is above 4: a better fit would not show.
  bool fits(const Trial& trial) const;
  /// Index of the trial with the least misfit. There must be one that has not failed.
  std::size_t best() const;
  bool all_failed() const;
  double core_seconds() const;

 private:
  void pool();

  std::vector<ParameterDescription> parameters_;
  std::vector<Observation> observations_;
  EvaluateTrial evaluate_;
  std::vector<Trial> all_;
  Eigen::VectorXd variance_;
};

}  // namespace grit
