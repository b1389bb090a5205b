// Dust falling on a boulder that moves away, size ratio up to 1 : 100: no contact is missed, and few pairs are tested.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/mapped.hpp"
#include "support/touching.hpp"

namespace grit::test::mixture_tests {
namespace {

constexpr double small = 0.25e-3;

/// As many grains as fit, up to some hundred, slightly above the boulder.
std::vector<Grain> dusty_boulder(double ratio) {
  const double large = ratio * small;
  const int dust = std::min(600, static_cast<int>(1.2 * (ratio + 1) * (ratio + 1)));
  std::vector<Grain> grains{{Vec3::Zero(), large, {3, 0, 0}}};
  for (int i = 0; i < dust; ++i) {
    const double z = 1 - (2 * i + 1.0) / dust, around = 2.399963229728653 * i, gap = (i % 7) * 0.05e-3 + 1e-6;
    const Vec3 out(std::sqrt(1 - z * z) * std::cos(around), std::sqrt(1 - z * z) * std::sin(around), z);
    grains.push_back({(large + small + gap) * out, small, -0.2 * out + Vec3(i % 3 - 1, i % 5 - 2, 0)});
  }
  return grains;
}

TEST(Mixture, MissesNoContactUpToOneToAHundred) {
  for (const double ratio : {1.0, 3.0, 10.0, 30.0, 100.0}) {
    const auto grains = dusty_boulder(ratio);
    Description d = description("linear-frictional", {{"contact_modulus", 1e7}, {"restitution", 0.3}}, grains);
    d["guards"] = {{"overlap", 1e9}, {"travel", 0.2}, {"energy", 10}};
    Trial t(d);
    std::size_t compared = 0, missed = 0, looked_at = 0;
    constexpr int steps = 600;
    for (int i = 0; i < steps; ++i, t.step()) {
      const Touching all = there(t.world());
      compared += all.size(), missed += all == found(t.kernel()) ? 0 : 1;
      looked_at += t.kernel().state().pairs.candidates();
    }
    EXPECT_EQ(missed, 0u) << ratio;
    if (missed == 0) figure("ratio of sizes up to which no contact is missed", ratio);
    EXPECT_GT(compared, ratio < 10 ? 1u : 500u) << ratio;
    const double a_grain = static_cast<double>(looked_at) / steps / static_cast<double>(grains.size());
    EXPECT_LT(a_grain, 20) << ratio;
    map_point("pairs looked at, a grain|ratio of sizes", "dust on a boulder", ratio, a_grain);
  }
}

}  // namespace
}  // namespace grit::test::mixture_tests
