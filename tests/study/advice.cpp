#include "study/advice.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "grit/error.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

json effect(const char* setting, const char* level, double cost, double error, double standard_error) {
  return {{"setting", setting},
          {"level", level},
          {"cost", cost},
          {"cost_standard_error", 0.0},
          {"metrics",
           {{"peak", {{"error", error}, {"standard_error", standard_error}}},
            {"small", {{"error", 0.1 * error}, {"standard_error", 0.0}}}}}};
}

json levels(const std::vector<std::string>& labels) {
  json all = json::array();
  for (const auto& label : labels) all.push_back({{"label", label}, {"sets", {"/" + label}}});
  return {{"levels", all}};
}

/// rate: 4, 2, 1; size: big, small.
class AdviceOf : public testing::Test {
 protected:
  AdviceOf() {
    result = {{"title", "t"},
              {"scenario", "box"},
              {"samples", 3},
              {"metrics", {{"peak", json::object()}, {"small", json::object()}}},
              {"settings", {{"rate", levels({"4", "2", "1"})}, {"size", levels({"big", "small"})}}},
              {"effects",
               {effect("rate", "4", 0.25, 0.08, 0.001), effect("rate", "2", 0.5, 0.02, 0.001),
                effect("size", "big", 0.5, 0.03, 0.001)}}};
  }
  /// Advice for a description that has these levels.
  std::vector<Advice> advice(double tolerance, const std::string& rate = "/1", const std::string& size = "/small",
                             const std::vector<std::string>& metrics = {}) {
    const OwnFolder folder;
    study = read_evaluated_study(folder.write("study.json", result.dump()), metrics);
    return advise(study, tolerance,
                  [=](const std::vector<std::string>& sets) { return sets[0] == rate || sets[0] == size; });
  }
  json result;
  EvaluatedStudy study;
};

TEST_F(AdviceOf, ATolerancePicksTheCheapestLevelWithin) {
  const auto narrow = advice(0.01);
  EXPECT_THAT(narrow[0].within, IsEmpty());
  EXPECT_THAT(narrow[1].within, IsEmpty());
  EXPECT_EQ(advice(0.05)[0].within.at(0)->level, "2");
  EXPECT_EQ(advice(0.2)[0].within.at(0)->level, "4");
  EXPECT_EQ(advice(0.05)[0].within.at(0)->decisive(0.05)->metric, "peak");
}

TEST_F(AdviceOf, ErrorsOfSettingsTakenTogetherAddUpToNoMoreThanTheTolerance) {
  const auto some = advice(0.04);
  EXPECT_TRUE(some[0].taken) << "saves as much with less error";
  EXPECT_FALSE(some[1].taken);
  EXPECT_TRUE(advice(0.06)[0].taken && advice(0.06)[1].taken);
}

TEST_F(AdviceOf, TheCheapestCombinationIsTaken) {
  // rate 4 does not fit with anything else, rate 2 and the size do, which save more than it.
  result["effects"][0] = effect("rate", "4", 0.3, 0.06, 0.001);
  const auto both = advice(0.07);
  ASSERT_TRUE(both[0].taken && both[1].taken);
  EXPECT_EQ(both[0].taken->level, "2");
  EXPECT_DOUBLE_EQ(together(both).cost, 0.25);
  // And vice versa, though the size saves more for what it changes.
  result["effects"][2] = effect("size", "big", 0.7, 0.011, 0.001);
  const auto one = advice(0.065);
  ASSERT_TRUE(one[0].taken);
  EXPECT_EQ(one[0].taken->level, "4");
  EXPECT_FALSE(one[1].taken);
}

TEST_F(AdviceOf, ACoarserLevelHasToSaveBesideAFinerOne) {
  for (const std::size_t k : {0u, 1u}) result["effects"][k]["cost_standard_error"] = 0.01;
  result["effects"][0]["cost"] = 0.48;
  EXPECT_EQ(advice(0.2)[0].taken->level, "2");
  result["effects"][0]["cost"] = 0.46;
  EXPECT_EQ(advice(0.2)[0].taken->level, "4");
}

