// Scales with round numbers.
#pragma once

#include <functional>
#include <vector>

namespace grit {

/// Whether a number can be drawn, and be part of a scale: finite, and below 1e30 in SI, which nothing of this field
/// reaches. A greater one is of something that has gone wrong, and would hide all others.
bool drawable(double value);

/// The steps 1, 2, 5 × 10ⁿ: the one that cuts `span` (> 0) into about `pieces`.
double nice_step(double span, int pieces);

/// Multiples of a nice step within [low, high]; about `pieces` + 1 of them.
std::vector<double> ticks(double low, double high, int pieces);

/// An axis and the multiples of its step, 1, 2 or 5 × 10ⁿ, that are marked on it.
struct AxisTicks {
  double low, high, step;
  std::vector<double> marks;
};
enum class AxisEnds { kept, whole_steps };
/// An axis over [low, high] with 4 to 8 ticks: as fine as `fits`, or, where nothing fits, as coarse as
/// four ticks are. It ends where it is told, or goes out to whole steps; it does where fewer than four lie within.
/// Where there is no such range, of infinite or too narrow ends, it has one about them.
AxisTicks axis_ticks(
    double low, double high, AxisEnds ends,
    const std::function<bool(const AxisTicks&)>& fits = [](const AxisTicks&) { return true; });

}  // namespace grit
