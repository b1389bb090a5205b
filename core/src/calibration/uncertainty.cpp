#include "calibration/uncertainty.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace grit {
namespace {

/// Trials count as near a centre up to this part of each range. Within it a linear model has to do.
constexpr double near = 0.3;
/// Distance of added trials from the centre: far enough for an effect beyond scatter.
constexpr double design_step = 0.2;
/// Distance of trials added where scatter hides an effect.
constexpr double far_step = 0.9 * near;
/// A singular value counts if it exceeds that of scatter so many times.
constexpr double significance = 2;
/// A slope is known by itself unless those of other parameters, with which the trials change this one, raise its
/// variance beyond this factor.
constexpr double most_inflation = 4;
/// Standard error along a direction, as a part of the ranges, from which the targets do not determine it.
constexpr double spanning = 0.5;
/// Components of a unit vector below this are left out of account.
constexpr double slight = 0.15;
/// Components of a resolved direction above this are named.
constexpr double notable = 0.3;
/// Trials beyond the number of terms from which a quadratic model is fitted; it is taken unless its slopes scatter by
/// so much more, as where most trials lie close together.
constexpr Eigen::Index spare_trials = 2;
constexpr double most_loss = 2;
/// Smallest singular value that is inverted.
constexpr double least_singular_value = 1e-6;

std::vector<const Trial*> neighbours(const Trials& trials, std::size_t centre) {
  std::vector<const Trial*> all;
  for (const Trial& trial : trials.all())
    if (!trial.failed() && (trial.place - trials.all()[centre].place).lpNorm<Eigen::Infinity>() <= near)
      all.push_back(&trial);
  return all;
}

/// Places of trials about their mean, one a row.
Eigen::MatrixXd spread(const std::vector<const Trial*>& trials) {
  Eigen::MatrixXd places(static_cast<Eigen::Index>(trials.size()), trials.front()->place.size());
  for (std::size_t i = 0; i < trials.size(); ++i)
    places.row(static_cast<Eigen::Index>(i)) = trials[i]->place.transpose();
  return places.rowwise() - places.colwise().mean();
}

double square(double value) { return value * value; }

/// Square roots of the weights of the observations' squared deviations.
Eigen::VectorXd root_weights(const Trials& trials) {
  Eigen::VectorXd weights = trials.uncertainty_squared().cwiseInverse();
  for (std::size_t i = 0; i < trials.observations().size(); ++i)
    weights[static_cast<Eigen::Index>(i)] *= trials.observations()[i].weight;
  return weights.cwiseSqrt();
}

/// The misfit that scatter alone causes at the true values.
double misfit_by_scatter(const Trials& trials) {
  return root_weights(trials).cwiseAbs2().dot(trials.variance_of_mean());
}

/// A place at a distance from the centre that no trial has; nothing if all such places are taken.
std::optional<Eigen::VectorXd> new_place(const Trials& trials, std::size_t centre, const Eigen::VectorXd& along,
                                         double size) {
  const Eigen::VectorXd& from = trials.all()[centre].place;
  std::optional<Eigen::VectorXd> farthest;
  for (const double step : {size, -size, 0.5 * size, -0.5 * size}) {
    const Eigen::VectorXd place = (from + step * along).cwiseMax(0).cwiseMin(1);
    const bool taken = std::ranges::any_of(trials.all(), [&](const Trial& trial) {
      return (trial.place - place).lpNorm<Eigen::Infinity>() < 0.1 * design_step;
    });
    if (!taken && (!farthest || (place - from).norm() > 1.1 * (*farthest - from).norm())) farthest = place;
  }
  return farthest;
}

/// The place next to be tried so that the neighbours show the effect of every parameter; nothing if they do. Trials
/// farther away show what scatter hides.
std::optional<Eigen::VectorXd> design_place(const Trials& trials, std::size_t centre) {
  const auto near_ones = neighbours(trials, centre);
  const Eigen::Index count = trials.all()[centre].place.size();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(spread(near_ones), Eigen::ComputeFullV);
  const auto size = [&](Eigen::Index k) { return k < svd.singularValues().size() ? svd.singularValues()[k] : 0.0; };
  if (size(count - 1) < design_step || static_cast<Eigen::Index>(near_ones.size()) < count + 2) {
    for (Eigen::Index k = count - 1; k >= 0; --k)
      if (const auto place = new_place(trials, centre, svd.matrixV().col(k), design_step)) return place;
    return std::nullopt;
  }
  for (const Direction& one : uncertainty_at(trials, centre).directions)
    if (!one.resolved)
      if (const auto place = new_place(trials, centre, one.along, far_step)) return place;
  return std::nullopt;
}

/// Terms of a polynomial of so many variables.
Eigen::Index terms_of(Eigen::Index count, bool quadratic) {
  return 1 + count + (quadratic ? count * (count + 1) / 2 : 0);
}

LocalModel fitted_model(const Trials& trials, std::size_t centre, const std::vector<const Trial*>& near_ones,
                        bool quadratic) {
  const auto rows = static_cast<Eigen::Index>(near_ones.size());
  const Eigen::Index count = trials.all()[centre].place.size(), terms = terms_of(count, quadratic);
  LocalModel model;
  model.trials = near_ones.size();
  model.quadratic = quadratic;
  Eigen::MatrixXd factors = Eigen::MatrixXd::Zero(rows, terms), found(rows, trials.variance().size());
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Trial& trial = *near_ones[static_cast<std::size_t>(i)];
    const Eigen::VectorXd from_centre = trial.place - trials.all()[centre].place;
    factors(i, 0) = 1;
    factors.row(i).segment(1, count) = from_centre.transpose();
    if (model.quadratic)
      for (Eigen::Index a = 0, term = 1 + count; a < count; ++a)
        for (Eigen::Index b = a; b < count; ++b) factors(i, term++) = from_centre[a] * from_centre[b];
    found.row(i) = trial.mean.transpose();
  }
  const Eigen::MatrixXd solution = factors.completeOrthogonalDecomposition().solve(found);
  model.at_centre = solution.row(0).transpose();
  model.jacobian = solution.middleRows(1, count).transpose();
  // Where the trials do not vary, the slopes are unknown.
  const Eigen::MatrixXd normal =
      factors.transpose() * factors + square(least_singular_value) * Eigen::MatrixXd::Identity(terms, terms);
  model.slope_covariance =
      normal.ldlt().solve(Eigen::MatrixXd::Identity(terms, terms)).block(1, 1, count, count).eval();
  model.noise = trials.variance_of_mean();
  if (rows > terms)
    model.noise = model.noise.cwiseMax((found - factors * solution).colwise().squaredNorm().transpose() /
                                       static_cast<double>(rows - terms));
  return model;
}