TEST_F(AdviceOf, OnlyCheaperLevelsThanThePresentOneAreAdvised) {
  const auto some = advice(0.2, "/2", "/big");
  EXPECT_EQ(some[0].now->level, "2");
  EXPECT_EQ(some[0].within.at(0)->level, "4");
  EXPECT_THAT(some[1].cheaper, IsEmpty());
}

TEST_F(AdviceOf, ADescriptionMayHaveAValueThatWasNotStudied) {
  const auto some = advice(0.2, "/7");
  EXPECT_EQ(some[0].now, nullptr);
  EXPECT_THAT(some[0].found, HasSubstr("studied values are 4, 2, 1"));
}

TEST_F(AdviceOf, MetricsThatAreNotSelectedDoNotForbid) {
  EXPECT_EQ(advice(0.01, "/1", "/small", {"small"})[0].within.at(0)->level, "4");
  EXPECT_THROW(advice(0.01, "/1", "/small", {"big"}), Error);
}

TEST_F(AdviceOf, LevelsThatFailedAreReportedAndNeverTaken) {
  result["effects"].erase(0);
  const auto some = advice(0.9);
  EXPECT_EQ(some[0].within.at(0)->level, "2");
  ASSERT_EQ(some[0].cheaper.size(), 2u);
  EXPECT_EQ(some[0].cheaper[0]->level, "4");
  EXPECT_FALSE(some[0].cheaper[0]->known);
  const auto own = advice(0.9, "/4");
  EXPECT_EQ(own[0].now, nullptr);
  EXPECT_THAT(own[0].found, HasSubstr("4 here, at which runs of the study failed"));
}

TEST_F(AdviceOf, SettingsThatStayCountInTheSum) {
  // The rate changes 2 % already: with the 3 % of the size it would be 5 %.
  const auto some = advice(0.04, "/2");
  EXPECT_EQ(some[1].within.at(0)->level, "big");
  EXPECT_FALSE(some[1].taken);
  const Evidence all = together(some);
  ASSERT_EQ(all.findings.size(), 2u);
  EXPECT_NEAR(all.findings[0].error, 0.02, 1e-15);
  EXPECT_DOUBLE_EQ(all.cost, 1);
  const auto both = advice(0.06, "/2");
  EXPECT_TRUE(both[1].taken);
  EXPECT_NEAR(together(both).findings[0].error, 0.05, 1e-15);
  EXPECT_NEAR(together(both).findings[0].standard_error, std::sqrt(2e-6), 1e-15);
  EXPECT_DOUBLE_EQ(together(both).cost, 0.5);
}

TEST_F(AdviceOf, EachMetricHasItsOwnSum) {
  for (const char* metric : {"peak", "small"}) {
    result["effects"][1]["metrics"][metric]["error"] = metric == std::string("peak") ? 0.0 : 0.03;
    result["effects"][2]["metrics"][metric]["error"] = metric == std::string("peak") ? 0.03 : 0.0;
  }
  const auto some = advice(0.04);
  EXPECT_TRUE(some[0].taken && some[1].taken) << "each changes another metric by 3 %";
}

TEST_F(AdviceOf, EvidenceThatScattersByMoreThanTheToleranceIsNone) {
  result["effects"][0]["metrics"]["peak"] = {{"error", 0.017}, {"standard_error", 0.111}};
  EXPECT_EQ(advice(0.03)[0].within.at(0)->level, "2");
  EXPECT_EQ(advice(0.03)[0].cheaper[0]->confidence(0.03), Confidence::inconclusive);
  for (auto& effect : result["effects"])
    for (auto& metric : effect["metrics"]) metric["standard_error"] = nullptr;
  EXPECT_THAT(advice(0.03)[0].within, IsEmpty()) << "the variance of one sample is unknown";
}

