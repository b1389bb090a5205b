#include "study/study_result.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "format/number.hpp"
#include "grit/error.hpp"
#include "made_runs.hpp"
#include "study/parts.hpp"
#include "study/study_page.hpp"
#include "study/study_sentences.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Not;

/// Two settings of two levels, two seeds; the runs are made by hand.
class Charts : public testing::Test {
 protected:
  static constexpr auto value_metric = R"({"end": {"type": "last", "of": "test/y", "against": "test/x"}})";

  StudyResult result(const std::string& metrics = value_metric, const std::string& more = "") {
    folder.write("scene.json", "{}");
    const auto path = folder.write("study.json", R"({"title": "a < b", "scene": "scene.json", "settings": {
      "rate": {"pointers": ["/r"], "values": ["fast", "slow"]}, "size": {"pointers": ["/s"], "values": [2, 1]}},
      "seeds": {"values": )" + seeds + R"(}, "metrics": )" +
                                                     metrics + more + "}");
    return evaluate_study(load_study(path), folder.path());
  }
  void make(const std::string& variant, double cost, double first, double second) {
    make_run(folder / ("runs/" + variant + "/seed-1"), cost, first);
    make_run(folder / ("runs/" + variant + "/seed-2"), cost, second);
  }
  void make_all() {
    make("usual", 1, 1.3, 1.5);
    make("rate=slow", 3, 1.0, 1.2);
    make("size=1", 2, 1.2, 1.4);
    make("finest", 6, 1.0, 1.0);
  }
  OwnFolder folder;
  std::string seeds = "[1, 2]";
  const std::string remedy = "; if a stage ends by a condition, choose another abscissa or another condition";
};

TEST_F(Charts, ErrorIsOfMeansAndItsStandardErrorOfDifferences) {
  make_all();
  const StudyResult all = result();
  ASSERT_EQ(all.variants.size(), 4u);
  const Deviation& usual = all.variants[0].deviations.at("end");
  EXPECT_DOUBLE_EQ(usual.mean, 1.4);
  EXPECT_NEAR(usual.error, 0.4, 1e-15);
  EXPECT_NEAR(usual.scatter, std::sqrt(0.02), 1e-15);
  EXPECT_NEAR(usual.standard_error, std::sqrt(0.02 / 2), 1e-15);
  EXPECT_EQ(all.finest().deviations.at("end").error, 0);
}

TEST_F(Charts, EffectOfASettingIsBesideItsOwnFinestTheOthersAsUsual) {
  make_all();
  const StudyResult all = result();
  ASSERT_EQ(all.effects.size(), 2u);
  EXPECT_EQ(all.effects[0].setting, "rate");
  EXPECT_EQ(all.effects[0].level, "fast");
  EXPECT_DOUBLE_EQ(all.effects[0].cost, 1.0 / 3);
  EXPECT_NEAR(all.effects[0].deviations.at("end").error, 0.3, 1e-15);
  // Seed by seed the difference is the same, however far the seeds are apart.
  EXPECT_NEAR(all.effects[0].deviations.at("end").standard_error, 0, 1e-15);
  EXPECT_NEAR(all.effects[1].deviations.at("end").error, 0.1, 1e-15);
}

TEST_F(Charts, FrontHasWhatNoneBeatsInBoth) {
  make_all();
  make("size=1", 3.5, 1.2, 1.4);  // more expensive and less accurate than rate=slow
  const StudyResult all = result();
  EXPECT_TRUE(all.variants[0].on_front);
  EXPECT_TRUE(all.variants[1].on_front);
  EXPECT_FALSE(all.variants[2].on_front);
  EXPECT_TRUE(all.variants[3].on_front);
}

TEST_F(Charts, CheapestKeepsEveryMetricWithinTheTolerance) {
  make_all();
  EXPECT_EQ(result(value_metric, R"(, "tolerance": 0.55)").cheapest, 0u);
  EXPECT_EQ(result(value_metric, R"(, "tolerance": 0.45)").cheapest, 2u);
  EXPECT_EQ(result(value_metric, R"(, "tolerance": 0.25)").cheapest, 1u);
  const StudyResult strict = result(value_metric, R"(, "tolerance": 0.01)");
  EXPECT_EQ(strict.cheapest, 3u);
  EXPECT_THAT(verdict(strict), HasSubstr("No variant cheaper than the finest settings keeps"));
  // The second metric does not hold where the first does.
  const auto two =
      R"({"end": {"type": "last", "of": "test/y"}, "small": {"type": "last", "of": "test/y", "scale": 0.1}})";
  const StudyResult both = result(two, R"(, "tolerance": 0.55)");
  EXPECT_EQ(both.cheapest, 3u);
  EXPECT_EQ(both.variants[0].worst, "small");
}

