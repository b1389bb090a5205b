// Power spectral density by Welch's method: windows that overlap by half, weighted by Hann's, averaged.
#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "grit/archive.hpp"

namespace grit {

/// Of one window of evenly spaced values: one-sided density at the frequencies k / (n · interval), k = 0 … n/2, in the
/// value's unit squared per Hz. The mean is taken off first. n must be even.
std::vector<double> power_density(std::span<const double> values, double interval);

/// The mean density of the last windows of a signal that goes on and on.
class Welch {
 public:
  /// `points` of a window, even; `interval` between them [s]; mean over `windows` at most.
  Welch() = default;
  Welch(std::size_t points, double interval, std::size_t windows)
      : points_(points),
        windows_(windows),
        interval_(interval),
        mean_(points / 2 + 1, std::numeric_limits<double>::quiet_NaN()) {}

  void add(double value);
  /// Windows in the mean: 0 before the first is full.
  std::size_t windows() const { return densities_.size(); }
  /// points / 2 + 1 values; NaN before the first window is full.
  const std::vector<double>& mean() const { return mean_; }
  /// Throws Error if the saved windows are others.
  void serialize(Archive& archive);

 private:
  std::size_t points_ = 0, windows_ = 0;
  double interval_ = 0;
  std::vector<double> values_;                 ///< of the window that fills
  std::deque<std::vector<double>> densities_;  ///< the latest last
  std::vector<double> mean_;                   ///< of them
};

}  // namespace grit
