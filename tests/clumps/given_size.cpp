// Clumps in the size in which their shape was given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "grit/error.hpp"
#include "support/clump.hpp"
#include "support/own_folder.hpp"

namespace grit::test::given_size_tests {
namespace {

/// Two unit spheres, 1 apart: enclosed by a sphere of radius 1.5.
constexpr const char* pair_of_spheres = "# x y z r\n0 0 0 1\n1 0 0 1\n";

Description cloud_of(const Description& kind) {
  Description d = description("linear-rolling", {{"density", 2000}, {"contact_modulus", 1e6}}, {});
  Description& grains = d["bodies"]["grains"];
  grains.update(kind);
  grains["source"] = Description::parse(R"({"type": "cloud", "low": [0, 0, 0], "high": [0.1, 0.1, 0.1], "count": 4,
                                            "sizes": {"type": "shape"}})");
  return d;
}

void expect_pairs(const Description& d, double unit) {
  const Trial trial(d);
  ASSERT_EQ(trial.world().clumps().size(), 4u);
  const double volume = 27.0 / 12 * std::numbers::pi * unit * unit * unit;  // of two unit spheres 1 apart
  for (const ClumpView& clump : trial.world().clumps()) {
    EXPECT_NEAR(clump.radius, 1.5 * unit, 1e-12 * unit);
    EXPECT_NEAR(clump.mass, 2000 * volume, 1e-4 * clump.mass);
  }
  for (const Row& sphere : trial.world().positions()) EXPECT_NEAR(sphere.w, unit, 1e-12 * unit);
}

TEST(GivenSize, OfAFileIsInItsUnit) {
  const OwnFolder folder;
  const std::string path = folder.write("pair.txt", pair_of_spheres).string();
  const auto of_scale = [&](const Description& scale) -> Description {
    return {{"type", "clump"}, {"shape", {{"type", "file"}, {"path", path}, {"scale", scale}}}};
  };
  expect_pairs(cloud_of(of_scale("1 mm")), 1e-3);
  expect_pairs(cloud_of(of_scale("2 mm")), 2e-3);
}

TEST(GivenSize, OfAListIsInMetres) {
  expect_pairs(cloud_of({{"type", "clump"}, {"shape", listed({ball({0, 0, 0}, 1e-3), ball({1e-3, 0, 0}, 1e-3)})}}),
               1e-3);
}

TEST(GivenSize, IsNotThatOfSpheresAndProportions) {
  const auto message = [](const Description& d) -> std::string {
    try {
      Trial trial(d);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const auto wanted = testing::HasSubstr(
      "sizes of type shape: these bodies have no size of their own; use a clump whose shape is a list or a file");
  EXPECT_THAT(message(cloud_of({{"type", "sphere"}})), wanted);
  EXPECT_THAT(message(cloud_of({{"type", "clump"}, {"shape", {{"type", "rod"}}}})), wanted);
}

}  // namespace
}  // namespace grit::test::given_size_tests
