#include "welch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace grit {

std::vector<double> power_density(std::span<const double> values, double interval) {
  const std::size_t n = values.size();
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  std::vector<double> weighted(n);
  double weights = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double weight = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
    weighted[i] = weight * (values[i] - mean), weights += weight * weight;
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> parts;
  transform.fwd(parts, weighted);
  std::vector<double> density(n / 2 + 1);
  for (std::size_t k = 0; k < density.size(); ++k)  // all but the first and the last stand for −k too
    density[k] = (k == 0 || k == n / 2 ? 1 : 2) * std::norm(parts[k]) * interval / weights;
  return density;
}

void Welch::serialize(Archive& archive) {
  archive(values_, densities_, mean_);
  const std::size_t length = points_ / 2 + 1;
  const auto fits = [length](const std::vector<double>& one) { return one.size() == length; };
  if (mean_.size() != length || values_.size() >= points_ || densities_.size() > windows_ ||
      !std::all_of(densities_.begin(), densities_.end(), fits))
    throw Error("the saved windows have other lengths");
}

void Welch::add(double value) {
  values_.push_back(value);
  if (values_.size() < points_) return;
  densities_.push_back(power_density(values_, interval_));
  if (densities_.size() > windows_) densities_.pop_front();
  values_.erase(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(points_ / 2));
  mean_.assign(mean_.size(), 0);  // anew from all windows, so that no rounding gathers
  for (const auto& density : densities_)
    for (std::size_t k = 0; k < mean_.size(); ++k) mean_[k] += density[k];
  for (double& one : mean_) one /= static_cast<double>(densities_.size());
}

}  // namespace grit