TEST_F(Charts, VerdictStatesItsUncertainty) {
  make_all();
  EXPECT_THAT(verdict(result(value_metric, R"(, "tolerance": 0.25)")),
              testing::AllOf(HasSubstr("rate=slow"), HasSubstr("2.00 times cheaper"), HasSubstr("10 % ± 10 %"),
                             HasSubstr("use more seeds")));
  EXPECT_THAT(verdict(result(value_metric, R"(, "tolerance": 0.9)")), Not(HasSubstr("use more seeds")));
}

TEST_F(Charts, VerdictSaysWhichLevelsMayBeInTheWrongOrder) {
  make_all();
  EXPECT_THAT(verdict(result()), Not(HasSubstr("list levels from")));
  make("usual", 9, 1.4, 1.6);
  EXPECT_THAT(verdict(result()),
              HasSubstr("rate=fast costs 3.0 times as much as slow, the last level, which is taken as the finest; list "
                        "levels from the cheapest to the finest."));
}

TEST_F(Charts, CertaintyIsOfEveryMetricNotOnlyOfTheLargestError) {
  // The usual variant's x ends at 1.1 in both samples, a certain error of 10 %; its y is right on average, but
  // scatters.
  make_all();
  const auto two = R"({"far": {"type": "last", "of": "test/x"}, "end": {"type": "last", "of": "test/y"}})";
  for (const auto& [seed, y] : {std::pair("1", 0.6), std::pair("2", 1.4)})
    make_series(folder / ("runs/usual/seed-" + std::string(seed)), {0, 1.1}, {0, y});
  const StudyResult all = result(two, R"(, "tolerance": 0.5)");
  EXPECT_EQ(all.cheapest, 0u);
  EXPECT_EQ(all.variants[0].worst, "far");
  EXPECT_THAT(verdict(all), HasSubstr("not certain for end because of scatter between samples; use more seeds"));
  const StudyResult strict = result(two, R"(, "tolerance": 0.12)");
  EXPECT_NE(strict.cheapest, 0u) << "the end scatters by more than that";
  EXPECT_THAT(verdict(result(two, R"(, "tolerance": 0.05)")), HasSubstr("Some variants are inconclusive"));
}

TEST_F(Charts, CurvesAreComparedWhereBothAre) {
  for (const auto& [variant, offset] :
       {std::pair("usual", 0.5), std::pair("rate=slow", 0.0), std::pair("size=1", 0.0), std::pair("finest", 0.0)})
    for (const char* seed : {"/seed-1", "/seed-2"}) {
      const auto run = folder / ("runs/" + std::string(variant) + seed);
      make_run_json(run, seed == std::string("/seed-1") ? 1 : 1.1);
      // y = 2 x + offset on other samples, and further than the reference.
      if (offset == 0) make_series(run, {0, 1, 4}, {0, 2, 8});
      else make_series(run, {0, 3, 5}, {offset, 6 + offset, 10 + offset});
    }
  const StudyResult all = result(R"({"curve": {"type": "curve", "of": "test/y", "against": "test/x"}})");
  EXPECT_NEAR(all.variants[0].deviations.at("curve").error, 0.5 / 8, 1e-14);
  EXPECT_NEAR(all.variants[0].deviations.at("curve").scatter, 0, 1e-14);
}

