// The cost of a stage does not depend on the number of stages, nor that of a ramp on the number of increments.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "counted_components.hpp"
#include "support/notes.hpp"

namespace {

/// Allocations of this process: a measure of work that does not depend on the machine.
std::atomic<std::size_t> allocations{0};

}  // namespace

void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* const found = std::malloc(bytes)) return found;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

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

TEST(ManyStages, CostInProportion) {
  const auto cost = [](const Description& d) {
    const std::size_t before = allocations;
    const LiveScene live(scene_of(d));
    return static_cast<double>(allocations - before);
  };
  const Description few = with_stages(100), many = with_stages(1600);
  cost(few);  // plugins are loaded
  const double of_few = cost(few), of_many = cost(many);
  EXPECT_GT(of_few, 1000);
  EXPECT_LT(of_many, 1.1 * 16 * of_few) << "allocations of 100 stages: " << of_few << ", of 1600: " << of_many;
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