/// Parameters whose effect on the targets exceeds that of scatter, alone or with others, and those without: the slopes
/// of the latter are scatter, by which the others would seem to be correlated with them.
std::pair<std::vector<Eigen::Index>, std::vector<Eigen::Index>> acting_and_idle(const Eigen::MatrixXd& slopes,
                                                                                const Eigen::MatrixXd& covariance,
                                                                                double noise) {
  std::vector<Eigen::Index> acting, idle;
  const Eigen::VectorXd inflation = covariance.diagonal().cwiseProduct(covariance.inverse().diagonal());
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    const bool shows = slopes.col(k).norm() > significance * std::sqrt(noise * covariance(k, k));
    (shows || inflation[k] > most_inflation ? acting : idle).push_back(k);
  }
  return {acting, idle};
}

/// Where the model expects the least misfit, by the directions that the targets determine.
Eigen::VectorXd expected_optimum(const Trials& trials, std::size_t centre, const Uncertainty& known) {
  Eigen::VectorXd lacking = -known.model.at_centre;
  for (std::size_t i = 0; i < trials.observations().size(); ++i)
    lacking[static_cast<Eigen::Index>(i)] += trials.observations()[i].value;
  const Eigen::VectorXd weights = root_weights(trials);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(trials.all()[centre].place.size());
  for (const Direction& one : known.directions) {
    if (!one.is_determined()) continue;
    const Eigen::VectorXd change = weights.cwiseProduct(known.model.jacobian * one.along);
    step += one.along * change.dot(weights.cwiseProduct(lacking)) / change.squaredNorm();
  }
  if (const double size = step.lpNorm<Eigen::Infinity>(); size > near) step *= near / size;
  return (trials.all()[centre].place + step).cwiseMax(0).cwiseMin(1);
}

}  // namespace

bool Direction::has(Eigen::Index parameter) const { return std::abs(along[parameter]) > (resolved ? notable : slight); }

bool Direction::is_determined() const { return resolved && standard_error < spanning; }