TEST_F(AdviceOf, ASavingWithinTheScatterOfRunTimesIsNone) {
  result["effects"][1]["cost"] = 0.86;
  EXPECT_EQ(advice(0.05)[0].within.at(0)->level, "2");
  for (const json& error : {json(0.08), json()}) {
    result["effects"][1]["cost_standard_error"] = error;
    const auto some = advice(0.05);
    EXPECT_THAT(some[0].within, IsEmpty());
    ASSERT_EQ(some[0].cheaper.size(), 2u) << "it is still listed";
    EXPECT_FALSE(saves(*some[0].cheaper[1], *some[0].now));
  }
  // Both scatter where the description does not have the finest.
  result["effects"][0]["cost"] = 0.7, result["effects"][0]["cost_standard_error"] = 0.05;
  result["effects"][1]["cost_standard_error"] = 0.07;
  EXPECT_THAT(advice(0.2, "/2")[0].within, IsEmpty());
  EXPECT_EQ(advice(0.2, "/1")[0].within.at(0)->level, "4");
}

TEST_F(AdviceOf, ALevelIsWithinTheToleranceOnlyIfAllFinerOnesAre) {
  result["effects"][0] = effect("rate", "4", 0.25, 0.001, 0.001);
  result["effects"][1] = effect("rate", "2", 0.5, 0.06, 0.001);
  const auto some = advice(0.05);
  EXPECT_THAT(some[0].within, IsEmpty()) << "its error is small, but grows where it is made finer";
  const auto& levels = study.settings.at("rate");
  EXPECT_EQ(least_sure(levels, levels[0], 0.05).level, "2");
  EXPECT_EQ(least_sure(levels, levels[1], 0.05).level, "2");
  EXPECT_EQ(least_sure(levels, levels[2], 0.05).level, "1");
  EXPECT_EQ(advice(0.1)[0].within.at(0)->level, "4");
  result["effects"][1] = effect("rate", "2", 0.5, 0.01, 0.06);
  EXPECT_THAT(advice(0.05)[0].within, IsEmpty()) << "the finer one is inconclusive";
  result["effects"].erase(1);
  EXPECT_EQ(advice(0.05)[0].within.at(0)->level, "4") << "what failed says nothing";
}

TEST_F(AdviceOf, WhatIsFinerAndCheaperIsTakenWhateverStays) {
  // The rate stays beyond the tolerance, whatever the size does.
  result["effects"][2] = effect("size", "big", 1.25, 0.3, 0.001);
  const auto some = advice(0.05, "/4", "/big");
  EXPECT_EQ(some[0].taken, nullptr);
  ASSERT_EQ(some[1].taken, some[1].finer);
  EXPECT_EQ(some[1].taken->level, "small");
  EXPECT_FALSE(some[1].is_relaxed());
  EXPECT_DOUBLE_EQ(together(some).cost, 0.8);
  EXPECT_NEAR(together(some).findings[0].error, 0.08, 1e-15);
  result["effects"][2]["cost_standard_error"] = 0.2;
  EXPECT_EQ(advice(0.05, "/4", "/big")[1].taken, nullptr) << "times scatter by more";
  // Finer and cheaper, but further off.
  result["effects"][0] = effect("rate", "4", 2.5, 0.08, 0.001);
  result["effects"][1] = effect("rate", "2", 0.5, 0.2, 0.001);
  EXPECT_EQ(advice(0.05, "/4")[0].taken->level, "1");
  result["effects"][0]["cost"] = 0.9;
  EXPECT_EQ(advice(0.05, "/4")[0].taken, nullptr);
}

TEST_F(AdviceOf, TheFinerLevelThatIsWithinTheToleranceIsTheCheapest) {
  advice(0.05);
  const auto& levels = study.settings.at("rate");
  EXPECT_EQ(within_and_finer(levels, levels[0], 0.05)->level, "2");
  EXPECT_EQ(within_and_finer(levels, levels[0], 0.01)->level, "1");
  EXPECT_EQ(within_and_finer(levels, levels[2], 0.05), nullptr);
}

