// Void ratio between grooved and round walls, compared with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "support/scene.hpp"

namespace grit::test::grooved_void_ratio_tests {
namespace {

constexpr double diameter = 1e-3;

/// 4 × 4 × 4 separate grains on a lattice that starts at `low`.
std::vector<Grain> grains_from(const Vec3& low) {
  std::vector<Grain> grains;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z)
        grains.push_back({low + 1.2 * diameter * Vec3(x + 0.5, y + 0.5, z + 0.5), 0.5 * diameter});
  return grains;
}

/// The volume in front of the walls that follows from the probe's void ratio of the whole specimen [m³].
double free_volume(Description d) {
  d["probes"]["void"].update({{"type", "void-ratio"}, {"every_steps", 1}});
  const Trial t(d);
  const auto probe = t.scene().description->probes.at("void").probe.make();
  probe->prepare(t.world());
  ChannelValues values("probe void", probe->channels());
  probe->sample(t.world(), values);
  return (1 + values["void_ratio"]) * 64 * std::numbers::pi / 6 * diameter * diameter * diameter;
}

Description sheet(const char* type, double z, bool up) {
  const Vec3 a(0, 4.8e-3, 0), b(4.8e-3, 0, 0);
  return {{"type", type},
          {"corner", {0, 0, z}},
          {"edge_a", vector(up ? b : a)},
          {"edge_b", vector(up ? a : b)},
          {"material", "grain"}};
}

/// Between a floor and a lid, with flat sides.
Description between(const Description& floor, const Description& lid) {
  Description d = description("linear-frictional", {{"density", 2600}}, grains_from(Vec3::Zero()));
  d["walls"]["sides"] = {{"type", "box"},  {"low", {0, 0, -5e-3}},        {"high", {4.8e-3, 4.8e-3, 1e-2}},
                         {"inside", true}, {"open", {"z_low", "z_high"}}, {"material", "grain"}};
  d["walls"]["floor"] = floor, d["walls"]["lid"] = lid;
  d["specimen"] = {{"low", {"sides", "sides", "floor"}}, {"high", {"sides", "sides", "lid"}}};
  return d;
}

TEST(GroovedVoidRatio, IsThatUpToTeethAndWaves) {
  constexpr double side = 4.8e-3, area = side * side, error = 1e-3 * diameter * area;
  const Description flat = sheet("rectangle", 4.8e-3, false);
  Description teeth = sheet("saw-tooth", 0, true), waves = sheet("sinusoidal", 0, true);
  EXPECT_NEAR(free_volume(between(sheet("rectangle", 0, true), flat)), area * side, 1e-12 * area * side);
  teeth.update({{"depth", 0.5e-3}, {"spacing", 1.6e-3}, {"floor", 0.4e-3}});
  // Three grooves with two flanks of 45° and a floor, with lands of 0.2 mm.
  const double grooves = 3 * side * 0.5e-3 * (0.4e-3 + 0.5e-3);
  EXPECT_NEAR(free_volume(between(teeth, flat)), area * side + grooves, error);
  EXPECT_GT(grooves, 100 * error);
  waves.update({{"depth", 0.6e-3}, {"wavelength", 1.2e-3}});
  EXPECT_NEAR(free_volume(between(waves, flat)), area * (side + 0.3e-3), error);
  waves["corner"] = {0, 0, 4.8e-3};
  std::swap(waves["edge_a"], waves["edge_b"]);
  EXPECT_NEAR(free_volume(between(teeth, waves)), area * (side + 0.3e-3) + grooves, 2 * error);
}

TEST(GroovedVoidRatio, IsThatInsideOfACylinderAndAFunnel) {
  constexpr double radius = 4e-3, height = 4.8e-3, error = 1e-3 * diameter;
  Description d = description("linear-frictional", {{"density", 2600}}, grains_from({-2.4e-3, -2.4e-3, 0}));
  d["walls"]["round"] = {
      {"type", "cylinder"}, {"start", {0, 0, 0}}, {"end", {0, 0, height}}, {"radius", radius}, {"material", "grain"}};
  d["walls"]["floor"] = plane({0, 0, 0}, {0, 0, 1});
  d["walls"]["lid"] = plane({0, 0, height}, {0, 0, -1});
  d["specimen"] = {{"low", {"round", "round", "floor"}}, {"high", {"round", "round", "lid"}}};
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(free_volume(d), pi * radius * radius * height, error * 2 * pi * radius * height);

  // 45°; it extends above the lid, so that the region's corners are behind it and not beyond its rim.
  constexpr double low = radius, high = radius + height;
  d["walls"]["round"] = {{"type", "cone"},
                         {"start", {0, 0, 0}},
                         {"end", {0, 0, 2 * height}},
                         {"start_radius", low},
                         {"end_radius", low + 2 * height},
                         {"material", "grain"}};
  d["probes"]["void"] = {{"region_low", {-high, -high, 0}}, {"region_high", {high, high, height}}};
  EXPECT_NEAR(free_volume(d), pi / 3 * height * (low * low + low * high + high * high),
              error * pi * (low + high) * std::hypot(height, high - low));
}

}  // namespace
}  // namespace grit::test::grooved_void_ratio_tests