TEST_F(Charts, ACurveThatStopsBeforeItsReferenceIsAFailureOfThatRun) {
  make_all();
  // All but the usual go to 1; it ends at a tenth, and there it is exact.
  make_series(folder / "runs/usual/seed-2", {0, 0.1}, {0, 0.1});
  make_series(folder / "runs/size=1/seed-1", {0, 0.95}, {0, 1});
  const auto curve = R"({"curve": {"type": "curve", "of": "test/y", "against": "test/x"}})";
  const StudyResult all = result(curve);
  EXPECT_FALSE(all.variants[0].complete());
  EXPECT_EQ(all.variants[0].samples[1].message,
            "test/y has abscissae from 0 to 0.1, its reference from 0 to 1" + remedy);
  EXPECT_TRUE(all.variants[1].complete());
  EXPECT_TRUE(all.variants[2].complete()) << "what lacks less than a tenth is compared where both are";
  EXPECT_NE(all.cheapest, 0u);
  // Nor may a sample of the finest stop early, and all others be compared with its beginning.
  make_series(folder / "runs/finest/seed-2", {0, 0.1}, {0, 0.1});
  EXPECT_TRUE(result(curve).reference.empty());
  // A reference from elsewhere has to be reached as well.
  folder.write("lab.csv", "x,y\n0,0\n2,2\n");
  const auto lab = R"({"c": {"type": "curve", "of": "test/y", "against": "test/x",
    "curve": {"file": "lab.csv", "x": "x", "y": "y"}}})";
  EXPECT_EQ(result(lab).unevaluated.at("c"),
            "finest settings, seed 1: test/y has abscissae from 0 to 1, its reference from 0 to 2" + remedy);
  for (const char* seed : {"1", "2"}) make_series(folder / ("runs/finest/seed-" + std::string(seed)), {0, 2}, {0, 2});
  EXPECT_EQ(result(lab).variants[1].samples[0].message,
            "test/y has abscissae from 0 to 1, its reference from 0 to 2" + remedy);
}

TEST_F(Charts, ACurveThatEndsBeforeItsReferenceBeginsFailsThatRunOnly) {
  make_all();
  make_series(folder / "runs/usual/seed-2", {0, 0.1}, {0, 0.1});
  folder.write("lab.csv", "x,y\n0.5,1\n1,2\n");
  const auto lab = R"({"c": {"type": "curve", "of": "test/y", "against": "test/x",
    "curve": {"file": "lab.csv", "x": "x", "y": "y"}}})";
  const StudyResult all = result(lab);
  EXPECT_EQ(all.variants[0].samples[0].status, "done");
  EXPECT_EQ(all.variants[0].samples[1].status, "failed");
  EXPECT_EQ(all.variants[0].samples[1].message,
            "test/y has abscissae from 0 to 0.1, its reference from 0.5 to 1" + remedy);
  EXPECT_TRUE(all.variants[1].complete());
  // None gets there: it is the reference that is wrong.
  folder.write("lab.csv", "x,y\n500,1\n1000,2\n");
  const StudyResult none = result(lab);
  EXPECT_EQ(none.unevaluated.at("c"), "no run overlaps the range of its reference; check the units");
  EXPECT_EQ(none.variants[0].samples[0].status, "done") << "in thousandths of the runs' unit";
}

TEST_F(Charts, CostsHaveTheirScatterToo) {
  make_all();
  make_run_json(folder / "runs/usual/seed-1", 0.8), make_run_json(folder / "runs/usual/seed-2", 1.2);
  const StudyResult all = result();
  EXPECT_NEAR(all.variants[0].cost_scatter, std::sqrt(0.08), 1e-15);
  EXPECT_EQ(all.variants[1].cost_scatter, 0);
  // 0.8 and 1.2 beside 3 and 3: the ratio is 1/3, off by 0.2 / 3 each way.
  EXPECT_DOUBLE_EQ(all.effects[0].cost, 1.0 / 3);
  EXPECT_NEAR(all.effects[0].cost_error, std::sqrt(0.08 / 2) / 3, 1e-15);
  EXPECT_NEAR(to_json(all)["effects"][0]["cost_standard_error"], std::sqrt(0.04) / 3, 1e-15);
  EXPECT_THAT(study_page(all), HasSubstr("<td>1 <small>± 0.28</small></td>"));
  // Seeds that cost more in both alike say nothing against the ratio.
  make_run_json(folder / "runs/rate=slow/seed-1", 2.4), make_run_json(folder / "runs/rate=slow/seed-2", 3.6);
  EXPECT_NEAR(result().effects[0].cost_error, 0, 1e-15);
  seeds = "[1]";
  EXPECT_TRUE(std::isnan(result().effects[0].cost_error));
}

