#include "calibration/calibration.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "input/document.hpp"

namespace grit {
namespace {

/// A place closer than this to an end of its range is at the bound.
constexpr double at_bound = 0.01;
/// The search begins again from the best trial while the misfit falls to this part.
constexpr double worthwhile = 0.9;

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + ' ' + unit;
}

double place_of(const Trials& trials, const CalibrationOutcome& outcome, std::size_t parameter) {
  return trials.all()[outcome.optimum].place[static_cast<Eigen::Index>(parameter)];
}

/// "raising friction_angle and lowering rolling_stiffness" of a direction with several notable components.
std::string way_text(const Direction& direction, const std::vector<std::string>& names) {
  Eigen::Index largest = 0;
  direction.along.cwiseAbs().maxCoeff(&largest);
  const double sign = direction.along[largest] > 0 ? 1 : -1;
  std::vector<std::string> up, down;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (const auto i = static_cast<Eigen::Index>(k); direction.has(i))
      (sign * direction.along[i] > 0 ? up : down).push_back(names[k]);
  std::string text = fmt::format("raising {}", fmt::join(up, " and "));
  if (!down.empty()) text += fmt::format(" and lowering {}", fmt::join(down, " and "));
  return text;
}

/// What the deviations from targets are compared with. The scatter of a single sample is unknown.
std::string limits_text(std::size_t samples) { return samples == 1 ? "tolerance" : "tolerance and scatter"; }

std::string of_direction(const Direction& direction, const std::vector<std::string>& names, std::size_t samples) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (direction.has(static_cast<Eigen::Index>(k))) parts.push_back(names[k]);
  const std::string why =
      direction.resolved ? fmt::format("has a standard error of {:.0f} % of the ranges", 100 * direction.standard_error)
      : samples == 1     ? "changes the targets by no more than the trials differ from a smooth surface"
                         : "changes the targets by no more than scatter does";
  if (parts.size() == 1)
    return fmt::format("The targets do not determine {}: {} {}.", parts.front(),
                       direction.resolved ? "it" : "changing it", why);
  return fmt::format("The targets cannot tell {} apart: {} together {}.", fmt::join(parts, " and "),
                     way_text(direction, names), why);
}

Description list(const Eigen::VectorXd& values) {
  Description all = Description::array();
  for (const double value : values) all.push_back(std::isfinite(value) ? Description(value) : Description());
  return all;
}

Description rows(const Eigen::MatrixXd& matrix) {
  Description all = Description::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) all.push_back(list(matrix.row(i).transpose()));
  return all;
}

Description to_json(const Trials& trials, const Trial& trial) {
  Description samples = Description::array();
  for (const TrialSample& sample : trial.samples) {
    samples.push_back({{"seed", sample.seed}, {"core_seconds", sample.core_seconds}, {"found", sample.found}});
    if (!sample.failure.empty()) samples.back()["failure"] = sample.failure;
  }
  const bool failed = trial.failed();
  return {{"purpose", word_of(trial.purpose)},
          {"values", trial.values},
          {"misfit", failed ? Description() : Description(trials.misfit(trial))},
          {"misfits", failed ? Description() : list(trials.misfits(trial))},
          {"mean", failed ? Description() : list(trial.mean)},
          {"samples", samples}};
}

Description to_json(const CalibrationDescription& calibration, const Trials& trials,
                    const CalibrationOutcome& outcome) {
  const Trial& best = trials.all()[outcome.optimum];
  Description parameters = Description::object(), directions = Description::array();
  std::size_t k = 0;
  for (const auto& [name, parameter] : calibration.parameters) {
    const double error =
        parameter.error_of_value(best.values[k], outcome.uncertainty.standard_error[static_cast<Eigen::Index>(k)]);
    parameters[name] = {{"value", best.values[k]},
                        {"standard_error", std::isfinite(error) ? Description(error) : Description()},
                        {"unit", parameter.unit()}};
    ++k;
  }
  for (const Direction& one : outcome.uncertainty.directions)
    directions.push_back({{"along", list(one.along)},
                          {"singular_value", one.singular_value},
                          {"resolved", one.resolved},
                          {"determined", one.is_determined()}});
  return {{"trial", outcome.optimum},
          {"met", is_met(trials, outcome)},
          {"search_ended_because", sentence_of(outcome.end)},
          {"verdict", verdict(calibration, trials, outcome)},
          {"parameters", parameters},
          {"correlation", rows(outcome.uncertainty.correlation)},
          {"covariance", rows(outcome.uncertainty.covariance)},
          {"directions", directions},
          {"jacobian", rows(outcome.uncertainty.model.jacobian)},
          {"model", outcome.uncertainty.model.quadratic ? "quadratic" : "linear"},
          {"model_trials", outcome.uncertainty.model.trials}};
}

}  // namespace

