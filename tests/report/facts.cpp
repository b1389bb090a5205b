#include "report/facts.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grit::facts_tests {
namespace {

Fact fact(const std::vector<Fact>& facts, const std::string& name) {
  const auto found = std::ranges::find(facts, name, &Fact::name);
  return found == facts.end() ? Fact{name, "not told", "", false} : *found;
}

RunResults run_with(const Description& json, const std::vector<std::pair<std::string, std::vector<double>>>& channels) {
  RunResults run;
  run.json = json;
  run.probes.push_back({"probe", {}});
  for (const auto& [name, values] : channels)
    run.probes.back().channels.push_back({name, {.unit = "1", .doc = "", .samples = values.size(), .values = values}});
  return run;
}

TEST(Facts, ReportTheCostOfARun) {
  const auto facts = cost_facts(run_with({{"bodies", 12345},
                                          {"contacts_per_body", 4.5},
                                          {"time", 0.0425},
                                          {"steps", 2000000},
                                          {"wall_s", 75.0},
                                          {"threads", 1},
                                          {"particle_steps_per_s", 1.25e7}},
                                         {}));
  EXPECT_EQ(fact(facts, "bodies").value, "12\u202f345");
  EXPECT_EQ(fact(facts, "bodies").note, "4.50 contacts each");
  EXPECT_EQ(fact(facts, "simulated").value, "42.5 ms");
  EXPECT_EQ(fact(facts, "simulated").note, "2\u202f000\u202f000 steps");
  EXPECT_EQ(fact(facts, "run time").value, "75 s");
  EXPECT_EQ(fact(facts, "run time").note, "1 thread");
  EXPECT_EQ(fact(facts, "speed").value, "12.5 M");
}

TEST(Facts, CountTheRanksOfARun) {
  const auto facts =
      cost_facts(run_with({{"time", 1.0}, {"steps", 10}, {"wall_s", 75.0}, {"threads", 4}, {"ranks", 2}}, {}));
  EXPECT_EQ(fact(facts, "run time").note, "2 ranks of 4 threads");
}

/// A run of two stages, the second from 0.1 s, with the probe "probe" and its channel "angle" [rad].
RunResults run_that_found(const std::vector<double>& angles, const Description& output) {
  std::vector<double> time, strain;
  for (std::size_t i = 0; i < angles.size(); ++i)
    time.push_back(0.1 + static_cast<double>(i) * 1e-3), strain.push_back(static_cast<double>(i) * 1e-4);
  RunResults run = run_with({{"status", "done"},
                             {"stages", {{{"name", "prepare"}, {"time", 0.1}}, {{"name", "shear"}, {"time", 9.0}}}},
                             {"description", {{"output", output}}}},
                            {{"time", time}, {"strain", strain}, {"angle", angles}});
  run.probes.back().channels[0].sampled.unit = "s", run.probes.back().channels[2].sampled.unit = "rad";
  return run;
}
const Description of_the_angle = {{"summary", {"probe/angle"}},
                                  {"picture", {{"x", "probe/strain"}, {"y", {"probe/angle"}}}}};

TEST(Facts, ReportWhatWasFoundWithItsError) {
  const double degree = M_PI / 180;
  std::vector<double> angles(400, 30 * degree);
  angles[80] = 41 * degree;
  for (std::size_t part = 0; part < 5; ++part)  // of the last 40, with means of 32 to 36 degrees
    for (std::size_t i = 0; i < 8; ++i)
      angles[360 + 8 * part + i] = (32 + static_cast<double>(part) + (i % 2 == 0 ? 3 : -3)) * degree;
  const auto facts = result_facts(run_that_found(angles, of_the_angle));
  ASSERT_EQ(facts.size(), 1u) << "once, though the summary and the picture have it";
  EXPECT_EQ(facts[0].name, "probe: angle");
  EXPECT_EQ(facts[0].value, "34.0 ± 0.7°") << "√(10 / 20)";
  EXPECT_EQ(facts[0].note, "mean of the last tenth of the last stage; largest 41° at strain 0.008");

  for (double& angle : angles) angle = 30 * degree + (angle - 30 * degree) / 5;
  EXPECT_EQ(fact(result_facts(run_that_found(angles, of_the_angle)), "probe: angle").value, "30.80 ± 0.14°");
}

TEST(Facts, ReportLargeResultsInPlainDigits) {
  std::vector<double> counts(400, 12000);
  for (std::size_t i = 360; i < 400; ++i) counts[i] = 12345 + 60 * static_cast<double>((i - 360) / 8);
  RunResults run = run_that_found(counts, of_the_angle);
  run.probes.back().channels[2].sampled.unit = "1";
  EXPECT_EQ(fact(result_facts(run), "probe: angle").value, "12470 ± 40") << "60 √(10 / 20) = 42";
}

TEST(Facts, ReportTheLastValueOfFewSamples) {
  const auto facts = result_facts(run_that_found({0.5, -0.75, 0.25}, {{"summary", {"probe/angle"}}}));
  ASSERT_EQ(facts.size(), 1u);
  EXPECT_EQ(facts[0].value, "14.32°");
  EXPECT_EQ(facts[0].note, "at the end; largest -42.97° at time 0.101 s");
}

TEST(Facts, ReportOneSampleWithItsAbscissa) {
  const auto facts = result_facts(run_that_found({0.25}, of_the_angle));
  ASSERT_EQ(facts.size(), 1u);
  EXPECT_EQ(facts[0].value, "14.32°");
  EXPECT_EQ(facts[0].note, "one sample in the last stage, at strain 0");
}

TEST(Facts, ReportNothingThatWasNotFound) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const Description others = {{"summary", {"probe/angle", "angle", "probe/none", "none/angle", 3, nullptr}},
                              {"picture", {{"x", 3}, {"y", "probe/angle"}}}};
  EXPECT_TRUE(result_facts(run_that_found({nothing, nothing}, others)).empty());
  EXPECT_EQ(result_facts(run_that_found({1, nothing}, others)).size(), 1u);
  EXPECT_TRUE(result_facts(run_that_found({}, others)).empty());
  EXPECT_TRUE(result_facts(run_that_found({1}, Description())).empty());
}

