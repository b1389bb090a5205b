// What an error that was found between samples says of a tolerance.
#pragma once

namespace grit {

/// From the best to the worst.
enum class Confidence {
  certain,     ///< twice the standard error more would still be within the tolerance
  likely,      ///< the standard error once more would be, twice would not
  untold,      ///< the error is within the tolerance or twice the standard error, and not as above; or of one sample
  impossible,  ///< the error is beyond the tolerance, and is no scatter
};

/// Shares of one scale; NaN is the standard error of a single sample.
Confidence confidence(double error, double standard_error, double tolerance);

/// "certain", "likely", "cannot be told", "too much"
const char* word_of(Confidence confidence);

}  // namespace grit
