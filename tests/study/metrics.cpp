#include "study/metrics.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grit/error.hpp"
#include "made_runs.hpp"
#include "output/read_results.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

MetricDescription metric(const std::string& type, const std::string& of = "test/y",
                         const std::string& against = "test/x") {
  MetricDescription metric;
  metric.what.choose(type);
  metric.of = of, metric.against = against;
  return metric;
}

template <class Act>
std::string error_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// y = 0, 1, 4, 9, 4 over x = 0, 1, 2, 3, 5.
class Metrics : public testing::Test {
 protected:
  Metrics() { make_series(folder.path(), {0, 1, 2, 3, 5}, {0, 1, 4, 9, 4}); }
  double value(const MetricDescription& metric) const { return take_metric(metric, folder.path()).y.at(0); }
  OwnFolder folder;
};

TEST_F(Metrics, AreTheExtremesAndTheEnd) {
  EXPECT_EQ(value(metric("maximum")), 9);
  EXPECT_EQ(value(metric("position-of-maximum")), 3);
  EXPECT_EQ(value(metric("minimum")), 0);
  EXPECT_EQ(value(metric("last")), 4);
  EXPECT_EQ(take_metric(metric("maximum"), folder.path()).unit, "Pa");
  EXPECT_EQ(take_metric(metric("position-of-maximum"), folder.path()).unit, "m");
}

TEST_F(Metrics, MeanIsOverTheAbscissaNotTheSamples) {
  auto last_two_fifths = metric("mean");
  std::get<MeanMetric>(last_two_fifths.what.value()).fraction = 0.4;
  EXPECT_DOUBLE_EQ(value(last_two_fifths), 6.5);
  auto all = metric("mean");
  std::get<MeanMetric>(all.what.value()).fraction = 1;
  EXPECT_DOUBLE_EQ(value(all), (0.5 + 2.5 + 6.5 + 13) / 5);
}

TEST_F(Metrics, ValueIsReadBetweenSamples) {
  auto one = metric("value");
  std::get<ValueMetric>(one.what.value()).at = 2.5;
  EXPECT_DOUBLE_EQ(value(one), 6.5);
  std::get<ValueMetric>(one.what.value()).at = 6;
  EXPECT_THAT(error_of([&] { value(one); }),
              HasSubstr("test/y has abscissae from 0 to 5, but its value is required at 6"));
  std::get<ValueMetric>(one.what.value()).at = "2500 mm";
  EXPECT_DOUBLE_EQ(value(one), 6.5);
  std::get<ValueMetric>(one.what.value()).at = "2 s";
  EXPECT_THAT(
      error_of([&] { value(one); }),
      HasSubstr(
          "test/y has its value at the text \"2 s\"; allowed is a number in m, or a text with a number and one of"));
}

TEST_F(Metrics, AbscissaIsTimeUnlessItIsNamed) {
  EXPECT_DOUBLE_EQ(value(metric("position-of-maximum", "test/y", "")), 0.3);
}

TEST_F(Metrics, AProfileIsTheLastSample) {
  const Metric profile = take_metric(metric("profile", "test/profile", ""), folder.path());
  EXPECT_THAT(profile.x, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(profile.y, ElementsAre(0, 1, 4, 9, 4));
  EXPECT_THAT(error_of([&] { take_metric(metric("last", "test/profile"), folder.path()); }),
              HasSubstr("which only a profile accepts"));
  const double unknown = std::nan("");
  make_series(folder / "unknown", {0, 1}, {unknown, unknown});
  EXPECT_THAT(error_of([&] { take_metric(metric("profile", "test/profile", ""), folder / "unknown"); }),
              HasSubstr("test/profile has no finite value"));
}

TEST_F(Metrics, ExtremesAndTheEndAreOfAllSamplesWhereverTheAbscissaGoes) {
  make_series(folder.path(), {0, 2, 1, 0.5}, {1, 3, 7, -4});
  EXPECT_EQ(value(metric("maximum")), 7);
  EXPECT_EQ(value(metric("position-of-maximum")), 1);
  EXPECT_EQ(value(metric("minimum")), -4);
  EXPECT_EQ(value(metric("last")), -4);
}

TEST_F(Metrics, ACurveOmitsPointsThatGoBack) {
  make_series(folder / "back", {0, 1, 0.5, 2}, {0, 1, 7, 2});
  const Metric curve = take_metric(metric("curve"), folder / "back");
  EXPECT_THAT(curve.x, ElementsAre(0, 1, 2));
  EXPECT_THAT(curve.y, ElementsAre(0, 1, 2));
}

TEST_F(Metrics, AreOfOneInstantAndAsLongAsTheirAbscissa) {
  const OwnFolder run;
  {
    const std::vector<ProbeGroup> probes{{"a", {{"x", "m", "abscissa", {}}, {"three", "1", "row", {3}}}},
                                         {"same", {{"y", "Pa", "ordinate", {}}}},
                                         {"later", {{"y", "Pa", "ordinate", {}}, {"two", "1", "row", {2}}}}};
    Series series(run / "series.h5", probes);
    for (std::size_t i = 0; i < 3; ++i) {
      const double time = 0.1 * static_cast<double>(i);
      const std::vector<double> x{time}, row{0, 1, 2}, y{2 * time}, pair{0, 1};
      series.append(0, time, i, std::vector<std::span<const double>>{x, row});
      series.append(1, time, i, std::vector<std::span<const double>>{y});
      series.append(2, time + 0.05, i, std::vector<std::span<const double>>{y, pair});
    }
    series.close();
  }
  EXPECT_THAT(take_metric(metric("curve", "same/y", "a/x"), run.path()).x, ElementsAre(0, 0.1, 0.2));
  EXPECT_THAT(error_of([&] { take_metric(metric("curve", "later/y", "a/x"), run.path()); }),
              HasSubstr("later/y and a/x are not sampled at the same times"));
  EXPECT_THAT(error_of([&] { take_metric(metric("profile", "a/three", "a/x"), run.path()); }),
              HasSubstr("a/three and a/x differ in the number of values per sample"));
}

TEST_F(Metrics, MissingChannelsAreReported) {
  EXPECT_THAT(error_of([&] { value(metric("last", "walls/force")); }),
              HasSubstr("there is no probe \"walls\"; the probes are test"));
  EXPECT_THAT(error_of([&] { value(metric("last", "test/z")); }),
              HasSubstr("probe \"test\" has no channel \"z\"; its channels are profile, step, time, x, y"));
  EXPECT_THAT(error_of([&] { take_metric(metric("last"), folder / "nowhere"); }), HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace grit
