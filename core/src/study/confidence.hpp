// Whether an error with a standard error is within a tolerance.
#pragma once

namespace grit {

/// From best to worst, for an error e with standard error s and a tolerance t.
enum class Confidence {
  certain,       ///< e + 2 s ≤ t
  likely,        ///< e + s ≤ t
  inconclusive,  ///< otherwise, if e ≤ t or e ≤ 2 s; or s unknown (one sample)
  exceeded,      ///< e > t and e > 2 s
};

/// All arguments are fractions of the same scale. The standard error of a single sample is NaN.
Confidence confidence(double error, double standard_error, double tolerance);

/// "certain", "likely", "inconclusive", "too large"
const char* word_of(Confidence confidence);

}  // namespace grit
