// Figures with a known answer: asserted, and noted for docs/evidence/validation.md.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

namespace grit::test {

/// Expects `found` within `allowed` × `scale` of the `known` figure. scripts/validate makes a row of it; `what` says
/// what it is, with its unit, and is used once a test.
inline void verify(const std::string& what, double found, double known, double allowed, double scale) {
  EXPECT_NEAR(found, known, allowed * std::abs(scale)) << what;
  char figures[128];
  std::snprintf(figures, sizeof figures, "%.9g %.9g %.1e %.2g", known, found, (found - known) / std::abs(scale),
                allowed);
  testing::Test::RecordProperty("verified: " + what, figures);
}
/// The error is relative to the figure itself.
inline void verify(const std::string& what, double found, double known, double allowed) {
  verify(what, found, known, allowed, known);
}

/// Notes what is found beside a figure `of_others`, for docs/evidence/validation.md: by how much they differ, over
/// `scale`. Nothing is expected of that.
inline void beside(const std::string& what, double found, double of_others, double scale) {
  char figures[128];
  std::snprintf(figures, sizeof figures, "%.4g %.4g %+.2g", of_others, found, (found - of_others) / std::abs(scale));
  testing::Test::RecordProperty("beside: " + what, figures);
}

/// The largest of many errors, as one figure: `what` says over what they are.
class Errors {
 public:
  explicit Errors(std::string what) : what_(std::move(what)) {}
  void add(double error) {
    ++count_;
    if (!std::isnan(largest_) && !(std::abs(error) <= std::abs(largest_))) largest_ = error;
  }
  /// Of none at all nothing is verified.
  void verify(double allowed) const {
    EXPECT_GT(count_, 0) << what_;
    grit::test::verify(what_, largest_, 0, allowed, 1);
  }

 private:
  std::string what_;
  double largest_ = 0;
  int count_ = 0;
};

}  // namespace grit::test
