// A cheap stand-in for runs: formulas with scatter.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "calibration/calibration.hpp"

namespace grit {

/// What an endless number of samples would find, by observation.
using Formulas = std::function<std::vector<double>(const std::vector<double>& values)>;

/// Runs of formulas whose results scatter by seed, by values and by `world`: like grains, chaotic but repeatable.
inline EvaluateTrial stand_in(Formulas formulas, std::vector<double> scatter, int samples, std::uint64_t world) {
  return [=](std::size_t, const std::vector<double>& values) {
    std::vector<TrialSample> all;
    for (int seed = 1; seed <= samples; ++seed) {
      std::vector<std::uint32_t> bits{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(world)};
      for (const double value : values) {
        std::uint64_t own;
        std::memcpy(&own, &value, sizeof own);
        bits.push_back(static_cast<std::uint32_t>(own)), bits.push_back(static_cast<std::uint32_t>(own >> 32));
      }
      std::seed_seq sequence(bits.begin(), bits.end());
      std::mt19937_64 random(sequence);
      TrialSample sample{
          .seed = static_cast<double>(seed), .found = formulas(values), .failure = {}, .core_seconds = 2};
      for (std::size_t i = 0; i < sample.found.size(); ++i)
        sample.found[i] += scatter[i] * std::normal_distribution<double>()(random);
      all.push_back(std::move(sample));
    }
    return all;
  };
}

inline ParameterDescription parameter(double low, double high, double start, const std::string& scale = "linear") {
  ParameterDescription one;
  one.pointers = {"/x"}, one.range = {low, high}, one.start = start, one.scale = scale;
  return one;
}

/// The description that goes with trials of these parameters and targets with a value.
inline CalibrationDescription described(const std::vector<std::pair<std::string, ParameterDescription>>& parameters,
                                        const std::vector<std::pair<std::string, Observation>>& targets) {
  CalibrationDescription all;
  for (const auto& [name, one] : parameters) all.parameters[name] = one;
  for (const auto& [name, one] : targets) {
    TargetDescription& target = all.targets[name];
    target.metric.what.choose("last");
    target.value = one.value, target.tolerance = one.tolerance;
  }
  return all;
}

/// Parameters and observations in the order of their names.
inline Trials trials_of(const CalibrationDescription& calibration, EvaluateTrial evaluate) {
  std::vector<ParameterDescription> parameters;
  std::vector<Observation> observations;
  for (const auto& [name, one] : calibration.parameters) parameters.push_back(one);
  for (const auto& [name, one] : calibration.targets)
    observations.push_back(
        {.target = observations.size(), .value = one.value.get<double>(), .tolerance = one.tolerance.get<double>()});
  return {parameters, observations, std::move(evaluate)};
}

}  // namespace grit
