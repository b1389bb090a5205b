// Evaluates the metrics of a study from the results of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/description.hpp"

namespace grit {

/// A curve with rising abscissa, or one value (x empty, one y).
struct Metric {
  std::vector<double> x, y;
  std::string unit, x_unit;
};

/// Throws FileError if the run has no such channel, or samples its abscissa at other instants; NumericsError if it has
/// no finite value, or did not reach the abscissa of a value.
Metric take_metric(const MetricDescription& metric, const std::filesystem::path& folder);

/// A curve at `x`, linearly interpolated; NaN outside.
double at(const Metric& curve, double x);

}  // namespace grit
