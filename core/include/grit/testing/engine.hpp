// Tests that every engine must pass. A plugin's test lists its cases:
//   INSTANTIATE_TEST_SUITE_P(Mine, EngineContract, testing::Values(…), engine_case_name);
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "grit/engine.hpp"
#include "grit/testing/lattice_world.hpp"

namespace grit {

/// An engine with its parameters set, and a world in which it acts.
struct EngineCase {
  std::string name;
  std::function<std::shared_ptr<Engine>()> make;
  std::function<FakeWorld()> world = [] { return lattice_world(6, 4, 8); };
};

inline void PrintTo(const EngineCase& one, std::ostream* out) { *out << one.name; }
inline std::string engine_case_name(const testing::TestParamInfo<EngineCase>& info) { return info.param.name; }

/// The effect of an engine at one instant: its settings as numbers, or the force and moment on each body.
inline std::vector<double> acted(const Engine& engine, const World& world) {
  std::vector<double> all;
  if (engine.phase() == Phase::settings) {
    MotionSettings settings;
    engine.settings(settings);
    all.assign(settings.gravity.begin(), settings.gravity.end());
    const RigidMotion motion = settings.prescribed.value_or(RigidMotion{});
    for (const Vec3& v : {settings.constrained_translation(), settings.constrained_rotation(), motion.velocity,
                          motion.spin, motion.about})
      all.insert(all.end(), v.begin(), v.end());
    all.insert(all.end(), {settings.local_damping, double(settings.flat.value_or(-1))});
    return all;
  }
  if (engine.phase() == Phase::removal) {
    for (const Row& x : world.positions()) all.push_back(engine.removes(world, xyz(x)));
    return all;
  }
  std::vector<Row> force(world.positions().size()), moment(world.positions().size());
  engine.forces(world, force, moment);
  for (const auto* rows : {&force, &moment})
    for (const Row& row : *rows) all.insert(all.end(), {row.x, row.y, row.z});
  return all;
}

/// What every engine must fulfil.
class EngineContract : public testing::TestWithParam<EngineCase> {
 protected:
  static bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  }
  FakeWorld world_ = GetParam().world();
  std::shared_ptr<Engine> engine_ = GetParam().make();
};

/// Links the tests into a program that includes this file.
int engine_contract();
inline const int engine_contract_is_linked = engine_contract();

}  // namespace grit