TEST_F(AdviceOf, UnevaluatedMetricsAreKept) {
  result["metrics"]["small"] = {{"reference", "finest"}, {"not_charted", "its reference is 0"}};
  result["metrics"]["peak"] = {{"reference", "value"}, {"not_charted", nullptr}};
  const auto variant = [](const char* name, double error, double standard_error) {
    return json{{"name", name}, {"metrics", {{"peak", {{"error", error}, {"standard_error", standard_error}}}}}};
  };
  result["variants"] = {
      variant("usual", 0.9, 0.01), variant("finest", 0.4, 0.01), {{"name", "failed"}, {"metrics", json::object()}}};
  advice(0.05);
  EXPECT_EQ(study.unevaluated, (std::map<std::string, std::string>{{"small", "its reference is 0"}}));
  EXPECT_EQ(study.metrics, std::vector<std::string>{"peak"});
  const auto far = far_off(study, 0.05);
  ASSERT_EQ(far.size(), 1u);
  EXPECT_EQ(far[0].metric, "peak");
  EXPECT_EQ(far[0].error, 0.4);
  EXPECT_THAT(far_off(study, 0.5), IsEmpty());
  result["variants"][0] = variant("usual", 0.9, 0.5);
  advice(0.05);
  EXPECT_THAT(far_off(study, 0.05), IsEmpty()) << "one is inconclusive";
}

TEST_F(AdviceOf, AStudyWithoutErrorsIsRefused) {
  const auto refused = [&](const std::vector<std::string>& metrics) {
    try {
      advice(0.05, "/1", "/small", metrics);
    } catch (const FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (auto& effect : result["effects"]) effect["metrics"]["small"]["error"] = nullptr;
  EXPECT_EQ(refused({}), "");
  EXPECT_THAT(refused({"small"}), HasSubstr("study.json: has no errors of small"));
  for (auto& effect : result["effects"]) effect["metrics"].erase("peak");
  EXPECT_THAT(refused({"peak"}), HasSubstr("has no errors of peak"));
  EXPECT_THAT(refused({}), HasSubstr("has no errors of any metric"));
  result["effects"] = json::array();
  EXPECT_THAT(refused({}), HasSubstr("has no errors of any metric"));
}

TEST_F(AdviceOf, ASweepGivesNone) {
  advice(0.1);
  EXPECT_FALSE(study.sweep);
  result["purpose"] = "sweep";
  result["effects"] = json::array();
  const OwnFolder folder;
  study = read_evaluated_study(folder.write("study.json", result.dump()), {});
  EXPECT_TRUE(study.sweep);
}

TEST_F(AdviceOf, TheLeastCertainMetricDecides) {
  result["effects"][0]["metrics"]["small"]["standard_error"] = 0.2;
  const auto some = advice(0.1);
  EXPECT_EQ(some[0].within.at(0)->level, "2");
  EXPECT_EQ(some[0].cheaper[0]->confidence(0.1), Confidence::inconclusive);
  EXPECT_EQ(some[0].cheaper[0]->decisive(0.1)->metric, "small");
  EXPECT_EQ(some[0].cheaper[1]->decisive(0.1)->metric, "peak") << "as sure as the other, and more";
}

TEST(Confidences, ComeFromErrorAndScatter) {
  EXPECT_EQ(confidence(0.05, 0.02, 0.1), Confidence::certain);
  EXPECT_EQ(confidence(0.05, 0.03, 0.1), Confidence::likely);
  EXPECT_EQ(confidence(0.05, 0.06, 0.1), Confidence::inconclusive);
  EXPECT_EQ(confidence(0.05, 0.12, 0.1), Confidence::inconclusive);
  EXPECT_EQ(confidence(0.05, std::nan(""), 0.1), Confidence::inconclusive);
  EXPECT_EQ(confidence(0.15, 0.08, 0.1), Confidence::inconclusive);
  EXPECT_EQ(confidence(0.15, 0.07, 0.1), Confidence::exceeded);
}

TEST(StudyFiles, OthersAreRefused) {
  const OwnFolder folder;
  EXPECT_THROW(read_evaluated_study(folder / "none.json", {}), FileError);
  EXPECT_THROW(read_evaluated_study(folder.write("run.json", R"({"status": "done"})"), {}), FileError);
}

}  // namespace
}  // namespace grit
