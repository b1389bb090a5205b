// Axes with round numbers.
#pragma once

#include <functional>
#include <vector>

namespace grit {

/// Whether a number can be drawn and be part of an axis: finite, and below 1e30 in SI units. Larger values are
/// numerical failures and would hide all others.
bool drawable(double value);

/// The step 1, 2 or 5 × 10ⁿ that divides `span` (> 0) into about `pieces`.
double nice_step(double span, int pieces);

/// Multiples of a nice step within [low, high]; about `pieces` + 1 of them.
std::vector<double> ticks(double low, double high, int pieces);

/// An axis and its ticks: multiples of a step of 1, 2 or 5 × 10ⁿ.
struct AxisTicks {
  double low, high, step;
  std::vector<double> marks;
};
enum class AxisEnds { kept, whole_steps };
/// An axis over [low, high] with 4 to 8 ticks: the finest step that `fits`, or the coarsest if none does. The ends are
/// kept or extended to whole steps, always if fewer than four ticks lie within. A range that is infinite or too narrow
/// is replaced by one around it.
AxisTicks axis_ticks(
    double low, double high, AxisEnds ends,
    const std::function<bool(const AxisTicks&)>& fits = [](const AxisTicks&) { return true; });

}  // namespace grit
