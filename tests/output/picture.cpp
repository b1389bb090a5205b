#include "output/picture.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "fake_world.hpp"
#include "folder.hpp"
#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "output/grain_view.hpp"
#include "output/scale.hpp"
#include "output/svg.hpp"
#include "svg_elements.hpp"

namespace grit::picture_tests {
namespace {

using testing::AnyOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pointwise;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Svg, HoldsNoBytesThatXmlCannotHold) {
  EXPECT_EQ(escaped("<a> & \"b\"\n\t\u00e9"), "&lt;a&gt; &amp; &quot;b&quot;\n\t\u00e9");
  EXPECT_EQ(escaped("a\xff<"), "a\\xff&lt;");
  EXPECT_EQ(escaped("a\x01&"), "a\\x01&amp;");
}

TEST(Scale, TicksAreMultiplesOfOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(nice_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(nice_step(1, 10), 0.1);
  EXPECT_DOUBLE_EQ(nice_step(2600, 5), 500);
  EXPECT_DOUBLE_EQ(nice_step(4e-3, 5), 1e-3);
  EXPECT_THAT(ticks(0, 1, 5), Pointwise(DoubleNear(1e-12), std::vector{0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_THAT(ticks(-0.3, 0.71, 5), Pointwise(DoubleNear(1e-12), std::vector{-0.2, 0.0, 0.2, 0.4, 0.6}));
  EXPECT_THAT(ticks(3, 3, 5), ElementsAre(3));
}

// Ranges of all sizes, aligned with steps and not, around zero and far from it.
TEST(Scale, AxesHaveFourToEightTicks) {
  for (double span = 1e-6; span < 1e6; span *= 1.07)
    for (const double from : {0.0, -0.37, 0.93, -1.0, 5.77})
      for (const AxisEnds ends : {AxisEnds::kept, AxisEnds::whole_steps}) {
        const double low = from * span, high = low + span;
        const AxisTicks axis = axis_ticks(low, high, ends);
        ASSERT_GE(axis.marks.size(), 4u) << low << ' ' << high;
        ASSERT_LE(axis.marks.size(), 8u) << low << ' ' << high;
        const double lead = axis.step / std::pow(10, std::floor(std::log10(axis.step) + 1e-9));
        EXPECT_TRUE(std::abs(lead - 1) < 1e-9 || std::abs(lead - 2) < 1e-9 || std::abs(lead - 5) < 1e-9) << axis.step;
        for (std::size_t i = 0; i < axis.marks.size(); ++i) {
          EXPECT_NEAR(axis.marks[i] / axis.step, std::round(axis.marks[i] / axis.step), 1e-6);
          if (i > 0) EXPECT_NEAR(axis.marks[i] - axis.marks[i - 1], axis.step, 1e-6 * axis.step);
        }
        EXPECT_LE(axis.low, low + 1e-8 * span);
        EXPECT_GE(axis.high, high - 1e-8 * span);
        EXPECT_GE(axis.marks.front(), axis.low - 1e-8 * span);
        EXPECT_LE(axis.marks.back(), axis.high + 1e-8 * span);
        if (ends == AxisEnds::kept) continue;
        EXPECT_EQ(axis.marks.front(), axis.low);
        EXPECT_NEAR(axis.marks.back(), axis.high, 1e-9 * span);
      }
}

TEST(Scale, AxesAreAsFineAsNumbersFit) {
  EXPECT_DOUBLE_EQ(axis_ticks(0, 3, AxisEnds::kept).step, 0.5);
  EXPECT_DOUBLE_EQ(axis_ticks(0, 7, AxisEnds::kept).step, 1);
  EXPECT_DOUBLE_EQ(axis_ticks(0, 7, AxisEnds::kept, [](const AxisTicks& axis) { return axis.step >= 2; }).step, 2);
  EXPECT_EQ(axis_ticks(0, 7, AxisEnds::kept, [](const AxisTicks&) { return false; }).marks.size(), 4u) << "0 2 4 6";
}

// A range as narrow as the rounding error of its ends has no steps.
TEST(Scale, AxesEndWhereNumbersDo) {
  EXPECT_LE(axis_ticks(1e10, 1e10 + 4e-6, AxisEnds::whole_steps).marks.size(), 8u);
  for (const AxisEnds ends : {AxisEnds::kept, AxisEnds::whole_steps}) {
    for (const double low : {1.0, -3e-7, 0.0, std::numeric_limits<double>::quiet_NaN(), -HUGE_VAL, -1e308})
      for (const double high : {std::nextafter(low, 2.0), low, HUGE_VAL, 1e308}) {
        const AxisTicks axis = axis_ticks(low, high, ends);
        EXPECT_GE(axis.marks.size(), 4u) << low << " … " << high;
        EXPECT_LE(axis.marks.size(), 8u) << low << " … " << high;
        EXPECT_LT(axis.low, axis.high);
      }
  }
}

TEST(Scale, LabelsAreShort) {
  EXPECT_EQ(tick_label(0.6000000001, 0.2), "0.6");
  EXPECT_EQ(tick_label(-20, 10), "−20");
  EXPECT_EQ(tick_label(-1e-17, 0.2), "0");
  EXPECT_EQ(short_number(0.8234), "0.823");
  EXPECT_EQ(short_number(1234.5), "1234");
  EXPECT_EQ(axis_title("stress ratio", "1"), "stress ratio");
}

TEST(Scale, UnitsAreReadable) {
  EXPECT_EQ(readable("m", 0.004).unit, "mm");
  EXPECT_DOUBLE_EQ(readable("m", 0.004).factor, 1e3);
  EXPECT_EQ(readable("m", 4000).unit, "m");
  EXPECT_EQ(readable("Pa", 2e5).unit, "kPa");
  EXPECT_DOUBLE_EQ(readable("Pa", 2e5).factor, 1e-3);
  EXPECT_DOUBLE_EQ(readable("rad", 1).factor * std::acos(-1.0), 180);
  EXPECT_EQ(readable("1", 1e6).factor, 1);
  EXPECT_EQ(readable("kg", 0.02).unit, "g");
  EXPECT_EQ(readable("kg s-1", 0.02).unit, "g/s");
  EXPECT_EQ(readable("kg s-1", 0.02).factor, 1e3);
  EXPECT_EQ(readable("kg", 2).unit, "kg");
  EXPECT_EQ(readable("kg m-3", 0.02).unit, "kg/m³");
  EXPECT_EQ(readable("N m-3", 2.6e4).unit, "kN/m³");
  EXPECT_DOUBLE_EQ(readable("N m-3", 2.6e4).factor, 1e-3);
  EXPECT_EQ(readable("m s-1", 0.02).unit, "mm/s");
  EXPECT_EQ(readable("m s-1", 2000).unit, "m/s");
  EXPECT_EQ(readable("Pa2 Hz-1", 1e9).unit, "Pa²/Hz") << "a prefix would be squared";
  EXPECT_EQ(readable("degree", 1).unit, "°");
  EXPECT_EQ(readable("m", 1e-9).unit, "µm");
  EXPECT_EQ(readable("N m", 0).unit, "N m");
}

TEST(Scale, UnitsAreWrittenForDisplay) {
  const std::pair<const char*, const char*> all[] = {{"m s-1", "m/s"},
                                                     {"m/s", "m/s"},
                                                     {"m.s-1", "m/s"},
                                                     {"degree", "°"},
                                                     {"kN m-3", "kN/m³"},
                                                     {"m2", "m²"},
                                                     {"m^2/s", "m²/s"},
                                                     {"kg m-2 s-1", "kg/(m² s)"},
                                                     {"s-1", "1/s"},
                                                     {"1/s", "1/s"},
                                                     {"Pa2 Hz-1", "Pa²/Hz"},
                                                     {"N m", "N m"},
                                                     {"m-12", "1/m¹²"},
                                                     {"1", "1"},
                                                     {"", "1"},
                                                     {"%", "%"},
                                                     {"rad/s", "rad/s"},
                                                     {"J m0", "J"}};
  for (const auto& [unit, written] : all) EXPECT_EQ(written_unit(unit), written) << unit;
  for (const char* other : {"100 Pa", "m**2", "m2s", "m//s", "m/", "m-", "degree from here-1-2"})
    EXPECT_EQ(written_unit(other), other) << "not understood, and therefore unchanged";
}

TEST(Scale, NamesAreWrittenForDisplay) {
  EXPECT_EQ(spelled("shear_stress"), "shear stress");
  EXPECT_EQ(spelled("sigma_1"), "σ₁");
  EXPECT_EQ(spelled("sigma_12_left"), "σ₁₂ left");
  EXPECT_EQ(spelled("mu_eff"), "μ_eff");
  EXPECT_EQ(spelled("sigma_left"), "σ left");
  EXPECT_EQ(spelled("gradient_strip_1"), "gradient strip 1");
  EXPECT_EQ(spelled("sigmas"), "sigmas");
  EXPECT_EQ(channel_label("slip", "fraction"), "slip: fraction");
  EXPECT_EQ(channel_label("test", "sigma_1"), "σ₁");
  EXPECT_EQ(channel_label("packing", "time"), "time");
  EXPECT_EQ(with_symbols("asin((sigma_1 - sigma_3) / a_1), mu_eff: not mu, nor shear_stress"),
            "asin((σ₁ - σ₃) / a_1), μ_eff: not mu, nor shear_stress");
}

TEST(Scale, TimesHaveAUnitThatReadsWell) {
  EXPECT_EQ(written_time(0.06923), "69.23 ms");
  EXPECT_EQ(written_time(12), "12 s");
  EXPECT_EQ(written_time(123456), "123456 s");
  EXPECT_EQ(written_time(9999.7), "10000 s");
  EXPECT_EQ(written_time(2.5e-6), "2.5 µs");
  EXPECT_EQ(written_time(0), "0 s");
}

std::vector<double> ys_of(const SvgElement& polyline) {
  std::istringstream points(polyline.get<std::string>("<xmlattr>.points"));
  std::vector<double> ys;
  double x, y;
  char comma;
  while (points >> x >> comma >> y) ys.push_back(y);
  return ys;
}

TEST(Picture, HasACurvePerRunAndMarksThePeak) {
  Picture picture{.title = "dense & loose <sand>", .facts = "facts", .panels = {}, .grains = {}};
  picture.panels.push_back({{"shear displacement", "m"},
                            {"stress ratio"},
                            {{"dense", {0, 1e-3, 2e-3, 3e-3}, {0, 0.87, 0.7, 0.6}}, {"loose", {0, 3e-3}, {0, 0.55}}}});
  picture.panels.push_back(
      {{"shear displacement", "m"}, {"dilation", "m"}, {{"dense", {0, 1e-3, 2e-3, 3e-3}, {0, 1e-4, nan, 2e-4}}}});
  const auto svg = parsed(draw(picture));
  EXPECT_EQ(svg.get<std::string>("svg.title"), picture.title);
  const auto curves = elements(svg, "polyline", "curve");
  ASSERT_EQ(curves.size(), 4u) << "a number that is not finite interrupts";
  const auto dense = ys_of(curves[0]);
  ASSERT_EQ(dense.size(), 4u);
  EXPECT_NEAR((dense[0] - dense[2]) / (dense[0] - dense[1]), 0.7 / 0.87, 1e-3) << "drawn to scale, upwards";
  EXPECT_EQ(elements(svg, "polyline", "k0").size(), 3u);
  EXPECT_EQ(elements(svg, "polyline", "k1").size(), 1u);
  const auto peaks = elements(svg, "text", "peak");
  ASSERT_EQ(peaks.size(), 3u);
  EXPECT_EQ(peaks[0].data(), "0.870");
  EXPECT_EQ(peaks[1].data(), "0.550");
  EXPECT_EQ(peaks[2].data(), "200");
  EXPECT_THAT(draw(picture), testing::AllOf(HasSubstr("shear displacement [mm]"), HasSubstr("dilation [µm]")));
}

TEST(Picture, MarksNoSpikesOfNoise) {
  const auto labels = [](double height, int wide) {
    Curve curve{.name = "", .x = {}, .y = {}};
    for (int i = 0; i <= 400; ++i) {
      curve.x.push_back(i);
      const double round = 1 - (i - 200) * (i - 200) / 160e3;  // from 0.75 to 1 and back
      curve.y.push_back(round + (std::abs(i - 300) <= wide ? height : 0.0));
    }
    Picture picture{.title = "", .facts = "", .panels = {{{"time"}, {"ratio"}, {curve}}}, .grains = {}};
    std::vector<std::string> words;
    for (const auto& text : elements(parsed(draw(picture)), "text", "peak")) words.push_back(text.data());
    return words;
  };
  EXPECT_THAT(labels(0, 0), testing::ElementsAre("1.00"));
  EXPECT_THAT(labels(0.2, 0), testing::IsEmpty()) << "one point of 400";
  EXPECT_THAT(labels(0.2, 8), testing::ElementsAre("1.15")) << "a plateau of 4 %";
}

TEST(Picture, HasTicksOnBothAxesThatDoNotTouch) {
  for (const std::size_t panels : {1u, 2u, 3u, 6u}) {
    Picture picture{.title = "", .facts = "", .panels = {}, .grains = {}};
    for (std::size_t i = 0; i < panels; ++i)
      picture.panels.push_back({{"strain"}, {"force", "N"}, {{"", {0, 1.7e-3, 3.1e-3}, {0, 1234, 987}}}});
    const auto svg = parsed(draw(picture));
    // Numbers below the axes are in rows of panels: those of one panel increase.
    std::size_t ticks = 0;
    double last = -1, row = -1;
    for (const auto& text : elements(svg, "text", "m")) {
      if (text_of(text, "class") != "m") continue;
      const double x = number_of(text, "x"), y = number_of(text, "y");
      if (y != row || x < last) last = -1;
      if (last >= 0) EXPECT_GT(x - last, 6 * static_cast<double>(text.data().size())) << text.data();
      ++ticks, last = x, row = y;
    }
    EXPECT_GE(ticks, 4 * panels) << panels;
    EXPECT_LE(ticks, 8 * panels) << panels;
    const std::size_t across = elements(svg, "text", "e").size();
    EXPECT_GE(across, 4 * panels) << panels;
    EXPECT_LE(across, 8 * panels) << panels;
  }
}

TEST(Picture, HasRoomForTheTitlesOfItsPanels) {
  Picture picture{.title = "", .facts = "", .panels = {}, .grains = {}};
  for (const char* label : {"strain", "force", "force-chains: tangential force anisotropy"})
    picture.panels.push_back({{"time", "s"}, {label, "N"}, {{"", {0, 1}, {0, 1}}}});
  const auto titles = elements(parsed(draw(picture)), "text", "axis");
  ASSERT_EQ(titles.size(), 6u) << "of y and x of each";
  EXPECT_EQ(number_of(titles[0], "y"), number_of(titles[2], "y"));
  EXPECT_GT(number_of(titles[4], "y"), number_of(titles[2], "y")) << "below, where it has half of the width";
}

TEST(Picture, ShowsReferencesBesideRuns) {
  Picture picture{.title = "", .facts = "", .panels = {}, .grains = {}};
  const Curve run{.name = "dense", .x = {0, 1, 2}, .y = {0, 0.8, 0.6}},
      value{.name = "peak of the thesis", .x = {0, 2}, .y = {0.9, 0.9}, .reference = true},
      measured{.name = "measured", .x = {0, 1}, .y = {0, 0.7}, .reference = true};
  picture.panels.push_back({{"u", "m"}, {"ratio"}, {run, value, measured}});
  const auto svg = parsed(draw(picture));
  ASSERT_EQ(elements(svg, "polyline", "r0").size(), 1u);
  EXPECT_EQ(elements(svg, "polyline", "r1").size(), 1u);
  EXPECT_EQ(elements(svg, "polyline", "k0").size(), 1u);
  const auto level = ys_of(elements(svg, "polyline", "r0")[0]), curve = ys_of(elements(svg, "polyline", "k0")[0]);
  EXPECT_EQ(level[0], level[1]);
  EXPECT_NEAR((curve[0] - level[0]) / (curve[0] - curve[1]), 0.9 / 0.8, 1e-3) << "on the same axis";
  EXPECT_THAT(words_of(svg), testing::IsSupersetOf({"dense", "peak of the thesis", "measured"}));
  EXPECT_EQ(elements(svg, "text", "peak").size(), 1u) << "of the run alone";
  EXPECT_THAT(svg.get<std::string>("svg.style"), HasSubstr(".r0{stroke:#666;stroke-dasharray:2 4}"));
  EXPECT_EQ(
      elements(svg, "line", "r0").size() + elements(svg, "line", "r1").size() + elements(svg, "line", "k0").size(), 3u)
      << "in the legend";
}

TEST(Picture, WrapsALegendOfManyNames) {
  Picture picture{.title = "", .facts = "", .panels = {}, .grains = {}};
  picture.panels.push_back({{"x"}, {"y"}, {}});
  for (int i = 0; i < 12; ++i)
    picture.panels[0].curves.push_back(
        {.name = "a run of a long name, number " + std::to_string(i), .x = {0, 1}, .y = {0, 1}});
  const auto svg = parsed(draw(picture));
  double lowest = 0, top = 1e9;
  for (const auto& text : elements(svg, "text")) {
    if (!text.data().starts_with("a run of")) continue;
    lowest = std::max(lowest, number_of(text, "y"));
    EXPECT_LT(number_of(text, "x") + 6 * static_cast<double>(text.data().size()), 900) << text.data();
  }
  for (const auto& line : elements(svg, "line", "grid")) top = std::min(top, number_of(line, "y1"));
  EXPECT_GT(lowest, 110) << "in several rows";
  EXPECT_LT(lowest, top) << "above the curves";
}

TEST(Picture, DrawsLinksOverFaintGrains) {
  GrainView view;
  view.discs = {{0, 0, 0.5, nan}, {1, 0, 0.5, nan}};
  EXPECT_EQ(elements(parsed(draw({.title = "", .facts = "", .panels = {}, .grains = view})), "g", "faint").size(), 0u);
  view.links = {{0, 0, 1, 0, 1}, {1, 0, 1, 0.2, 0.5}};
  const auto svg = parsed(draw({.title = "", .facts = "", .panels = {}, .grains = view}));
  EXPECT_EQ(elements(svg, "g", "faint").size(), 1u);
  const auto links = elements(svg, "line", "link"), discs = elements(svg, "circle");
  ASSERT_EQ(links.size(), 2u);
  EXPECT_NEAR(number_of(links[0], "x1"), number_of(discs[0], "cx"), 0.02);
  EXPECT_NEAR(number_of(links[0], "x2"), number_of(discs[1], "cx"), 0.02);
  EXPECT_NEAR(number_of(links[0], "stroke-width"), 2 * number_of(links[1], "stroke-width"), 0.02);
}

TEST(Picture, DrawsGrainsToScaleAndRedForPositive) {
  GrainView view;
  view.value = {"rotation", "rad"};
  view.discs = {{0, 0, 0.1, 1}, {1, 0, 0.2, -1}, {2, 0, 0.1, 0}, {2, 1, 0.1, nan}, {nan, nan, 0.1, 0}};
  view.walls = {{0, -0.2, 2, -0.2}, {2, -0.2, 0, -0.2}, {1, 0, 1, 0}};
  const auto svg = parsed(draw({.title = "grains", .facts = "", .panels = {}, .grains = view}));
  const auto discs = elements(svg, "circle");
  ASSERT_EQ(discs.size(), 4u);
  const auto number = [&](std::size_t i, const char* name) {
    return discs[i].get<double>(std::string("<xmlattr>.") + name);
  };
  EXPECT_NEAR(number(1, "r"), 2 * number(0, "r"), 0.02);
  EXPECT_NEAR(number(1, "cx") - number(0, "cx"), 10 * number(0, "r"), 0.1);
  EXPECT_NEAR(number(2, "cy") - number(3, "cy"), 10 * number(0, "r"), 0.1);
  EXPECT_EQ(discs[0].get<std::string>("<xmlattr>.class"), "c20");
  EXPECT_EQ(discs[1].get<std::string>("<xmlattr>.class"), "c0");
  EXPECT_EQ(discs[2].get<std::string>("<xmlattr>.class"), "c10");
  EXPECT_EQ(discs[3].get<std::string>("<xmlattr>.class"), "n");
  EXPECT_EQ(elements(svg, "line", "wall").size(), 1u) << "once each, and none without length";
  const auto style = svg.get<std::string>("svg.style");
  EXPECT_THAT(style, testing::AllOf(HasSubstr(".c20{fill:#a01228}"), HasSubstr(".c0{fill:#144e8c}"))) << "red, blue";
}

TEST(Picture, GoesFromDarkToBrightWhereNothingIsNegative) {
  GrainView view;
  view.value = {"speed", "m/s"}, view.symmetric = false;
  for (int i = 0; i < 100; ++i) view.discs.push_back({1.0 * i, 0, 0.5, 1.0 * i});
  const auto svg = parsed(draw({.title = "", .facts = "", .panels = {}, .grains = view}));
  EXPECT_EQ(text_of(elements(svg, "circle").front(), "class"), "c0");
  EXPECT_EQ(text_of(elements(svg, "circle").back(), "class"), "c20");
  EXPECT_THAT(svg.get<std::string>("svg.style"),
              testing::AllOf(HasSubstr(".c0{fill:#440154}"), HasSubstr(".c20{fill:#fde725}")));
}

/// Classes of the colours of grains with these values.
std::vector<std::string> classes(const std::vector<double>& values, bool symmetric, const ScaleEnds& ends) {
  GrainView view;
  view.value = {"speed", "m/s"}, view.symmetric = symmetric, view.ends = ends;
  for (const double value : values) view.discs.push_back({value, 0, 0.1, value});
  std::vector<std::string> all;
  for (const auto& disc : elements(parsed(draw({.title = "", .facts = "", .panels = {}, .grains = view})), "circle"))
    all.push_back(text_of(disc, "class"));
  return all;
}

TEST(Picture, HasAColourScaleWithGivenEnds) {
  EXPECT_THAT(classes({0, 1, 2, 100}, false, {.low = {}, .high = 2}), ElementsAre("c0", "c10", "c20", "c20"));
  EXPECT_THAT(classes({0, 1, 2, 100}, false, {.low = 1, .high = 2}), ElementsAre("c0", "c0", "c20", "c20"));
  EXPECT_THAT(classes({-1, 0, 2, 100}, true, {.low = {}, .high = 2}), ElementsAre("c5", "c10", "c20", "c20"))
      << "symmetric";
  EXPECT_THAT(classes({0, 1}, false, {.low = 3, .high = {}}), ElementsAre("c0", "c0")) << "never empty";
}

TEST(Picture, LeavesNoRoomForWallsThatAreFarAway) {
  GrainView view;
  view.discs = {{0, 0, 0.5, nan}, {9, 9, 0.5, nan}};
  view.walls = {{0, -1, 9, -1}};
  const std::string near = draw({.title = "", .facts = "", .panels = {}, .grains = view});
  view.walls.push_back({0, -100, 9, -100});
  const auto with = elements(parsed(draw({.title = "", .facts = "", .panels = {}, .grains = view})), "circle");
  const auto without = elements(parsed(near), "circle");
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(with[i].get<double>("<xmlattr>.r"), without[i].get<double>("<xmlattr>.r"));
}

TEST(Picture, HasAColourPerLayer) {
  GrainView view;
  view.value = {"layer", "1"};
  view.symmetric = false, view.layers = 3;
  for (const double layer : {1.0, 2.0, 3.0, nan}) view.discs.push_back({layer, 0, 0.1, layer});
  view.discs.back().x = 0;
  const auto svg = parsed(draw({.title = "layers", .facts = "", .panels = {}, .grains = view}));
  std::vector<std::string> classes, words;
  for (const auto& disc : elements(svg, "circle")) classes.push_back(disc.get<std::string>("<xmlattr>.class"));
  EXPECT_THAT(classes, ElementsAre("c0", "c1", "c2", "n"));
  for (const auto& text : elements(svg, "text")) words.push_back(text.data());
  EXPECT_THAT(words, testing::IsSupersetOf({"layer", "1", "2", "3"}));
  EXPECT_THAT(svg.get<std::string>("svg.style"),
              testing::AllOf(HasSubstr(".c0{fill:#440154}"), HasSubstr(".c2{fill:#fde725}"),
                             testing::Not(HasSubstr(".c3{fill"))));
}

/// A view like that of a tall narrow silo.
GrainView column_of_grains() {
  GrainView view;
  view.value = {"displacement", "m"}, view.note = "x +";
  for (int i = 0; i < 60; ++i) view.discs.push_back({0.1 * (i % 6), 0.4 * (i / 6), 0.05, 1e-3 * i});
  return view;
}

TEST(Picture, FitsItsFrameToTheGrains) {
  const GrainView view = column_of_grains();
  const auto svg = parsed(draw({.title = "a silo", .facts = "60 grains", .panels = {}, .grains = view}));
  const double width = number_of(svg.get_child("svg"), "width");
  EXPECT_EQ(width, 420);
  EXPECT_EQ(number_of(elements(svg, "rect").at(0), "width"), width) << "white as far as it goes";
  double right = 0, bar = 1e9;
  for (const auto& disc : elements(svg, "circle"))
    right = std::max(right, number_of(disc, "cx") + number_of(disc, "r"));
  for (const auto& piece : elements(svg, "rect", "c0")) bar = std::min(bar, number_of(piece, "x"));
  EXPECT_GT(bar, right + 10);
  EXPECT_LT(bar, right + 40) << "the colour bar is beside the view";
  for (const auto& text : elements(svg, "text", "axis")) {
    EXPECT_EQ(text.data(), "displacement [mm]");
    EXPECT_GE(number_of(text, "x"), bar);
    EXPECT_LT(number_of(text, "x") + 7.0 * 17, width);
  }
}

TEST(Picture, HasNoWordsOverTheLengthOfANarrowView) {
  const auto svg = parsed(draw({.title = "", .facts = "", .panels = {}, .grains = column_of_grains()}));
  double bar = 0;
  for (const auto& line : elements(svg, "line", "scale")) bar = std::max(bar, number_of(line, "y1"));
  for (const auto& text : elements(svg, "text", "small"))
    if (text.data().starts_with("x →")) EXPECT_GT(number_of(text, "y"), bar + 10) << "in a line of its own";
}

TEST(Picture, HasNoSpaceForAMissingColourBar) {
  GrainView view;
  for (int i = 0; i < 10; ++i) view.discs.push_back({1.0 * i, 0, 0.5, nan});
  const auto svg = parsed(draw({.title = "", .facts = "", .panels = {}, .grains = view}));
  double right = 0;
  for (const auto& disc : elements(svg, "circle"))
    right = std::max(right, number_of(disc, "cx") + number_of(disc, "r"));
  EXPECT_NEAR(right, number_of(svg.get_child("svg"), "width") - 36, 0.1);
}

TEST(Picture, WrapsTitleAndFacts) {
  std::string facts = "1 000 grains";
  for (int i = 0; i < 20; ++i) facts += "  ·  run-" + std::to_string(i) + ": done";
  const Picture picture{.title = "a title that is far longer than a picture of a silo can be wide, with μ = 0.5",
                        .facts = facts,
                        .panels = {},
                        .grains = column_of_grains()};
  const auto svg = parsed(draw(picture));
  EXPECT_EQ(svg.get<std::string>("svg.title"), picture.title) << "as it is";
  std::string title, told;
  double lowest = 0;
  for (const auto& line : elements(svg, "text", "title")) {
    title += (title.empty() ? "" : " ") + line.data();
    EXPECT_LT(36 + 11 * static_cast<double>(line.data().size()), 420);
  }
  EXPECT_EQ(title, picture.title);
  for (const auto& line : elements(svg, "text", "facts")) {
    told += (told.empty() ? "" : "  ·  ") + line.data();
    EXPECT_LT(36 + 6.5 * static_cast<double>(line.data().size()), 420 + 36);  // the dot is two bytes
    EXPECT_GT(number_of(line, "y"), lowest);
    lowest = number_of(line, "y");
  }
  EXPECT_EQ(told, facts);
  for (const auto& disc : elements(svg, "circle")) EXPECT_GT(number_of(disc, "cy") - number_of(disc, "r"), lowest + 10);
}

TEST(Picture, StaysSmallForManyGrains) {
  GrainView view;
  for (int i = 0; i < 55000; ++i) view.discs.push_back({(i % 300) * 1.37, (i / 300) * 1.37, 0.5, std::sin(0.1 * i)});
  EXPECT_LT(draw({.title = "many", .facts = "", .panels = {}, .grains = view}).size(), 5'000'000u);
}

TEST(Picture, CopesWithNothing) {
  Picture picture{.title = "",
                  .facts = "",
                  .panels = {{{"x"}, {"y"}, {{"", {}, {}}, {"flat", {1, 1}, {2, 2}}}}},
                  .grains = GrainView{}};
  EXPECT_THAT(draw(picture), testing::Not(HasSubstr("nan")));
  EXPECT_THAT(draw(picture), testing::Not(HasSubstr("inf")));
}

// Invalid values do not affect the rest, and no number is written that a browser cannot read.
TEST(Picture, CopesWithHugeNumbers) {
  const double huge = 1e300;
  Curve curve{"run", {}, {}};
  for (int i = 0; i <= 10; ++i) curve.x.push_back(i), curve.y.push_back(0.1 * i);
  GrainView view;
  for (int i = 0; i < 5; ++i) view.discs.push_back({1.0 * i, 0.5 * i, 0.5, 0.1 * i});
  view.walls = {{0, -0.5, 4, -0.5}, {-1000, 1, 1000, 1}};
  view.links = {{0, 0, 1, 0.5, 1}};
  const auto drawn = [&] {
    return draw({.title = "", .facts = "", .panels = {{{"x"}, {"y"}, {curve}}}, .grains = view});
  };
  const auto whole = parsed(drawn());

  curve.x.insert(curve.x.begin() + 11, {huge, 11}), curve.y.insert(curve.y.begin() + 11, {0.5, -huge});
  view.discs.push_back({huge, 0, 0.5, 0}), view.discs.push_back({2, 1, huge, 0});
  view.discs[0].value = huge;
  view.walls[1] = {-1e25, 1, 1e25, 1}, view.walls.push_back({-huge, 0, huge, 0});
  view.links.push_back({0, 0, huge, huge, huge});
  const std::string text = drawn();
  EXPECT_THAT(text, Not(AnyOf(HasSubstr("e+"), HasSubstr("inf"), HasSubstr("nan"))));
  const auto strayed = parsed(text);
  EXPECT_EQ(elements(strayed, "polyline", "").size(), 1u);
  EXPECT_EQ(text_of(elements(strayed, "polyline", "").at(0), "points"),
            text_of(elements(whole, "polyline", "").at(0), "points"));
  const auto wall = [](const auto& picture, std::size_t i) { return elements(picture, "line", "wall").at(i); };
  EXPECT_EQ(number_of(wall(strayed, 0), "x2"), number_of(wall(whole, 0), "x2"));
  ASSERT_EQ(elements(strayed, "line", "wall").size(), 2u);
  EXPECT_LT(number_of(wall(strayed, 1), "x1"), 0) << "goes through the picture";
  EXPECT_GT(number_of(wall(strayed, 1), "x2"), 900);
}

TEST(Picture, CopesWithOnlyHugeNumbers) {
  const std::vector<double> most(3, 1.7e308), large{1e29, 1e29, 1e29};
  for (const auto& numbers : {most, large}) {
    GrainView view;
    view.discs.assign(3, {numbers[0], -numbers[0], 0.5, numbers[0]});
    const Curve curve{"run", numbers, {numbers[0], -numbers[0], 0}};
    const std::string text = draw({.title = "", .facts = "", .panels = {{{"x"}, {"y"}, {curve}}}, .grains = view});
    EXPECT_THAT(text, Not(AnyOf(HasSubstr("inf"), HasSubstr("nan"))));
  }
}

TEST(Scale, TicksEndWhereNumbersHaveNoDigitsLeft) {
  EXPECT_THAT(ticks(1e300, std::nextafter(1e300, 2e300), 7), ElementsAre(1e300));
  EXPECT_THAT(ticks(-1.7e308, 1.7e308, 7), ElementsAre(-1.7e308));
}

TEST(GrainView, OmitsOutliers) {
  NumberedWorld world;
  for (std::uint32_t i = 0; i <= 9; ++i) world.add(i, {0.1 * i, i / 9.0, 0}, 0.01);
  const auto whole = grain_view(world, {}, "xz", "speed");
  EXPECT_EQ(whole.left_out, 0u);
  world.add(10, {0, 1e300, 0}, 0.01), world.add(11, {-1e20, 0.5, 0}, 0.01), world.add(12, {0, 0.5, 1000}, 0.01);
  world.add(13, {0, 0.5, 0}, 1e300);
  const auto seen = grain_view(world, {}, "xz", "speed");
  EXPECT_EQ(seen.left_out, 4u);
  ASSERT_EQ(seen.discs.size(), whole.discs.size());
  for (std::size_t i = 0; i < seen.discs.size(); ++i) EXPECT_EQ(seen.discs[i].x, whole.discs[i].x);
  EXPECT_THAT(draw({.title = "", .facts = "10 grains", .panels = {}, .grains = seen}),
              HasSubstr("10 grains  ·  4 outliers not shown"));
  world.add(14, {0.5, 0.5, 1.5}, 1.4);
  EXPECT_EQ(grain_view(world, {}, "xz", "speed").left_out, 4u) << "large, and on top of the others";
}

TEST(GrainView, IsSeenAlongTheAxisWithClockwiseRotationsPositive) {
  NumberedWorld world;
  world.add(1, {1, 0, 3}, 0.1);
  world.rotation = {Vec3(0.1, 0.2, 0.3)};
  const auto front = grain_view(world, {}, "xz", "rotation").discs.at(0);
  EXPECT_THAT((std::array{front.x, front.y, front.value}), ElementsAre(1, 3, 0.2));
  const auto above = grain_view(world, {}, "xy", "rotation").discs.at(0);
  EXPECT_THAT((std::array{above.x, above.y, above.value}), ElementsAre(1, 0, -0.3));
  const auto side = grain_view(world, {}, "yz", "rotation").discs.at(0);
  EXPECT_THAT((std::array{side.x, side.y, side.value}), ElementsAre(0, 3, -0.1));
  world.rotation.clear();
  EXPECT_TRUE(std::isnan(grain_view(world, {}, "xz", "rotation").discs.at(0).value));
  EXPECT_THAT(error_of<Error>([&] { grain_view(world, {}, "zx", "rotation"); }), HasSubstr("found the view 'zx'"));
  EXPECT_THAT(error_of<Error>([&] { grain_view(world, {}, "xz", "age"); }), HasSubstr("found the color 'age'"));
}

TEST(GrainView, IsColouredByAFieldOfAProbe) {
  NumberedWorld world;
  world.add(1, {0, 0, 0}, 0.1), world.add(2, {1, 0, 0}, 0.1);
  const BodyValues values{"moved/way/x", "way x", "m", "", true, {0.5, nan}};
  const auto view = grain_view(world, {}, "xz", "moved/way/x", &values);
  EXPECT_EQ(view.value.label, "way x");
  EXPECT_EQ(view.value.unit, "m");
  EXPECT_TRUE(view.symmetric);
  EXPECT_EQ(view.discs.at(0).value, 0.5);
  EXPECT_TRUE(std::isnan(view.discs.at(1).value));
  EXPECT_TRUE(std::isnan(grain_view(world, {}, "xz", "moved/way/x").discs.at(0).value)) << "grey without numbers";
}

TEST(GrainView, TakesTheMiddleThirdBackToFront) {
  NumberedWorld world;
  for (std::uint32_t i = 0; i <= 9; ++i) world.add(i, {0.1 * i, i / 9.0, 0}, 0.01);
  const auto front = grain_view(world, {}, "xz", "rotation").discs;
  ASSERT_EQ(front.size(), 4u);
  EXPECT_DOUBLE_EQ(front[0].x, 0.6);
  EXPECT_DOUBLE_EQ(front[3].x, 0.3);
  EXPECT_EQ(grain_view(world, {}, "xy", "rotation").discs.size(), 10u) << "no depth to speak of";
}

TEST(GrainView, CutsWallsAtMidDepthWhereTheyHaveMovedTo) {
  NumberedWorld world;
  world.add(1, {0, 0, 0}, 0.1);
  world.add_wall("lid", {0.5, 0, 2});
  const WallShape lid{"lid",
                      {Vec3(0, -1, 0), Vec3(2, -1, 0), Vec3(0, 1, 0),  // crosses at x from 0 to 1
                       Vec3(0, 3, 0), Vec3(2, 3, 0), Vec3(0, 4, 0)}};  // behind
  const auto walls = grain_view(world, std::span(&lid, 1), "xz", "rotation").walls;
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_DOUBLE_EQ(std::min(walls[0].x1, walls[0].x2), 0.5);
  EXPECT_DOUBLE_EQ(std::max(walls[0].x1, walls[0].x2), 1.5);
  EXPECT_DOUBLE_EQ(walls[0].y1, 2);
}

}  // namespace
}  // namespace grit::picture_tests