TEST_F(Charts, ReferenceMayComeFromElsewhere) {
  make_all();
  const StudyResult all = result(R"({"end": {"type": "last", "of": "test/y", "value": 2}})");
  EXPECT_NEAR(all.finest().deviations.at("end").error, 0.5, 1e-15);
  EXPECT_NEAR(all.variants[0].deviations.at("end").error, 0.3, 1e-15);
  EXPECT_NEAR(all.variants[0].deviations.at("end").standard_error, 0.5 * std::sqrt(0.01), 1e-15);
  const StudyResult with_units = result(R"({"end": {"type": "last", "of": "test/y", "value": "0.002 kPa"}})");
  EXPECT_EQ(with_units.variants[0].deviations.at("end").error, all.variants[0].deviations.at("end").error);
  EXPECT_EQ(to_json(with_units).at("metrics").at("end").at("reference"), "value");
  const StudyResult position = result(R"({"end": {"type": "position-of-maximum", "of": "test/y", "against": "test/x",
    "value": "500 mm", "scale": "50 cm"}})");
  EXPECT_NEAR(position.variants[0].deviations.at("end").error, 1, 1e-15) << "at 1 m";
  folder.write("lab.csv", "x,y\n0,0\n0.5,2\n");
  const StudyResult curve = result(R"({"c": {"type": "curve", "of": "test/y", "against": "test/x",
    "curve": {"file": "lab.csv", "x": "x", "y": "y"}}})");
  // y = 1.4 x against 4 x up to 0.5, over the largest, 2.
  EXPECT_NEAR(curve.variants[0].deviations.at("c").error, 2.6 / 2 * 0.5 / std::sqrt(3), 2e-3);
}

TEST_F(Charts, AReferenceInAnotherUnitIsNotCompared) {
  make_all();
  const StudyResult all =
      result(R"({"end": {"type": "last", "of": "test/y", "value": "2 deg"}, "x": {"type": "last", "of": "test/x"}})");
  EXPECT_THAT(
      all.unevaluated.at("end"),
      HasSubstr(
          "its value is the text \"2 deg\"; allowed is a number in Pa, or a text with a number and one of Pa, kPa"));
  EXPECT_EQ(all.reference.size(), 1u);
  EXPECT_THAT(result(R"({"end": {"type": "last", "of": "test/y", "value": "1e999 Pa"}})").unevaluated.at("end"),
              HasSubstr("its value is the text \"1e999 Pa\""));
}

TEST_F(Charts, AReferenceOfZeroNeedsAScale) {
  make_all();
  make("finest", 6, 0, 0);
  const StudyResult none = result();
  EXPECT_TRUE(none.reference.empty());
  EXPECT_THAT(none.unevaluated.at("end"), HasSubstr("its reference is 0"));
  EXPECT_EQ(verdict(none), "No metric could be evaluated.");
  EXPECT_NEAR(result(R"({"end": {"type": "last", "of": "test/y", "scale": 2}})").variants[0].of_worst().error, 0.7,
              1e-15);
}

TEST_F(Charts, AMetricWithoutAReferenceDoesNotPreventTheEvaluationOfOthers) {
  make_all();
  folder.write("lab.csv", "x,y\n500,1\n1000,2\n");
  const StudyResult all =
      result(R"({"end": {"type": "last", "of": "test/y"}, "begin": {"type": "minimum", "of": "test/y"},
    "far": {"type": "value", "of": "test/y", "against": "test/x", "at": 7},
    "lab": {"type": "curve", "of": "test/y", "against": "test/x",
            "curve": {"file": "lab.csv", "x": "x", "y": "y"}}})");
  EXPECT_NEAR(all.variants[0].deviations.at("end").error, 0.4, 1e-15);
  EXPECT_EQ(all.variants[0].deviations.size(), 1u);
  EXPECT_THAT(
      not_evaluated(all),
      testing::ElementsAre("begin: its reference is 0, so that relative errors are undefined; give a scale",
                           "far: missing in all runs: test/y has abscissae from 0 to 1, but its value is required at 7",
                           "lab: no run overlaps the range of its reference; check the units"));
  EXPECT_THAT(verdict(all), HasSubstr("Metrics that could not be evaluated: begin, far, lab. "));
  const auto json = to_json(all);
  EXPECT_THAT(json["metrics"]["begin"]["not_charted"].get<std::string>(), HasSubstr("its reference is 0"));
  EXPECT_EQ(json["metrics"]["end"]["not_charted"], nullptr);
  const std::string page = study_page(all);
  EXPECT_THAT(page, HasSubstr("<li>begin: its reference is 0"));
  EXPECT_THAT(page, Not(HasSubstr("error of begin")));
}

