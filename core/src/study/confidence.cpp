#include "study/confidence.hpp"

#include <algorithm>
#include <cmath>

namespace grit {

Confidence confidence(double error, double standard_error, double tolerance) {
  if (std::isnan(error) || std::isnan(standard_error)) return Confidence::inconclusive;
  if (error + 2 * standard_error <= tolerance) return Confidence::certain;
  if (error + standard_error <= tolerance) return Confidence::likely;
  return error <= std::max(tolerance, 2 * standard_error) ? Confidence::inconclusive : Confidence::exceeded;
}

const char* word_of(Confidence confidence) {
  switch (confidence) {
    case Confidence::certain:
      return "certain";
    case Confidence::likely:
      return "likely";
    case Confidence::inconclusive:
      return "inconclusive";
    case Confidence::exceeded:
      return "too large";
  }
  return "";
}

}  // namespace grit
