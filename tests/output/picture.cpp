#include "output/picture.hpp"

#include <gmock/gmock.h>

#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <limits>
#include <sstream>

#include "fake_world.hpp"
#include "folder.hpp"
#include "grit/error.hpp"
#include "output/grain_view.hpp"
#include "output/scale.hpp"

namespace grit {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Scale, TicksAreMultiplesOfOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(nice_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(nice_step(1, 10), 0.1);
  EXPECT_DOUBLE_EQ(nice_step(2600, 5), 500);
  EXPECT_DOUBLE_EQ(nice_step(4e-3, 5), 1e-3);
  EXPECT_THAT(ticks(0, 1, 5), Pointwise(DoubleNear(1e-12), std::vector{0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_THAT(ticks(-0.3, 0.71, 5), Pointwise(DoubleNear(1e-12), std::vector{-0.2, 0.0, 0.2, 0.4, 0.6}));
  EXPECT_THAT(ticks(3, 3, 5), ElementsAre(3));
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
  EXPECT_EQ(readable("kg s-1", 0.02).unit, "g s-1");
  EXPECT_EQ(readable("kg s-1", 0.02).factor, 1e3);
  EXPECT_EQ(readable("kg", 2).unit, "kg");
  EXPECT_EQ(readable("kg m-3", 0.02).unit, "kg m-3");
}

boost::property_tree::ptree parsed(const std::string& svg) {
  std::istringstream text(svg);
  boost::property_tree::ptree tree;
  read_xml(text, tree);
  return tree;
}

/// Elements of a name, with the given word in their class if there is one.
std::vector<boost::property_tree::ptree> elements(const boost::property_tree::ptree& tree, const std::string& name,
                                                  const std::string& word = {}) {
  std::vector<boost::property_tree::ptree> found;
  for (const auto& [tag, child] : tree) {
    const auto classes = ' ' + child.get<std::string>("<xmlattr>.class", "") + ' ';
    if (tag == name && (word.empty() || classes.find(' ' + word + ' ') != std::string::npos)) found.push_back(child);
    for (auto& deeper : elements(child, name, word)) found.push_back(std::move(deeper));
  }
  return found;
}

std::vector<double> ys_of(const boost::property_tree::ptree& polyline) {
  std::istringstream points(polyline.get<std::string>("<xmlattr>.points"));
  std::vector<double> ys;
  double x, y;
  char comma;
  while (points >> x >> comma >> y) ys.push_back(y);
  return ys;
}

TEST(Picture, HasACurveARunAndMarksThePeak) {
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

TEST(Picture, HasAColourALayer) {
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

TEST(GrainView, LooksAlongTheAxisAndCountsClockwise) {
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
  EXPECT_THAT(error_of<Error>([&] { grain_view(world, {}, "zx", "rotation"); }), HasSubstr("there is no view 'zx'"));
  EXPECT_THAT(error_of<Error>([&] { grain_view(world, {}, "xz", "age"); }), HasSubstr("there is no color 'age'"));
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
}  // namespace grit