TEST_F(Charts, AMetricWithoutAValueIsNotEvaluatedUnlessOnlyOtherRunsLackIt) {
  const auto two = R"({"end": {"type": "last", "of": "test/y"}, "far": {"type": "last", "of": "test/x"}})";
  const double nan = std::nan("");
  make_all();
  make_series(folder / "runs/usual/seed-2", {0, 1}, {nan, nan});
  const StudyResult usual = result(two);
  EXPECT_EQ(usual.variants[0].samples[1].status, "failed");
  EXPECT_EQ(usual.variants[0].samples[1].message, "test/y has no finite value");
  EXPECT_EQ(usual.reference.size(), 2u);
  make_all();
  make_series(folder / "runs/finest/seed-2", {0, 1}, {nan, nan});
  const StudyResult finest = result(two);
  EXPECT_EQ(finest.unevaluated.at("end"), "finest settings, seed 2: test/y has no finite value");
  EXPECT_EQ(finest.variants[0].deviations.at("far").error, 0);
  for (const char* variant : {"usual", "rate=slow", "size=1", "finest"})
    for (const char* seed : {"/seed-1", "/seed-2"})
      make_series(folder / ("runs/" + std::string(variant) + seed), {0, 1}, {nan, nan});
  const StudyResult none = result(two);
  EXPECT_EQ(none.unevaluated.at("end"), "missing in all runs: test/y has no finite value");
  EXPECT_TRUE(none.variants[0].complete());
}

TEST_F(Charts, AVariantIsWithinTheToleranceOnlyIfAllFinerOnesAre) {
  // At the usual rate and size the errors cancel: with either of them finer the error is 40 %.
  make("usual", 1, 1.0101, 1.0099);  // differs by seed, as identical samples count as one
  make("rate=slow", 3, 1.4, 1.4);
  make("size=1", 2, 0.6, 0.6);
  make("finest", 6, 1, 1);
  const StudyResult all = result();
  EXPECT_EQ(all.variants[0].confidence(0.05), Confidence::certain);
  EXPECT_EQ(all.variants[0].within, Confidence::exceeded);
  EXPECT_EQ(all.variants[0].decided_by, "rate=slow");
  EXPECT_EQ(all.cheapest, 3u);
  EXPECT_THAT(verdict(all),
              HasSubstr("usual is rejected although its own largest error is 1.0 %: rate=slow, which is finer, "
                        "deviates by 40 % ± 0.00 % (end), so that errors may cancel."));
  EXPECT_THAT(study_page(all),
              HasSubstr("usual <b title=\"no other variant is both cheaper and more accurate\">◂</b><br><small>not "
                        "within the tolerance: rate=slow, which is finer"));
  EXPECT_EQ(to_json(all)["variants"][0]["within_tolerance"], "too large");
  // It is not within either if a finer one is inconclusive; coarser ones do not matter.
  make("rate=slow", 3, 1.2, 0.8);
  make("size=1", 2, 1, 1);
  const StudyResult unsure = result();
  EXPECT_EQ(unsure.variants[0].within, Confidence::inconclusive);
  EXPECT_EQ(unsure.variants[0].decided_by, "rate=slow");
  EXPECT_EQ(unsure.cheapest, 2u);
  make("usual", 1, 9, 9);
  EXPECT_EQ(result().cheapest, 2u);
}

TEST_F(Charts, OneSampleHasNoScatter) {
  make_all();
  seeds = "[1]";
  const StudyResult one = result();
  EXPECT_TRUE(std::isnan(one.variants[0].of_worst().scatter));
  EXPECT_EQ(to_json(one)["variants"][0]["metrics"]["end"]["scatter"], nullptr);
}