std::size_t most_further_trials(std::size_t parameters) { return 2 * parameters + 3; }

CalibrationOutcome calibrate(Trials& trials, const OptimizerDescription& optimizer) {
  CalibrationOutcome outcome;
  const std::size_t further = most_further_trials(trials.parameters().size());
  double least = std::numeric_limits<double>::infinity();
  for (double step = first_step;; step = std::max(step / 2, 2 * optimizer.resolution)) {
    outcome.end = search(trials, optimizer, step);
    if (trials.all_failed())
      throw NumericsError(
          fmt::format("all {} trials failed, the first with {}", trials.all().size(), trials.all().front().failure()));
    outcome.optimum = explore_optimum(trials, optimizer.resolution, further);
    // Scatter may have led the search astray. Or its first steps, each of one parameter, had no effect, because two act
    // only together. The trials around its optimum may show the way.
    const double misfit = trials.misfit(trials.all()[trials.best()]);
    if (outcome.end != SearchEnd::resolution || optimizer.algorithm == "crs" ||
        trials.all().size() >= static_cast<std::size_t>(optimizer.trials) ||
        trials.fits(trials.all()[outcome.optimum]) || misfit > worthwhile * least)
      break;
    least = misfit;
  }
  outcome.uncertainty = uncertainty_at(trials, outcome.optimum);
  return outcome;
}

bool is_met(const Trials& trials, const CalibrationOutcome& outcome) {
  return trials.fits(trials.all()[outcome.optimum]);
}

std::vector<std::string> parameter_texts(const CalibrationDescription& calibration, const Trials& trials,
                                         const CalibrationOutcome& outcome) {
  std::vector<std::string> texts;
  const Trial& best = trials.all()[outcome.optimum];
  std::size_t k = 0;
  for (const auto& [name, parameter] : calibration.parameters) {
    const double error = outcome.uncertainty.standard_error[static_cast<Eigen::Index>(k)];
    const std::string value = std::isfinite(error) ? fmt::format("{:.4g} ± {:.2g}", best.values[k],
                                                                 parameter.error_of_value(best.values[k], error))
                                                   : fmt::format("{:.4g}", best.values[k]);
    texts.push_back(name + ": " + with_unit(value, parameter.unit()) +
                    (std::isfinite(error) ? "" : ", not determined"));
    ++k;
  }
  return texts;
}

std::vector<std::string> target_texts(const CalibrationDescription& calibration, const Trials& trials,
                                      const CalibrationOutcome& outcome) {
  std::vector<std::string> texts;
  const Trial& best = trials.all()[outcome.optimum];
  const Eigen::VectorXd misfits = trials.misfits(best);
  std::size_t index = 0;
  for (const auto& [name, target] : calibration.targets) {
    const auto observation = std::ranges::find(trials.observations(), index, &Observation::target);
    const auto i = static_cast<Eigen::Index>(observation - trials.observations().begin());
    const std::string misfit = fmt::format("misfit {:.2g}", misfits[static_cast<Eigen::Index>(index++)]);
    const ReadableUnit shown = readable(*observation);
    const std::string unit = after_number(shown.unit);
    if (target.metric.is_curve()) {
      texts.push_back(
          fmt::format("{}: target curve ± {:.3g}{}, {}", name, shown.factor * observation->tolerance, unit, misfit));
      continue;
    }
    const std::string scatter = best.samples.size() == 1
                                    ? ""
                                    : fmt::format(" ± {:.2g}", shown.factor * std::sqrt(trials.variance_of_mean()[i]));
    texts.push_back(fmt::format("{}: {:.4g}{}{}, target {:.4g} ± {:.3g}{}, {}", name, shown.factor * best.mean[i],
                                scatter, unit, shown.factor * observation->value, shown.factor * observation->tolerance,
                                unit, misfit));
  }
  return texts;
}