TEST(Facts, ReportTheReliabilityOfARun) {
  const Description json = {
      {"time_step_s", 8e-7},
      {"critical_time_step_s", 1e-6},
      {"description", {{"materials", {{"a", {{"contact_modulus", 3e8}}}, {"b", {{"contact_modulus", 6e8}}}}}}}};
  const auto facts =
      trust_facts(run_with(json, {{"closure_fraction", {0, -0.02, 0.005}},
                                  {"inertial_number", {std::numeric_limits<double>::quiet_NaN(), 9e-4, 1e-5}},
                                  {"mean_stress", {1e5, 2e5}},
                                  {"largest_overlap", {1e-6, 2e-5}}}),
                  1e-3);
  EXPECT_EQ(fact(facts, "time step").value, "800 ns");
  EXPECT_EQ(fact(facts, "time step").note, "0.8 of the critical time step");
  EXPECT_EQ(fact(facts, "energy closure").value, "2 %");
  EXPECT_TRUE(fact(facts, "energy closure").doubtful);
  EXPECT_EQ(fact(facts, "inertial number").value, "0.0009");
  EXPECT_FALSE(fact(facts, "inertial number").doubtful);
  EXPECT_EQ(fact(facts, "stiffness level").value, "1\u202f500");
  EXPECT_EQ(fact(facts, "largest overlap").value, "2 %");
  EXPECT_FALSE(fact(facts, "largest overlap").doubtful);
}

TEST(Facts, ShowAnyStiffnessLevel) {
  const Description json = {{"description", {{"materials", {{"a", {{"contact_modulus", 3e8}}}}}}}};
  const auto level = [&](double stress) {
    const auto facts = trust_facts(run_with(json, {{"mean_stress", {stress}}}), 1e-3);
    const auto found = std::ranges::find(facts, "stiffness level", &Fact::name);
    return found == facts.end() ? std::string("none") : found->value;
  };
  EXPECT_EQ(level(1e-3), "300\u202f000\u202f000\u202f000");
  EXPECT_EQ(level(1e-200), "3e+208");
  EXPECT_EQ(level(1e-305), "none") << "not finite";
}

// A heap on a wide floor fills little of the box in which stresses are averaged.
TEST(Facts, ReportNoStressesOfEmptySpace) {
  const Description json = {{"description", {{"materials", {{"a", {{"contact_modulus", 3e8}}}}}}}};
  const auto names = [&](double void_ratio) {
    std::vector<std::string> all;
    for (const Fact& one : trust_facts(
             run_with(json, {{"void_ratio", {void_ratio}}, {"mean_stress", {2.0}}, {"inertial_number", {1e-5}}}), 1e-3))
      all.push_back(one.name);
    return all;
  };
  EXPECT_THAT(names(0.6), testing::IsSupersetOf({"stiffness level", "inertial number"}));
  EXPECT_THAT(names(900),
              testing::Not(testing::AnyOf(testing::Contains("stiffness level"), testing::Contains("inertial number"))));
}

