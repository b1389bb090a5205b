// Figures with a known answer: asserted, and noted for docs/validation.md.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace grit::test {

/// Expects `found` within `allowed` × `scale` of the `known` figure. scripts/validate makes a row of it; `what` says
/// what it is, with its unit, and is used once a test.
inline void verify(const std::string& what, double found, double known, double allowed, double scale) {
  EXPECT_NEAR(found, known, allowed * std::abs(scale)) << what;
  char figures[128];
  std::snprintf(figures, sizeof figures, "%.9g %.9g %.1e %.0e", known, found, (found - known) / std::abs(scale),
                allowed);
  testing::Test::RecordProperty("verified: " + what, figures);
}
/// The error is relative to the figure itself.
inline void verify(const std::string& what, double found, double known, double allowed) {
  verify(what, found, known, allowed, known);
}

}  // namespace grit::test