TEST_F(Charts, SamplesThatAreAlikeCountAsOneUnlessNothingIsRandom) {
  const auto make_alike = [&](const char* grains) {
    make("usual", 1, 1.3, 1.3), make("rate=slow", 3, 1.1, 1.1), make("size=1", 2, 1.2, 1.2), make("finest", 6, 1, 1);
    nlohmann::json run = nlohmann::json::parse(text_of(folder / "runs/usual/seed-1/run.json"));
    run["description"]["bodies"]["g"] = {{"type", "sphere"}, {"source", {{"type", grains}}}};
    folder.write("runs/usual/seed-1/run.json", run.dump());
  };
  const auto of_usual = [](const StudyResult& result) { return result.variants[0].of_worst(); };
  make_alike("cloud");
  const StudyResult drawn = result(value_metric, R"(, "tolerance": 0.5)");
  EXPECT_TRUE(std::isnan(of_usual(drawn).standard_error));
  EXPECT_TRUE(std::isnan(drawn.effects[0].deviations.at("end").standard_error));
  EXPECT_TRUE(std::isnan(drawn.variants[0].values.at("end").scatter));
  EXPECT_EQ(drawn.variants[0].within, Confidence::inconclusive);
  EXPECT_THAT(verdict(drawn), HasSubstr("All samples are identical although the scene is random: the seed at /seed has "
                                        "no effect"));
  EXPECT_THAT(verdict(drawn), Not(HasSubstr("more seeds")));
  make_alike("list");
  const StudyResult given = result(value_metric, R"(, "tolerance": 0.5)");
  EXPECT_EQ(of_usual(given).standard_error, 0);
  EXPECT_EQ(given.variants[0].within, Confidence::certain);
  EXPECT_THAT(verdict(given),
              HasSubstr("Nothing is random in this scene: the seed has no effect, all samples are identical"));
  EXPECT_EQ(to_json(given)["of_samples"], of_samples(given));
  seeds = "[1]";
  const StudyResult single = result(value_metric, R"(, "tolerance": 0.5)");
  EXPECT_EQ(of_usual(single).standard_error, 0) << "as of two";
  EXPECT_EQ(single.variants[0].within, Confidence::certain);
  EXPECT_EQ(of_samples(single), "Nothing is random in this scene: one sample is sufficient.");
  seeds = "[1, 2]";
  make_run(folder / "runs/size=1/seed-2", 2, 1.2000001);
  EXPECT_EQ(of_samples(result()), "") << "something differs";
}

TEST(WhatIsRandom, IsWhatASeedDecides) {
  const auto random = [](const char* kind, const char* grains) {
    return is_random({{"bodies", {{"g", {{"type", kind}, {"source", {{"type", grains}}}}}}}});
  };
  EXPECT_TRUE(random("sphere", "cloud"));
  EXPECT_FALSE(random("sphere", "list"));
  EXPECT_FALSE(random("sphere", "file"));
  EXPECT_FALSE(random("clump", "list"));
  EXPECT_TRUE(random("clump", "file")) << "a file has no orientations";
  EXPECT_FALSE(random("sphere", "lattice"));
  EXPECT_TRUE(random("clump", "lattice")) << "nor has a lattice";
  EXPECT_TRUE(random("sphere", "stream"));
}

TEST_F(Charts, FailuresAreReportedAndNotEvaluated) {
  make_all();
  make_run_json(folder / "runs/usual/seed-2", 0.5, "failed", "step 7: it <broke>");
  std::filesystem::remove_all(folder / "runs/size=1/seed-1");
  const StudyResult all = result();
  EXPECT_FALSE(all.variants[0].complete());
  EXPECT_FALSE(all.variants[2].complete());
  EXPECT_TRUE(all.variants[1].complete());
  EXPECT_TRUE(all.effects.empty()) << "both lack the usual";
  const std::string page = study_page(all);
  EXPECT_THAT(page, HasSubstr("step 7: it &lt;broke&gt;"));
  EXPECT_THAT(page, HasSubstr("not finished"));
}

TEST_F(Charts, AValueThatARunDoesNotReachIsAFailureOfThatRun) {
  make_all();
  make_series(folder / "runs/usual/seed-2", {0, 0.5}, {0, 1});
  const StudyResult all = result(R"({"y": {"type": "value", "of": "test/y", "against": "test/x", "at": 0.9}})");
  EXPECT_FALSE(all.variants[0].complete());
  EXPECT_TRUE(all.variants[1].complete());
  EXPECT_THAT(study_page(all), HasSubstr("test/y has abscissae from 0 to 0.5, but its value is required at 0.9"));
}

TEST_F(Charts, ARunJsonThatLacksItsKeysIsNoRun) {
  make_all();
  for (const char* text : {"{}", R"({"status": 3, "message": []})", R"({"status": "run)"}) {
    folder.write("runs/usual/seed-2/run.json", text);
    EXPECT_EQ(result().variants[0].samples[1].status, "missing") << text;
  }
  folder.write("runs/usual/seed-2/run.json", R"({"status": "running"})");
  EXPECT_EQ(result().variants[0].samples[1].status, "under way");
}

