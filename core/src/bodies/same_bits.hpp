// exp and log with identical results on every machine; the last bit of those in the C library depends on its version
// and on the processor. They use only + − × ÷ and the exponent of a double, and are compiled without contraction to
// FMA.
#pragma once

namespace grit::same_bits {

/// e^x for |x| ≤ 700, relative error below 1e-15.
double exp(double x);

/// Natural logarithm of a positive, finite, normal x; error below 1e-15 relative or 1e-16 absolute.
double log(double x);

}  // namespace grit::same_bits