TEST(Facts, ReportHowToAddAnEnergyBalance) {
  const Description json = {{"status", "done"}, {"description", {{"probes", Description::object()}}}};
  const Fact none = fact(trust_facts(run_with(json, {}), 0), "energy closure");
  EXPECT_EQ(none.value, "not measured");
  EXPECT_THAT(none.note, testing::HasSubstr(R"(--set '/probes/energy={"type": "energy", "every_steps": 1000}')"));
  EXPECT_FALSE(none.doubtful);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fact(trust_facts(run_with(json, {{"closure_fraction", {nan, nan}}}), 0), "energy closure").value,
            "unknown");
}

TEST(Facts, ReportTheStageOfAnInterruption) {
  Description json = {{"status", "interrupted"},
                      {"stage", "shear"},
                      {"time", 0.0475},
                      {"stages", {{{"time", 0.02}}, {{"time", 0.045}}}},
                      {"description", {{"stages", {{{"name", "fill"}}, {{"name", "settle"}}, {{"name", "shear"}}}}}}};
  EXPECT_EQ(where_interrupted(run_with(json, {})), "Interrupted in stage shear (3 of 3), 2.5 ms after it began.");
  json["status"] = "done";
  EXPECT_EQ(where_interrupted(run_with(json, {})), "");
  EXPECT_EQ(where_interrupted(run_with({{"status", "interrupted"}}, {})), "");
}

TEST(Facts, ReliabilityRefersToTheLastStage) {
  const std::vector<std::pair<std::string, std::vector<double>>> series{{"time", {0.1, 0.2, 0.3, 0.4}},
                                                                        {"inertial_number", {0.4, 0.3, 1e-4, 2e-4}}};
  Description json = {{"status", "done"}, {"stages", {{{"time", 0.25}}, {{"time", 0.4}}}}};
  EXPECT_EQ(fact(trust_facts(run_with(json, series), 0), "inertial number").value, "0.0002");
  // Stopped within its second stage, or its first.
  json = {{"status", "failed"}, {"stages", {{{"time", 0.25}}}}};
  EXPECT_EQ(fact(trust_facts(run_with(json, series), 0), "inertial number").value, "0.0002");
  json = {{"status", "failed"}, {"stages", Description::array()}};
  EXPECT_EQ(fact(trust_facts(run_with(json, series), 0), "inertial number").value, "0.4");
}

TEST(Facts, MarkFastShearWithoutGravity) {
  const std::vector<std::pair<std::string, std::vector<double>>> fast{{"inertial_number", {4e-3}}};
  EXPECT_TRUE(fact(trust_facts(run_with(Description::object(), fast), 0), "inertial number").doubtful);
  // A marked value is not rounded to the limit.
  for (const auto& [inertial, words, doubtful] :
       {std::tuple(1.004e-3, "0.001", false), std::tuple(1.006e-3, "0.00101", true)}) {
    const Fact told =
        fact(trust_facts(run_with(Description::object(), {{"inertial_number", {inertial}}}), 0), "inertial number");
    EXPECT_EQ(told.value, words);
    EXPECT_EQ(told.doubtful, doubtful);
  }
  const Description falling = {{"description", {{"engines", {{"weight", {{"type", "gravity"}}}}}}}};
  EXPECT_FALSE(fact(trust_facts(run_with(falling, fast), 0), "inertial number").doubtful);
}

TEST(Facts, OmitUnknownValues) {
  EXPECT_THAT(cost_facts(run_with(Description::object(), {})), testing::IsEmpty());
  EXPECT_THAT(trust_facts(run_with({{"time_step_s", nullptr}}, {{"largest_overlap", {1e-6}}}), 0), testing::IsEmpty());
  EXPECT_EQ(status_of(run_with(Description::object(), {})), "unknown");
}

TEST(Facts, WaitForTheFirstStageToEnd) {
  Description json = {{"status", "running"}, {"bodies", 7},  {"time", 0.0},        {"steps", 0},
                      {"wall_s", 0.0},       {"threads", 1}, {"time_step_s", 0.0}, {"particle_steps_per_s", 0.0}};
  const auto names = [&] {
    std::vector<std::string> all;
    for (const Fact& fact : cost_facts(run_with(json, {}))) all.push_back(fact.name);
    for (const Fact& fact : trust_facts(run_with(json, {}), 0)) all.push_back(fact.name);
    return all;
  };
  EXPECT_THAT(names(), testing::ElementsAre("bodies"));
  json["time"] = 0.1, json["steps"] = 100;
  EXPECT_THAT(names(), testing::ElementsAre("bodies", "simulated", "run time", "speed", "time step"));
}

}  // namespace
}  // namespace grit::facts_tests