std::vector<std::string> verdict(const CalibrationDescription& calibration, const Trials& trials,
                                 const CalibrationOutcome& outcome) {
  const Trial& best = trials.all()[outcome.optimum];
  const Eigen::VectorXd misfits = trials.misfits(best);
  const auto names = calibration.names();
  const std::string limits = limits_text(best.samples.size());
  std::vector<std::string> missed, bounds, all;
  std::size_t index = 0;
  for (const auto& [name, target] : calibration.targets)
    if (const double misfit = misfits[static_cast<Eigen::Index>(index++)]; misfit > 1 && !is_met(trials, outcome))
      missed.push_back(fmt::format("{} by {:.2g} times its {}", name, std::sqrt(misfit), limits));
  all.push_back(missed.empty()
                    ? fmt::format("All targets are met within {}.", limits)
                    : fmt::format("Not all targets are met. The optimum misses {}.", fmt::join(missed, ", ")));
  all.push_back(fmt::format("The search ended because {}.", sentence_of(outcome.end)));
  for (const Direction& one : outcome.uncertainty.directions)
    if (!one.is_determined()) all.push_back(of_direction(one, names, best.samples.size()));
  std::size_t k = 0;
  for (const auto& [name, parameter] : calibration.parameters) {
    const double place = place_of(trials, outcome, k++);
    if (place < at_bound || place > 1 - at_bound)
      bounds.push_back(fmt::format("{} is at the {} end of its range", name, place < at_bound ? "lower" : "upper"));
  }
  if (!bounds.empty()) all.push_back(fmt::format("{}: a wider range may fit better.", fmt::join(bounds, ", ")));
  if (best.samples.size() == 1)
    all.push_back(
        "With one sample the scatter is unknown, so that the errors lack it; take several samples to know it.");
  if (const auto failed = std::ranges::count_if(trials.all(), &Trial::failed); failed > 0)
    all.push_back(fmt::format("{} of {} failed.", failed, counted(trials.all().size(), "trial", "trials")));
  all.push_back(fmt::format("{} of {}: {} on one core.", counted(trials.all().size(), "trial", "trials"),
                            counted(best.samples.size(), "sample", "samples"), cost_text(trials.core_seconds())));
  return all;
}

Description to_json(const CalibrationDescription& calibration, const Description& written, const Trials& trials,
                    const CalibrationOutcome* outcome) {
  Description observations = Description::array(), all = Description::array();
  for (const Observation& one : trials.observations())
    observations.push_back({{"target", std::next(calibration.targets.begin(), static_cast<int>(one.target))->first},
                            {"at", std::isnan(one.at) ? Description() : Description(one.at)},
                            {"value", one.value},
                            {"tolerance", one.tolerance},
                            {"weight", one.weight},
                            {"unit", one.unit}});
  for (const Trial& trial : trials.all()) all.push_back(to_json(trials, trial));
  return {{"calibration", written},
          {"parameters", calibration.names()},
          {"observations", observations},
          {"scatter", list(trials.variance().cwiseSqrt())},
          {"core_hours", trials.core_seconds() / 3600},
          {"trials", all},
          {"optimum", outcome == nullptr ? Description() : to_json(calibration, trials, *outcome)}};
}

Description fitted_description(const CalibrationDescription& calibration, const std::filesystem::path& base,
                               const std::vector<double>& values) {
  Document fitted;
  for (const std::string& assignment : sets_of(calibration, values)) fitted.set(assignment);
  Description all = {{"extends", base.string()}};
  all.update(fitted.json());
  return all;
}

}  // namespace grit
