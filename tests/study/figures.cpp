#include "study/figures.hpp"

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

FigureDescription figure(const std::string& type, const std::string& of = "test/y",
                         const std::string& against = "test/x") {
  FigureDescription figure;
  figure.what.choose(type);
  figure.of = of, figure.against = against;
  return figure;
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
class Figures : public testing::Test {
 protected:
  Figures() { make_series(folder.path(), {0, 1, 2, 3, 5}, {0, 1, 4, 9, 4}); }
  double value(const FigureDescription& figure) const { return take_figure(figure, folder.path()).y.at(0); }
  OwnFolder folder;
};

TEST_F(Figures, AreTheExtremesAndTheEnd) {
  EXPECT_EQ(value(figure("maximum")), 9);
  EXPECT_EQ(value(figure("place-of-maximum")), 3);
  EXPECT_EQ(value(figure("minimum")), 0);
  EXPECT_EQ(value(figure("last")), 4);
  EXPECT_EQ(take_figure(figure("maximum"), folder.path()).unit, "Pa");
  EXPECT_EQ(take_figure(figure("place-of-maximum"), folder.path()).unit, "m");
}

TEST_F(Figures, MeanIsOverTheAbscissaNotTheSamples) {
  auto last_two_fifths = figure("mean");
  std::get<MeanFigure>(last_two_fifths.what.value()).share = 0.4;
  EXPECT_DOUBLE_EQ(value(last_two_fifths), 6.5);
  auto all = figure("mean");
  std::get<MeanFigure>(all.what.value()).share = 1;
  EXPECT_DOUBLE_EQ(value(all), (0.5 + 2.5 + 6.5 + 13) / 5);
}

TEST_F(Figures, ValueIsReadBetweenSamples) {
  auto one = figure("value");
  std::get<ValueFigure>(one.what.value()).at = 2.5;
  EXPECT_DOUBLE_EQ(value(one), 6.5);
  std::get<ValueFigure>(one.what.value()).at = 6;
  EXPECT_THAT(error_of([&] { value(one); }), HasSubstr("test/y is of abscissae from 0 to 5, but wanted at 6"));
}

TEST_F(Figures, AbscissaIsTimeUnlessItIsNamed) {
  EXPECT_DOUBLE_EQ(value(figure("place-of-maximum", "test/y", "")), 0.3);
}

TEST_F(Figures, AProfileIsTheLastSample) {
  const Figure profile = take_figure(figure("profile", "test/profile", ""), folder.path());
  EXPECT_THAT(profile.x, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(profile.y, ElementsAre(0, 1, 4, 9, 4));
  EXPECT_THAT(error_of([&] { take_figure(figure("last", "test/profile"), folder.path()); }),
              HasSubstr("which only a profile takes"));
  const double unknown = std::nan("");
  make_series(folder / "unknown", {0, 1}, {unknown, unknown});
  EXPECT_THAT(error_of([&] { take_figure(figure("profile", "test/profile", ""), folder / "unknown"); }),
              HasSubstr("test/profile has no finite number"));
}

TEST_F(Figures, ExtremesAndTheEndAreOfAllSamplesWhereverTheAbscissaGoes) {
  make_series(folder.path(), {0, 2, 1, 0.5}, {1, 3, 7, -4});
  EXPECT_EQ(value(figure("maximum")), 7);
  EXPECT_EQ(value(figure("place-of-maximum")), 1);
  EXPECT_EQ(value(figure("minimum")), -4);
  EXPECT_EQ(value(figure("last")), -4);
}

TEST_F(Figures, ACurveLeavesOutWayThatWasGoneBefore) {
  make_series(folder / "back", {0, 1, 0.5, 2}, {0, 1, 7, 2});
  const Figure curve = take_figure(figure("curve"), folder / "back");
  EXPECT_THAT(curve.x, ElementsAre(0, 1, 2));
  EXPECT_THAT(curve.y, ElementsAre(0, 1, 2));
}

TEST_F(Figures, AreOfOneInstantAndAsLongAsTheirAbscissa) {
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
  EXPECT_THAT(take_figure(figure("curve", "same/y", "a/x"), run.path()).x, ElementsAre(0, 0.1, 0.2));
  EXPECT_THAT(error_of([&] { take_figure(figure("curve", "later/y", "a/x"), run.path()); }),
              HasSubstr("later/y and a/x are not of the same instants"));
  EXPECT_THAT(error_of([&] { take_figure(figure("profile", "a/three", "a/x"), run.path()); }),
              HasSubstr("a/three and a/x do not have as many numbers a sample"));
}

TEST_F(Figures, WhatIsNotThereIsTold) {
  EXPECT_THAT(error_of([&] { value(figure("last", "walls/force")); }),
              HasSubstr("there is no probe \"walls\" but test"));
  EXPECT_THAT(error_of([&] { value(figure("last", "test/z")); }),
              HasSubstr("probe \"test\" has no channel \"z\" but profile, step, time, x, y"));
  EXPECT_THAT(error_of([&] { take_figure(figure("last"), folder / "nowhere"); }), HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace grit
