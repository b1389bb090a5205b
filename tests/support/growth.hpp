// The longest stable time step of a scene, found by letting it tremble.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "grit/error.hpp"
#include "support/scene.hpp"

namespace grit::test {

inline Description at_step(Description d, double dt) {
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"energy", 1e9}, {"travel", 1}, {"overlap", 1}};
  return d;
}

/// The largest speed of a body or of its surface as it turns, after so many steps, over the one at the start; it ends
/// at a growth of 1e6.
inline double growth(Trial& t, int steps) {
  const auto fastest = [&] {
    double fastest = 0;
    for (const Row& v : t.world().velocities()) fastest = std::max(fastest, xyz(v).norm());
    for (std::size_t i = 0; i < t.world().spins().size(); ++i)
      fastest = std::max(fastest, xyz(t.world().spins()[i]).norm() * t.world().positions()[i].w);
    return fastest;
  };
  const double before = fastest();
  double largest = 0;
  try {
    for (int done = 0; done < steps; done += 10) {
      t.step(10);
      largest = std::max(largest, fastest());
      if (largest > 1e6 * before) break;  // still far from opening a contact
    }
  } catch (const NumericsError&) {  // a guard saw it first
    return std::numeric_limits<double>::infinity();
  }
  return largest / before;
}
inline double growth(const Description& d, double dt, int steps) {
  Trial t(at_step(d, dt));
  return growth(t, steps);
}

/// The step [s] above which grit says that the scene is not stable.
inline double critical(Description d) {
  d["time_step"] = {{"value", 1e-9}};
  return Trial(d).kernel().critical_time_step();
}

/// A mode that is known to be the fastest starts to grow between 0.5 % below and 0.5 % above this step.
inline void expect_limit(const Description& d, double limit) {
  EXPECT_LT(growth(d, 0.995 * limit, 4000), 20) << "stable below";
  EXPECT_GT(growth(d, 1.005 * limit, 4000), 1e6) << "unstable above";
}

/// The step [s] at which a mode of λ² = `spring` and damping rate `dashpot` starts to grow: 4 = 2 dt D + dt² Q.
inline double limit_of(double spring, double dashpot) {
  return (std::sqrt(dashpot * dashpot + 4 * spring) - dashpot) / spring;
}

/// By halving from both sides of `guess` [s], to 0.1 %.
inline double found_limit(const Description& d, double guess) {
  const auto grows = [&](double dt) { return growth(d, dt, 4000) > 1e3; };
  double low = guess / 1.02, high = guess * 1.02;
  while (grows(low)) low /= 1.5;
  while (!grows(high)) high *= 1.5;
  while (high > 1.001 * low) {
    const double middle = std::sqrt(low * high);
    (grows(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace grit::test
