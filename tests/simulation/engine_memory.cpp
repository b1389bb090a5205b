// The state of an engine is kept in ramps and stages, also in a run resumed from a checkpoint.
#include <gtest/gtest.h>

#include "counted_components.hpp"
#include "support/notes.hpp"
#include "support/tape.hpp"

namespace grit::test {
namespace {

/// 40 steps with a strength of 1, then 40 in which it increases in 10 increments from 1 to 11, then 20 with 3.
Description tallied() {
  Description d = counted();
  d["stages"] = Description::array({stage_of("steady", 40), stage_of("rising", 40), stage_of("changed", 20)});
  d["stages"][1]["ramps"] = Description::array({ramp_of("/engines/tally/strength", 1, 11, 40e-6, 10)});
  d["stages"][2]["change"] = {{"engines", {{"tally", {{"strength", 3}}}}}};
  return d;
}

/// The same sum by hand, over calls from before the first step to after the last.
double expected_sum() {
  double sum = 0;
  for (int step = 0; step <= 100; ++step) {
    const int done = std::min(10, std::max(0, (step - 40) / 4));
    sum += step < 80 ? 1.0 + done : 3.0;
  }
  return sum;
}

TEST(EngineState, IsKeptInRampsAndStages) {
  const Done done = run(tallied());
  ASSERT_EQ(done.summary().status, "done") << done.summary().message;
  const auto& tally = dynamic_cast<const Tally&>(*live_of(*done.simulation).components().engines.at("tally"));
  EXPECT_GE(tally.calls, 101) << "at each step, and at the start of stages";
  EXPECT_LE(tally.calls, 104);
  EXPECT_NEAR(tally.sum, expected_sum(), 20) << "the instant between two stages may be evaluated twice";
}

TEST(EngineState, IsKeptInARestartInEachStage) {
  Taped whole(tallied(), 1);
  const auto tally_of = [](Taped& taped) -> const Tally& {
    return dynamic_cast<const Tally&>(*live_of(taped.simulation).components().engines.at("tally"));
  };
  const std::int64_t calls = tally_of(whole).calls;
  const double sum = tally_of(whole).sum;
  for (const std::uint64_t stop : {24u, 56u, 64u, 88u}) {
    Taped first(tallied(), 1, [&](const Kernel& now) { return now.world().step() >= stop; });
    ASSERT_EQ(first.tape.summary.status, "interrupted") << stop;
    ASSERT_FALSE(first.tape.checkpoints.empty());
    Taped rest(tallied(), 1, {}, &first.tape.checkpoints.back());
    EXPECT_EQ(rest.tape.summary.status, "done") << rest.tape.summary.message;
    // The instant at which it stopped is evaluated twice, once in each run.
    EXPECT_EQ(tally_of(rest).calls, calls) << stop;
    EXPECT_EQ(tally_of(rest).sum, sum) << stop;
  }
}

}  // namespace
}  // namespace grit::test
