#include "study/confidence.hpp"

#include <cmath>

namespace grit {

Confidence confidence(double error, double standard_error, double tolerance) {
  if (std::isnan(error) || std::isnan(standard_error)) return Confidence::untold;
  if (error + 2 * standard_error <= tolerance) return Confidence::certain;
  if (error <= tolerance) return standard_error <= tolerance ? Confidence::likely : Confidence::untold;
  return error <= 2 * standard_error ? Confidence::untold : Confidence::impossible;
}

}  // namespace grit
