// Invariants of stress.
#pragma once

#include <cmath>

#include "grit/world.hpp"

namespace grit {

inline Mat3 symmetric_part(const Mat3& stress) { return 0.5 * (stress + stress.transpose()); }

/// q = √(3/2 s : s) ≥ 0 with the deviator s of the symmetric part; same unit as the stress.
inline double deviatoric_stress(const Mat3& stress) {
  const Mat3 symmetric = symmetric_part(stress);
  const Mat3 deviator = symmetric - symmetric.trace() / 3 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

}  // namespace grit
