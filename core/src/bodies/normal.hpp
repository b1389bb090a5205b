// The normal distribution with the same bits on every machine.
#pragma once

namespace grit {

/// Share of a standard normal distribution that lies below z; relative error below 1e-13 for z ≥ −30.
double normal_share(double z);

/// The z below which a share p in (0, 1) lies: the inverse of normal_share(). Relative error below 2e-15, for p as
/// given. Algorithm AS 241 (PPND16): M. J. Wichura, Applied Statistics 37 (1988) 477–484, doi:10.2307/2347330.
double normal_quantile(double p);

}  // namespace grit
