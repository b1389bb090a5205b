// The normal distribution, with identical results on every machine.
#pragma once

namespace grit {

/// Cumulative standard normal distribution: the fraction below z; relative error below 1e-13 for z ≥ −30.
double normal_fraction(double z);

/// Quantile of the standard normal distribution for p in (0, 1), the inverse of normal_fraction(). Relative error below
/// 2e-15. Algorithm AS 241 (PPND16): M. J. Wichura, Applied Statistics 37 (1988) 477–484, doi:10.2307/2347330.
double normal_quantile(double p);

}  // namespace grit
