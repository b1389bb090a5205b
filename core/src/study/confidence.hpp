// What an error that was found between samples says of a tolerance.
#pragma once

namespace grit {

/// From the best to the worst.
enum class Confidence {
  certain,     ///< twice the standard error more would still be within the tolerance
  likely,      ///< error and standard error are within the tolerance, their sum as above is not
  untold,      ///< the scatter is beyond the tolerance, and the error no larger than it; or there was one sample
  impossible,  ///< the error is beyond the tolerance, and is no scatter
};

/// Shares of one scale; NaN is the standard error of a single sample.
Confidence confidence(double error, double standard_error, double tolerance);

}  // namespace grit