TEST_F(Charts, CurvesOfTheFinestHaveToShareTheirAbscissa) {
  make_all();
  make_series(folder / "runs/finest/seed-2", {2, 3}, {0, 1});
  EXPECT_EQ(result(R"({"curve": {"type": "curve", "of": "test/y", "against": "test/x"}})").unevaluated.at("curve"),
            "the samples of the finest settings share no range of the abscissa")
      << "one ends at 1, the other begins at 2";
}

TEST_F(Charts, WithoutTheFinestThereIsNoReference) {
  make_all();
  make_run_json(folder / "runs/finest/seed-1", 6, "failed", "it broke");
  const StudyResult all = result();
  EXPECT_TRUE(all.reference.empty());
  EXPECT_THAT(verdict(all), HasSubstr("no reference"));
  EXPECT_THAT(study_page(all), HasSubstr("it broke"));
  const Value slow = all.variants[1].values.at("end");
  EXPECT_DOUBLE_EQ(slow.mean, 1.1);
  EXPECT_DOUBLE_EQ(slow.scatter, std::sqrt(0.02));
  EXPECT_FALSE(all.finest().values.contains("end"));
  EXPECT_DOUBLE_EQ(to_json(all)["variants"][1]["values"]["end"]["mean"], 1.1);
  EXPECT_THAT(to_csv(all), HasSubstr("\"rate=slow\",\"slow\",\"2\",\"end\",1.1,nan"));
  EXPECT_THAT(study_page(all), HasSubstr("1.1 <small>± 0.14</small>"));
}

TEST_F(Charts, VerdictNamesUnevaluatedMetrics) {
  make_all();
  make_run_json(folder / "runs/finest/seed-1", 6, "failed", "it broke");
  const auto two =
      R"({"known": {"type": "last", "of": "test/y", "value": 1}, "end": {"type": "last", "of": "test/y"}})";
  const StudyResult half = result(two, R"(, "tolerance": 0.7)");
  EXPECT_THAT(verdict(half), HasSubstr("Metrics that could not be evaluated: end. Cheapest"));
  EXPECT_EQ(half.unevaluated.at("end"), "the finest settings have no result");
}