LocalModel local_model(const Trials& trials, std::size_t centre) {
  const auto near_ones = neighbours(trials, centre);
  LocalModel linear = fitted_model(trials, centre, near_ones, false);
  if (static_cast<Eigen::Index>(near_ones.size()) < terms_of(linear.jacobian.cols(), true) + spare_trials)
    return linear;
  LocalModel quadratic = fitted_model(trials, centre, near_ones, true);
  const Eigen::VectorXd weights = root_weights(trials).cwiseAbs2();
  const auto slope_scatter = [&](const LocalModel& model) {
    return weights.dot(model.noise) * model.slope_covariance.trace();
  };
  return slope_scatter(quadratic) <= most_loss * slope_scatter(linear) ? quadratic : linear;
}

Uncertainty uncertainty_at(const Trials& trials, std::size_t centre) {
  Uncertainty known{.model = local_model(trials, centre),
                    .directions = {},
                    .standard_error = {},
                    .covariance = {},
                    .correlation = {}};
  const Eigen::VectorXd weights = root_weights(trials);
  const Eigen::MatrixXd slopes = weights.asDiagonal() * known.model.jacobian;
  const Eigen::Index count = slopes.cols();
  const double noise = weights.cwiseAbs2().dot(known.model.noise);
  const auto [acting, idle] = acting_and_idle(slopes, known.model.slope_covariance, noise);
  using Svd = Eigen::JacobiSVD<Eigen::MatrixXd>;
  const Svd svd = acting.empty() ? Svd() : Svd(slopes(Eigen::all, acting), Eigen::ComputeFullV);
  known.covariance = Eigen::MatrixXd::Zero(count, count);
  known.standard_error = Eigen::VectorXd::Zero(count);
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(acting.size()); ++k) {
    Direction one;
    one.along = Eigen::VectorXd::Zero(count);
    one.along(acting) = svd.matrixV().col(k);
    one.singular_value = k < svd.singularValues().size() ? svd.singularValues()[k] : 0;
    const double inverse = 1 / std::max(one.singular_value, least_singular_value);
    // Slopes that are zero would appear as large as this by scatter alone.
    const double by_scatter = std::sqrt(noise * one.along.dot(known.model.slope_covariance * one.along));
    one.resolved = one.singular_value > std::max(significance * by_scatter, least_singular_value);
    one.standard_error = one.resolved ? inverse : std::numeric_limits<double>::infinity();
    known.covariance += square(inverse) * one.along * one.along.transpose();
    for (Eigen::Index i = 0; i < count; ++i)
      if (one.resolved || one.has(i)) known.standard_error[i] += square(one.along[i] * one.standard_error);
    known.directions.push_back(std::move(one));
  }
  known.standard_error = known.standard_error.cwiseSqrt();
  const Eigen::VectorXd errors = known.covariance.diagonal().cwiseSqrt();
  known.correlation = known.covariance.cwiseQuotient(errors * errors.transpose());
  for (const Eigen::Index k : idle) {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    known.directions.push_back({.along = Eigen::VectorXd::Unit(count, k),
                                .singular_value = 0,
                                .standard_error = unbounded,
                                .resolved = false});
    known.standard_error[k] = known.covariance(k, k) = unbounded;
    known.correlation.row(k).setZero(), known.correlation.col(k).setZero();
    known.correlation(k, k) = 1;
  }
  return known;
}

std::size_t explore_optimum(Trials& trials, double resolution, std::size_t most) {
  const std::size_t last = trials.all().size() + most;
  std::size_t centre = trials.best();
  for (bool settled = false;;) {
    while (trials.all().size() < last) {
      const auto place = design_place(trials, centre);
      if (!place) break;
      trials.at(*place, TrialPurpose::design);
    }
    // A trial of the design may be far better.
    if (const std::size_t best = trials.best();
        trials.misfit(trials.all()[centre]) - trials.misfit(trials.all()[best]) > misfit_by_scatter(trials)) {
      centre = best;
      if (trials.all().size() < last) continue;
    }
    if (settled || trials.all().size() >= last) return centre;
    const Eigen::VectorXd expected = expected_optimum(trials, centre, uncertainty_at(trials, centre));
    // Targets with narrow tolerances may be met closer by than the resolution of the search.
    const bool fits = trials.fits(trials.all()[centre]);
    if (fits && (expected - trials.all()[centre].place).lpNorm<Eigen::Infinity>() < resolution) return centre;
    const std::size_t index = trials.at(expected, TrialPurpose::check);
    if (index == centre) return centre;
    const Trial& check = trials.all()[index];
    const double gain = trials.misfit(trials.all()[centre]) - trials.misfit(check),
                 by_scatter = misfit_by_scatter(trials);
    if (gain < -by_scatter || (fits && !trials.fits(check))) return centre;
    settled = gain < by_scatter;
    centre = index;
  }
}

}  // namespace grit
