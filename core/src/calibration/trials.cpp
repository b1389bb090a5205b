#include "calibration/trials.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grit {

namespace {

/// Of one target that is met: two standard deviations, squared.
constexpr double most_misfit = 4;

}  // namespace

const char* word_of(TrialPurpose purpose) {
  switch (purpose) {
    case TrialPurpose::search:
      return "search";
    case TrialPurpose::design:
      return "design";
    case TrialPurpose::check:
      return "check";
  }
  return "";
}

ReadableUnit readable(const Observation& observation) {
  return readable(observation.unit, std::max(std::abs(observation.value), observation.tolerance));
}

std::string Trial::failure() const {
  for (const TrialSample& sample : samples)
    if (sample.found.empty()) return fmt::format("seed {:.0f}: {}", sample.seed, sample.failure);
  return "";
}

double Trial::core_seconds() const {
  double sum = 0;
  for (const TrialSample& sample : samples) sum += sample.core_seconds;
  return sum;
}

Trials::Trials(std::vector<ParameterDescription> parameters, std::vector<Observation> observations,
               EvaluateTrial evaluate)
    : parameters_(std::move(parameters)),
      observations_(std::move(observations)),
      evaluate_(std::move(evaluate)),
      variance_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(observations_.size()))) {}

std::size_t Trials::at(const Eigen::VectorXd& place, TrialPurpose purpose) {
  Trial trial{.purpose = purpose, .values = {}, .place = place, .samples = {}, .mean = {}};
  for (std::size_t k = 0; k < parameters_.size(); ++k) {
    double& own = trial.place[static_cast<Eigen::Index>(k)];
    trial.values.push_back(parameters_[k].value(std::clamp(own, 0.0, 1.0)));
    own = parameters_[k].place(trial.values.back());
  }
  const auto known = std::ranges::find(all_, trial.values, &Trial::values);
  if (known != all_.end()) return static_cast<std::size_t>(known - all_.begin());

  trial.samples = evaluate_(all_.size(), trial.values);
  for (TrialSample& sample : trial.samples)
    if (!std::ranges::all_of(sample.found, [](double value) { return std::abs(value) <= most_magnitude; }))
      sample.found.clear(), sample.failure = fmt::format("a target has no value of at most {:g}", most_magnitude);
  if (std::ranges::none_of(trial.samples, [](const TrialSample& sample) { return sample.found.empty(); })) {
    trial.mean = Eigen::VectorXd::Zero(variance_.size());
    for (const TrialSample& sample : trial.samples)
      trial.mean += Eigen::Map<const Eigen::VectorXd>(sample.found.data(), variance_.size());
    trial.mean /= static_cast<double>(trial.samples.size());
  }
  all_.push_back(std::move(trial));
  pool();
  return all_.size() - 1;
}

void Trials::pool() {
  variance_.setZero();
  double degrees = 0;
  for (const Trial& trial : all_) {
    if (trial.failed() || trial.samples.size() < 2) continue;
    degrees += static_cast<double>(trial.samples.size() - 1);
    for (const TrialSample& sample : trial.samples)
      variance_ += (Eigen::Map<const Eigen::VectorXd>(sample.found.data(), variance_.size()) - trial.mean).cwiseAbs2();
  }
  if (degrees > 0) variance_ /= degrees;
}

Eigen::VectorXd Trials::variance_of_mean() const {
  double samples = 1;
  for (const Trial& trial : all_) samples = std::max(samples, static_cast<double>(trial.samples.size()));
  return variance_ / samples;
}

Eigen::VectorXd Trials::uncertainty_squared() const {
  Eigen::VectorXd all = variance_of_mean();
  for (std::size_t i = 0; i < observations_.size(); ++i)
    all[static_cast<Eigen::Index>(i)] += std::pow(observations_[i].tolerance, 2);
  return all;
}

Eigen::VectorXd Trials::deviations(const Trial& trial) const {
  Eigen::VectorXd all = trial.mean;
  for (std::size_t i = 0; i < observations_.size(); ++i) all[static_cast<Eigen::Index>(i)] -= observations_[i].value;
  return all.cwiseQuotient(uncertainty_squared().cwiseSqrt());
}

Eigen::VectorXd Trials::misfits(const Trial& trial) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(targets()));
  const Eigen::VectorXd off = deviations(trial);
  for (std::size_t i = 0; i < observations_.size(); ++i)
    all[static_cast<Eigen::Index>(observations_[i].target)] +=
        observations_[i].weight * std::pow(off[static_cast<Eigen::Index>(i)], 2);
  return all;
}

double Trials::misfit(const Trial& trial) const {
  return trial.failed() ? std::numeric_limits<double>::infinity() : misfits(trial).sum();
}

bool Trials::fits(const Trial& trial) const {
  return !trial.failed() && misfits(trial).mean() <= 1 && misfits(trial).maxCoeff() <= most_misfit;
}

std::size_t Trials::best() const {
  const auto least = std::ranges::min_element(all_, {}, [this](const Trial& trial) { return misfit(trial); });
  return static_cast<std::size_t>(least - all_.begin());
}

bool Trials::all_failed() const { return std::ranges::all_of(all_, &Trial::failed); }

double Trials::core_seconds() const {
  double sum = 0;
  for (const Trial& trial : all_) sum += trial.core_seconds();
  return sum;
}

}  // namespace grit
