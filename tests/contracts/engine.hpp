// What every engine must do. A test names its cases:
//   INSTANTIATE_TEST_SUITE_P(Mine, EngineContract, testing::Values(…), engine_case_name);
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "contracts/lattice_world.hpp"
#include "grit/engine.hpp"

namespace grit {

/// An engine with its parameters set, and a world in which it acts.
struct EngineCase {
  std::string name;
  std::function<std::shared_ptr<Engine>()> make;
  std::function<FakeWorld()> world = [] { return lattice_world(6, 4, 8); };
};

inline void PrintTo(const EngineCase& one, std::ostream* out) { *out << one.name; }
inline std::string engine_case_name(const testing::TestParamInfo<EngineCase>& info) { return info.param.name; }

/// What an engine does at an instant: settings as numbers, or force and moment of each body.
inline std::vector<double> acted(const Engine& engine, const World& world) {
  std::vector<double> all;
  if (engine.phase() == Phase::settings) {
    MotionSettings settings;
    engine.settings(settings);
    all.assign(settings.gravity.begin(), settings.gravity.end());
    all.insert(all.end(), {settings.local_damping, double(settings.hold_rotation), double(settings.hold_translation),
                           double(settings.flat.value_or(-1))});
    return all;
  }
  std::vector<Row> force(world.positions().size()), moment(world.positions().size());
  engine.forces(world, force, moment);
  for (const auto* rows : {&force, &moment})
    for (const Row& row : *rows) all.insert(all.end(), {row.x, row.y, row.z});
  return all;
}

class EngineContract : public testing::TestWithParam<EngineCase> {
 protected:
  static bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  }
  FakeWorld world_ = GetParam().world();
  std::shared_ptr<Engine> engine_ = GetParam().make();
};

TEST_P(EngineContract, DocumentsItsParameters) {
  Parameters parameters;
  engine_->declare(parameters);
  std::set<std::string> names;
  for (const auto& parameter : parameters.entries()) {
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name() << " is declared twice";
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
  }
}

TEST_P(EngineContract, BeginsAsItsLike) {
  const auto other = GetParam().make();
  for (int look = 0; look < 6; ++look)
    EXPECT_TRUE(same_bits(acted(*engine_, later(world_, look)), acted(*other, later(world_, look)))) << look;
}

/// What it remembers from one step for the next must be in remember(): an engine that goes on from a checkpoint does
/// the same as the one that was not stopped.
TEST_P(EngineContract, GoesOnFromACheckpoint) {
  const int looks = 12, stops_after = 6;
  std::shared_ptr<Engine> goes_on;
  for (int look = 0; look < looks; ++look) {
    const FakeWorld now = later(world_, look);
    const auto expected = acted(*engine_, now);
    if (goes_on) ASSERT_TRUE(same_bits(acted(*goes_on, now), expected)) << "look " << look;
    if (look != stops_after) continue;
    goes_on = GetParam().make();
    restore_memory(*goes_on, saved_memory(*engine_));
    EXPECT_TRUE(saved_memory(*goes_on) == saved_memory(*engine_));
  }
}

}  // namespace grit
