// The cost of a stage does not depend on the number of stages, nor that of a ramp on the number of increments.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>

#include "counted_components.hpp"
#include "support/notes.hpp"

namespace grit::test {
namespace {

/// Stages that change everything that a stage may change.
Description with_stages(int count) {
  Description d = counted();
  for (int i = 0; i < count; ++i) {
    Description stage = stage_of("stage " + std::to_string(i), 1);
    stage["change"] = {{"walls", {{"square", {{"height", 1e-3 * i}, {"motion", {{"velocity", {0, 0, 1e-3 * i}}}}}}}},
                       {"engines", {{"tally", {{"strength", i}}}}},
                       {"materials", {{"grain", {{"friction_angle", 1e-4 * i}}}}},
                       {"guards", {{"overlap", 0.2 + 1e-4 * i}}}};
    stage["ramps"] = Description::array({ramp_of("/engines/tally/strength", i, i + 1, 1, 100)});
    d["stages"].push_back(std::move(stage));
  }
  return d;
}

/// CPU time of this process [s].
double used() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

TEST(ManyStages, CostInProportion) {
  const auto cost = [](const Description& d) {
    const double before = used();
    const LiveScene live(scene_of(d));
    return used() - before;
  };
  const Description few = with_stages(100), many = with_stages(1600);
  cost(few);  // plugins are loaded
  const double of_few = cost(few), of_many = cost(many);
  EXPECT_LT(of_many, 2.5 * 16 * of_few) << "of 100 stages: " << of_few << " s, of 1600: " << of_many << " s";
}

TEST(ManyIncrements, MakeNoComponentsAndTakeNoMemory) {
  Description d = counted();
  d["stages"] = Description::array({stage_of("rising", 2100)});
  constexpr std::int64_t increments = 100000;
  d["stages"][0]["ramps"] = Description::array({ramp_of("/engines/tally/strength", 0, 1, 1000e-6, increments),
                                                ramp_of("/walls/square/motion/velocity/2", 0, 1, 1000e-6, increments)});
  counts() = {};
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  const Done done = run(d);
  getrusage(RUSAGE_SELF, &after);
  ASSERT_EQ(done.summary().status, "done") << done.summary().message;
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 20000) << "kB, for 200 000 increments";
  EXPECT_LT(counts().engines, 10) << "to read them, and one to run";
  EXPECT_EQ(counts().prepared, 1);
  EXPECT_EQ(live_of(*done.simulation).now().walls.at("square").motion.velocity.z(), 1);
}

}  // namespace
}  // namespace grit::test
