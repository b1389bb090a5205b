// Takes from a run what a study asks for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/description.hpp"

namespace grit {

/// A curve with rising abscissa, or one value (x empty, one y).
struct Figure {
  std::vector<double> x, y;
  std::string unit, x_unit;
};

/// Throws FileError if the run has no such channel, or samples its abscissa at other instants; NumericsError if it has
/// no finite number of it, or did not reach the abscissa of a value.
Figure take_figure(const FigureDescription& figure, const std::filesystem::path& folder);

/// A curve at `x`, straight between its points; NaN outside.
double at(const Figure& curve, double x);

}  // namespace grit