TEST_F(Charts, PageHasAllAndFetchesNothing) {
  make_all();
  const std::string page = study_page(result());
  EXPECT_THAT(page, HasSubstr("a &lt; b"));
  for (const char* name : {"usual", "rate=slow", "size=1", "finest"}) EXPECT_THAT(page, HasSubstr(name));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  EXPECT_THAT(page, Not(HasSubstr("href=")));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST_F(Charts, TableHasOneRowAVariantAndMetric) {
  make_all();
  const std::string csv = to_csv(result());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_THAT(csv, HasSubstr("\"rate=slow\",\"slow\",\"2\",\"end\",1.1,"));
  EXPECT_THAT(csv, HasSubstr("core_seconds,core_seconds_scatter,steps"));
}

// 7 bodies, 10 steps a core-second: whatever ran beside them.
TEST_F(Charts, SpeedIsOfCoreSeconds) {
  make_all();
  for (const VariantResult& one : result().variants) EXPECT_DOUBLE_EQ(one.particle_steps_per_core_second, 70);
}

TEST_F(Charts, SpeaksOfDifferencesFromGivenReferences) {
  make_all();
  EXPECT_THAT(study_page(result()), HasSubstr("error of end"));
  const StudyResult given = result(R"({"end": {"type": "last", "of": "test/y", "value": 2}})");
  EXPECT_THAT(study_page(given),
              testing::AllOf(HasSubstr("difference of end from its reference"), Not(HasSubstr("error of")),
                             HasSubstr("cheaper than the most expensive"), Not(HasSubstr("the finest"))));
  EXPECT_THAT(verdict(given), Not(HasSubstr("finest")));
}

/// A sweep of the friction at two seeds.
class Sweeps : public Charts {
 protected:
  StudyResult sweep(const std::string& metric = R"("value": 1.25)",
                    const std::set<std::filesystem::path>& omitted = {}) {
    folder.write("scene.json", "{}");
    const auto path = folder.write("study.json", R"({"scene": "scene.json", "purpose": "sweep", "settings": {
      "friction": {"pointers": ["/f"], "values": ["30 deg", "10 deg", "20 deg"], "doc": "between grains"}},
      "seeds": {"values": [1, 2]}, "metrics": {"end": {"type": "last", "of": "test/y")" +
                                                     (metric.empty() ? "" : ", " + metric) + "}}}");
    return evaluate_study(load_study(path), folder.path(), omitted);
  }
  void make_sweep() {
    make("friction=30_deg", 1, 1.3, 1.5);
    make("friction=10_deg", 3, 1.0, 1.2);
    make("friction=20_deg", 2, 1.2, 1.3);
  }
};

TEST_F(Sweeps, ShowMeansAndStandardErrorsAgainstTheSetting) {
  make_sweep();
  const StudyResult all = sweep();
  ASSERT_EQ(all.variants.size(), 3u);
  const Value& first = all.variants[0].values.at("end");
  EXPECT_DOUBLE_EQ(first.mean, 1.4);
  EXPECT_NEAR(first.standard_error(), 0.1, 1e-15) << "√0.02 over √2";
  EXPECT_FALSE(all.cheapest);
  EXPECT_THAT(all.effects, testing::IsEmpty());
  EXPECT_EQ(verdict(all), "end is closest to 1.25 with friction=20 deg: 1.25 ± 0.05.");
  const std::string page = study_page(all);
  EXPECT_THAT(page,
              testing::AllOf(HasSubstr("friction [deg]"), HasSubstr("between grains"), HasSubstr("6 of 6 runs done"),
                             HasSubstr("given value"), HasSubstr("class=\"spread\"")));
  for (const char* word : {"finest", "errors", "error of", "tolerance", "accurate"})
    EXPECT_THAT(page, Not(HasSubstr(word))) << word;
}

TEST_F(Sweeps, NeedNoReference) {
  make_sweep();
  const StudyResult all = sweep("");
  EXPECT_EQ(verdict(all), "");
  EXPECT_THAT(all.unevaluated, testing::IsEmpty());
  EXPECT_EQ(to_json(all).at("metrics").at("end").at("reference"), "none");
  EXPECT_EQ(to_json(all).at("purpose"), "sweep");
}

TEST_F(Sweeps, HaveATableOfMeansAndStandardErrors) {
  make_sweep();
  const std::string csv = to_csv(sweep());
  EXPECT_THAT(csv, testing::StartsWith("variant,\"friction\",metric,unit,mean,standard_error,standard_deviation,"
                                       "difference,core_seconds,steps,samples_done,samples\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_THAT(csv, HasSubstr("\"friction=10 deg\",\"10 deg\",\"end\",\"Pa\",1.1,0"));
}

TEST_F(Sweeps, AreDrawnFromTheRunsThatAreThere) {
  make_sweep();
  make_run_json(folder / "runs/friction=10_deg/seed-2", 1, "running");
  std::filesystem::remove_all(folder / "runs/friction=20_deg");
  const StudyResult half = sweep("", {folder.path() / "runs/friction=30_deg/seed-1"});
  EXPECT_EQ(half.count("done"), 2u);
  EXPECT_DOUBLE_EQ(half.variants[0].values.at("end").mean, 1.5);
  EXPECT_DOUBLE_EQ(half.variants[1].values.at("end").mean, 1.0);
  EXPECT_TRUE(std::isnan(half.variants[1].values.at("end").standard_error())) << "one sample has no scatter";
  EXPECT_TRUE(half.variants[2].values.empty());
  EXPECT_EQ(of_progress(half),
            "2 of 6 runs are done; 1 under way: friction=10 deg, seed 2; 3 missing: friction=30 deg, seed 1; "
            "friction=20 deg, seed 1; friction=20 deg, seed 2.");
  EXPECT_THAT(study_page(half), testing::AllOf(HasSubstr("2 of 6 runs done"), HasSubstr("seed 2: under way")));
}

TEST_F(Sweeps, DrawCurvesForEachLevel) {
  make_sweep();
  const StudyResult all = sweep(R"("against": "test/x")");
  EXPECT_TRUE(all.variants[0].curves.empty());
  folder.write("study.json", R"({"scene": "scene.json", "purpose": "sweep", "settings": {
      "friction": {"pointers": ["/f"], "values": ["30 deg", "10 deg", "20 deg"]}},
      "seeds": {"values": [1, 2]}, "metrics": {"way": {"type": "curve", "of": "test/y", "against": "test/x"}}})");
  const StudyResult curves = evaluate_study(load_study(folder / "study.json"), folder.path());
  EXPECT_NEAR(curves.variants[0].curves.at("way").mean.back(), 1.4, 1e-15);
  EXPECT_THAT(study_page(curves), testing::AllOf(HasSubstr("way by friction"), HasSubstr("friction=30 deg")));
}

}  // namespace
}  // namespace grit
