// What the trials near the optimum say about the parameters: errors, correlations, and what the targets cannot tell
// apart.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "calibration/trials.hpp"

namespace grit {

/// Least squares over the trials near a centre: observations as functions of the place.
struct LocalModel {
  Eigen::VectorXd at_centre;         ///< by observation
  Eigen::MatrixXd jacobian;          ///< observations × parameters; per range of a parameter
  Eigen::MatrixXd slope_covariance;  ///< of the slopes of an observation with variance 1
  Eigen::VectorXd noise;             ///< variance of each observation about the model
  std::size_t trials = 0;
  bool quadratic = false;
};

/// A principal direction in the space of places.
struct Direction {
  Eigen::VectorXd along;       ///< unit vector
  double singular_value = 0;   ///< change of the deviations for a unit step
  double standard_error = 0;   ///< of the place along it
  bool resolved = true;        ///< whether the change exceeds what scatter would show without one
  bool is_determined() const;  ///< resolved, and known to better than half of the ranges
  /// Whether a parameter takes part in it. If it is not resolved, a smaller part is enough to leave the parameter
  /// unknown.
  bool has(Eigen::Index parameter) const;
};

struct Uncertainty {
  LocalModel model;
  std::vector<Direction> directions;  ///< the best known first
  Eigen::VectorXd standard_error;     ///< of the places; infinite for parameters that are not determined
  Eigen::MatrixXd covariance;         ///< (Jᵀ W J)⁻¹ of the places; without effect: infinite, and no covariance
  Eigen::MatrixXd correlation;
};

/// The model about a trial that has not failed: linear, or quadratic with enough trials.
LocalModel local_model(const Trials& trials, std::size_t centre);

Uncertainty uncertainty_at(const Trials& trials, std::size_t centre);

/// Adds trials about the best one until its neighbours show the effect of every parameter, and tries where the model
/// expects a better place; at most so many of both. Returns the index of the optimum: the model's place, whose
/// neighbours average the scatter, unless it is worse by more than scatter explains.
std::size_t explore_optimum(Trials& trials, double resolution, std::size_t most);

}  // namespace grit
