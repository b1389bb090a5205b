// Pictures of curves, profiles, chains and maps of runs, without a browser.
#include "report/pictures.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "output/svg_elements.hpp"
#include "report/curve_pictures.hpp"
#include "report/references.hpp"
#include "report/report_page.hpp"
#include "results.hpp"

namespace grit::pictures_tests {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::SizeIs;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Samples of a shear test whose stress ratio is `level` times its displacement, with these references.
void write_test(const std::filesystem::path& folder, double level, const Description& references = {}) {
  SmallRun run(folder);
  run.options.facts.description["output"] = {{"picture", {{"x", "test/u"}, {"y", {"test/ratio"}}}}};
  if (!references.is_null()) run.options.facts.description["output"]["references"] = references;
  ResultsFolder results(run.options);
  const std::vector<ProbeGroup> probes{{"test", {{"u", "m", "displacement", {}}, {"ratio", "1", "stress ratio", {}}}}};
  results.begin(run.world, probes);
  for (int i = 0; i < 5; ++i) {
    run.world.now = i, run.world.steps = static_cast<std::uint64_t>(i);
    const double u[] = {1e-3 * i}, ratio[] = {level * i};
    const std::span<const double> all[] = {u, ratio};
    results.sample(0, run.world, all);
  }
  results.finish(run.world, {});
}

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> all;
  std::istringstream stream(text);
  for (double number; stream >> number; stream.ignore(1)) all.push_back(number);
  return all;
}

TEST(CurvePictures, ShowTheReferencesOfTheDescription) {
  const Folder folder;
  write_test(folder / "run", 1,
             {{"the peak", {{"of", "test/ratio"}, {"value", 3}}},
              {"measured",
               {{"of", "test/ratio"},
                {"against", "test/u"},
                {"curve", {{"file", (folder / "run/measured.csv").string()}, {"x", "u"}, {"y", "ratio"}}}}},
              {"of another curve", {{"of", "test/other"}, {"value", 1}}},
              {"lost", {{"of", "test/ratio"}, {"curve", {{"file", "nowhere.csv"}, {"x", "u"}, {"y", "ratio"}}}}}});
  std::ofstream(folder / "run/measured.csv") << "u,ratio\n0,0\n0.002,2\n";
  RunResults run = read_results(folder / "run");
  const auto picture = curves_picture(std::span(&run, 1));
  ASSERT_TRUE(picture.has_value());
  const auto svg = parsed(*picture);
  EXPECT_THAT(words_of(svg), IsSupersetOf({"the peak", "measured"}));
  EXPECT_THAT(words_of(svg), Not(Contains("of another curve")));
  const auto curve = elements(svg, "polyline", "k0");
  ASSERT_THAT(curve, SizeIs(1));
  ASSERT_THAT(elements(svg, "polyline", "r0"), SizeIs(1));
  ASSERT_THAT(elements(svg, "polyline", "r1"), SizeIs(1));
  // JSON keeps the order: the first of the two is "the peak", as in the description, or "measured".
  const auto of_run = numbers_in(text_of(curve[0], "points"));
  bool level = false, measured = false;
  for (const char* name : {"r0", "r1"}) {
    const auto points = numbers_in(text_of(elements(svg, "polyline", name)[0], "points"));
    ASSERT_THAT(points, SizeIs(4));
    // From the first point of the run to the last at a height of 3; from 0 to u = 2 mm, where it is 2.
    level =
        level || (points[1] == points[3] && points[0] == of_run[0] && points[2] == of_run[8] && points[1] == of_run[7]);
    measured = measured || (points[0] == of_run[0] && points[2] == of_run[4] && points[3] == of_run[5]);
  }
  EXPECT_TRUE(level);
  EXPECT_TRUE(measured);
  EXPECT_THAT(run.problems, ElementsAre(HasSubstr("reference lost: nowhere.csv: cannot be read")));
}

/// The folder may come from a stranger, whose run.json names files of the reader.
TEST(CurvePictures, ReadNoFilesBesideTheFolder) {
  const Folder folder;
  std::ofstream(folder / "private.csv") << "u,ratio\n0,0\n0.002,2\n";
  const Description curve = {{"file", (folder / "private.csv").string()}, {"x", "u"}, {"y", "ratio"}};
  write_test(folder / "run", 1, {{"theirs", {{"of", "test/ratio"}, {"against", "test/u"}, {"curve", curve}}}});
  RunResults run = read_results(folder / "run");
  EXPECT_TRUE(references_of(run).empty());
  EXPECT_THAT(run.problems, ElementsAre(HasSubstr("reference theirs: " + (folder / "private.csv").string() +
                                                  ": cannot be read, as it is not in ")));
  std::filesystem::create_symlink(folder / "private.csv", folder / "run/link.csv");
  run.json["description"]["output"]["references"]["theirs"]["curve"]["file"] = (folder / "run/link.csv").string();
  EXPECT_TRUE(references_of(run).empty()) << "a link";
  run.json["references"]["theirs"] = {{"x", {0, 1}}, {"y", {5, 6}}};
  const auto kept = references_of(run);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_THAT(kept[0].y, ElementsAre(5, 6)) << "which the run has kept";
}

TEST(CurvePictures, ShowSeveralRuns) {
  const Folder folder;
  write_test(folder / "dense", 1, {{"peak", {{"of", "test/ratio"}, {"value", 3}}}});
  write_test(folder / "loose", 0.5, {{"peak", {{"of", "test/ratio"}, {"value", 1}}}});
  write_test(folder / "again", 2);
  std::vector<RunResults> runs{read_results(folder / "dense"), read_results(folder / "loose"),
                               read_results(folder / "again")};
  runs[2].probes[0].channels.clear();  // does not have it
  make_names_unique(runs);
  const auto svg = parsed(*curves_picture(runs));
  EXPECT_THAT(elements(svg, "polyline", "k0"), SizeIs(1));
  EXPECT_THAT(elements(svg, "polyline", "k1"), SizeIs(1));
  EXPECT_THAT(elements(svg, "polyline", "k2"), IsEmpty());
  EXPECT_THAT(words_of(svg), IsSupersetOf({"dense", "loose", "peak", "loose, peak"}));
  const auto dense = numbers_in(text_of(elements(svg, "polyline", "k0")[0], "points")),
             loose = numbers_in(text_of(elements(svg, "polyline", "k1")[0], "points"));
  ASSERT_THAT(dense, SizeIs(10));
  ASSERT_THAT(loose, SizeIs(10));
  EXPECT_EQ(dense[8], loose[8]) << "at the same displacement";
  EXPECT_NEAR((dense[1] - dense[9]) / (loose[1] - loose[9]), 2, 0.01) << "on the same axis";
}

TEST(CurvePictures, OfOneRunHaveNoLegend) {
  const Folder folder;
  write_test(folder / "dense", 1);
  RunResults run = read_results(folder / "dense");
  EXPECT_THAT(words_of(parsed(*curves_picture(std::span(&run, 1)))), Not(Contains("dense")));
}

TEST(CurvePictures, DescribeTheRunInOneLine) {
  const Folder folder;
  write_test(folder / "dense", 1);
  RunResults run = read_results(folder / "dense");
  run.json["status"] = "done", run.json["bodies"] = 12440, run.json["time"] = 0.06923, run.json["wall_s"] = 64,
  run.json["steps"] = 5, run.json["particle_steps_per_s"] = 2.2e6;
  EXPECT_THAT(words_of(parsed(*curves_picture(std::span(&run, 1))), "facts"),
              ElementsAre("done  ·  12\u202f440 bodies  ·  69.23 ms simulated  ·  took 64 s  ·  "
                          "2.2 million particle-steps/s"));
}

TEST(CurvePictures, HaveNoEmptyPanel) {
  const Folder folder;
  write_test(folder / "dense", 1);
  RunResults run = read_results(folder / "dense");
  for (double& value : run.probes[0].channels.back().sampled.values) value = nan;
  EXPECT_FALSE(curves_picture(std::span(&run, 1)).has_value());
}

TEST(CurvePictures, HaveNoPanelOfZeroUnlessItIsNamed) {
  const Folder folder;
  write_test(folder / "dense", 1);
  RunResults run = read_results(folder / "dense");
  auto ratio = std::ranges::find(run.probes[0].channels, "ratio", &ProbeSeries::Channel::name);
  ratio->sampled.values = {0, nan, 0, 0, 0};
  const auto drawn = [&] { return curves_picture(std::span(&run, 1)).value_or(""); };
  EXPECT_THAT(drawn(), HasSubstr(">ratio<")) << "named by the picture";
  run.json["description"]["output"]["picture"].erase("y");
  EXPECT_THAT(drawn(), testing::AllOf(HasSubstr("u [mm]"), Not(HasSubstr(">ratio<"))));
  run.json["description"]["output"]["references"]["nothing"] = {{"of", "test/ratio"}, {"value", 0}};
  EXPECT_THAT(drawn(), HasSubstr(">ratio<"));
}

TEST(ProfilePictures, HavePositionsAtSomeInstants) {
  const Folder folder;
  SmallRun run(folder / "run");
  ResultsFolder results(run.options);
  const std::vector<ProbeGroup> probes{{"moved",
                                        {{"position", "m", "where", {3}},
                                         {"gradient", "1", "slope", {3}, "position"},
                                         {"still", "1", "zero", {3}, "position"},
                                         {"direction", "degree", "where to", {3}},
                                         {"force", "N", "by direction", {3}, "direction"}}},
                                       {"packing", {{"e", "1", "void ratio", {}}}}};
  results.begin(run.world, probes);
  for (int i = 0; i < 7; ++i) {
    run.world.now = i, run.world.steps = static_cast<std::uint64_t>(i);
    const double place[] = {0, 1e-3, 2e-3}, gradient[] = {0, 1.0 * i, nan}, still[] = {0, 0, 0},
                 direction[] = {0, 90, 180}, force[] = {1, 2, 3}, e[] = {0.6};
    const std::span<const double> moved[] = {place, gradient, still, direction, force}, packing[] = {e};
    results.sample(0, run.world, moved), results.sample(1, run.world, packing);
  }
  results.finish(run.world, {});
  const auto pictures = profile_pictures(read_results(folder / "run"));
  ASSERT_THAT(pictures, SizeIs(1)) << "directions have no profile";
  EXPECT_EQ(pictures[0].name, "profiles-moved");
  const auto svg = parsed(pictures[0].svg);
  EXPECT_THAT(words_of(svg), IsSupersetOf({"2 s", "4 s", "6 s", "position [mm]", "gradient"}));
  EXPECT_THAT(words_of(svg), Not(Contains("still"))) << "0 throughout";
  std::vector<double> rises;
  for (const char* name : {"k0", "k1", "k2"}) {
    const auto lines = elements(svg, "polyline", name);
    ASSERT_THAT(lines, SizeIs(1));
    const auto points = numbers_in(text_of(lines[0], "points"));
    ASSERT_THAT(points, SizeIs(4)) << "NaN is a gap";
    rises.push_back(points[1] - points[3]);
  }
  EXPECT_NEAR(rises[1] / rises[0], 2, 0.01);
  EXPECT_NEAR(rises[2] / rises[0], 3, 0.01);
  EXPECT_THAT(elements(svg, "text", "peak"), IsEmpty());

  const auto polar = direction_pictures(read_results(folder / "run"));
  ASSERT_THAT(polar, SizeIs(1));
  EXPECT_EQ(polar[0].name, "directions-moved");
  const auto round = parsed(polar[0].svg);
  EXPECT_THAT(words_of(round), IsSupersetOf({"2 s", "4 s", "6 s", "force [N]", "0°", "90°", "180°", "270°"}));
  const auto outline = elements(round, "polyline", "k0");
  ASSERT_THAT(outline, SizeIs(1));
  const auto points = numbers_in(text_of(outline[0], "points"));
  ASSERT_THAT(points, SizeIs(2 * 16)) << "five points per direction, and back";
  // The middles of the three directions: 1 N to the right, 2 N up, 3 N to the left of the centre.
  const double middle_x = points[2 * 7], middle_y = points[2 * 2 + 1], newton = points[2 * 2] - middle_x;
  EXPECT_GT(newton, 10);
  EXPECT_NEAR(points[2 * 12 + 1], middle_y, 0.02);
  EXPECT_NEAR((middle_y - points[2 * 7 + 1]) / newton, 2, 0.01);
  EXPECT_NEAR((middle_x - points[2 * 12]) / newton, 3, 0.01);
}

TEST(ProfilePictures, NameTheAxisAndTheProgressOfTheTest) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.options.facts.description["output"] = {{"picture", {{"x", "test/u"}}}};
  ResultsFolder results(run.options);
  const std::vector<ProbeGroup> probes{
      {"moved", {{"position", "m", "middle of each, along z", {2}}, {"e", "1", "", {2}, "position"}}},
      {"test", {{"u", "m", "way", {}}}}};
  results.begin(run.world, probes);
  for (int i = 0; i < 7; ++i) {
    run.world.now = i, run.world.steps = static_cast<std::uint64_t>(i);
    const double place[] = {0, 1e-3}, e[] = {0.6, 0.7}, u[] = {i < 2 ? nan : 1e-3 * i};
    const std::span<const double> moved[] = {place, e}, test[] = {u};
    results.sample(0, run.world, moved);
    if (i != 4) results.sample(1, run.world, test);
  }
  results.finish(run.world, {});
  RunResults read = read_results(folder / "run");
  EXPECT_THAT(words_of(parsed(profile_pictures(read)[0].svg)),
              IsSupersetOf({"z [mm]", "2 s: u 2.00 mm", "4 s: u 3.00 mm", "6 s: u 6.00 mm"}));
  read.json["description"]["output"]["picture"]["x"] = "test/time";
  EXPECT_THAT(words_of(parsed(profile_pictures(read)[0].svg)), IsSupersetOf({"2 s", "4 s", "6 s"}));
  const std::filesystem::path where = folder / "run";
  EXPECT_THAT(report_page(std::span(&where, 1)).html, HasSubstr("\"label\":\"z\""));
}

/// The small run with a probe of chains; its rows are the contacts between grains with these forces.
void write_chains(const std::filesystem::path& folder, const std::vector<double>& force) {
  SmallRun run(folder);
  for (const std::size_t k : {0u, 1u, 2u}) run.world.contact[k].normal_force = 4.0 - 2 * (k > 0);
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  const std::vector<FieldGroup> tables{{"chains",
                                        {{"start", "m", "", 3, {0, 0, 1, 1, 0, 2}},
                                         {"normal_force", "N", "", 1, force},
                                         {"chain", "1", "", 1, {3, 0}}}}};
  results.frame(run.world, tables);
  results.finish(run.world, {});
}

TEST(LinearChainPictures, FollowTheLinksOfChains) {
  const Folder folder;
  write_chains(folder / "run", {4, 2});
  RunResults run = read_results(folder / "run");
  const auto picture = chains_picture(run);
  ASSERT_TRUE(picture.has_value());
  const auto svg = parsed(*picture);
  const auto links = elements(svg, "line", "link");
  ASSERT_THAT(links, SizeIs(1)) << "the other contact belongs to no chain";
  EXPECT_THAT(*picture, HasSubstr("3 linear chains"));
  // From the grain at (0, 1) to (1, 2): the same distance up and to the right.
  EXPECT_NEAR(number_of(links[0], "x2") - number_of(links[0], "x1"),
              number_of(links[0], "y1") - number_of(links[0], "y2"), 0.05);
  EXPECT_GT(number_of(links[0], "x2"), number_of(links[0], "x1"));
}

TEST(ForceChainPictures, HaveTheContactsAboveTheMean) {
  const Folder folder;
  write_chains(folder / "run", {4, 2});
  RunResults run = read_results(folder / "run");
  const auto picture = force_chains_picture(run);
  ASSERT_TRUE(picture.has_value());
  EXPECT_THAT(elements(parsed(*picture), "line", "link"), SizeIs(1)) << "forces of 4, 2 and 2 N";
  EXPECT_THAT(*picture, AllOf(HasSubstr("contacts above the mean of 2.67 N, width<"),
                              HasSubstr(">proportional to normal force, at most 4 N<")));
}

TEST(LinearChainPictures, AreOnThePage) {
  const Folder folder;
  write_chains(folder / "run", {4, 2});
  const std::filesystem::path path = folder / "run";
  const std::string html = report_page(std::span(&path, 1)).html;
  const auto frame = json_of(html).at("runs").at(0).at("grains").at("frames").at(0);
  ASSERT_EQ(frame.at("linear_contacts"), 1);
  // Low and high half of the grain's index by id (the last of 2, 5, 7), branch, force.
  const auto numbers = planes_of(html, frame.at("linear_chains"));
  ASSERT_THAT(numbers, SizeIs(6));
  EXPECT_EQ(numbers[0], 2);
  EXPECT_EQ(numbers[2], 65535) << "the largest branch";
  EXPECT_EQ(numbers[5], 65535) << "the strongest";
}

TEST(LinearChainPictures, IgnoreRowsOfOtherContacts) {
  const Folder folder;
  write_chains(folder / "run", {4, 3});
  RunResults run = read_results(folder / "run");
  EXPECT_FALSE(chains_picture(run).has_value());
}

TEST(MapPictures, NameTheirContentOnce) {
  const Folder folder;
  SmallRun run(folder / "run");
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  const std::vector<FieldGroup> tables{{"strain",
                                        {{"centre", "m", "", 3, {0.5, 0, 0.5}},
                                         {"size", "m", "", 3, {1, 2, 1}},
                                         {"strain", "1", "", 1, {1}},
                                         {"spin", "rad", "", 1, {1}}}}};
  run.world.now = 0.02914;
  results.frame(run.world, tables);
  results.finish(run.world, {});
  RunResults read = read_results(folder / "run");
  const auto pictures = map_pictures(read);
  ASSERT_THAT(pictures, SizeIs(2));
  EXPECT_THAT(words_of(parsed(pictures[0].svg), "facts"), ElementsAre(testing::StartsWith("spin of strain  ·  stage")));
  EXPECT_THAT(words_of(parsed(pictures[1].svg), "facts"),
              ElementsAre(testing::AllOf(testing::StartsWith("strain  ·  stage"), testing::EndsWith("  ·  29.14 ms"))));
}

TEST(MapPictures, HaveTheColourScalesOfTheDescription) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.options.facts.description["output"]["color_scales"] =
      Description::parse(R"([{"of": "cells/force", "high": 2}, {"of": "cells/force/y", "high": 100}])");
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  const std::vector<FieldGroup> tables{{"cells",
                                        {{"centre", "m", "", 3, {0.5, 0, 0.5, 1.5, 0, 0.5}},
                                         {"size", "m", "", 3, {1, 2, 1, 1, 2, 1}},
                                         {"force", "N", "on the cell", 2, {2, 2, 50, 50}, {"x", "y"}}}}};
  results.frame(run.world, tables);
  results.finish(run.world, {});
  RunResults read = read_results(folder / "run");
  const auto pictures = map_pictures(read);
  ASSERT_THAT(pictures, SizeIs(1));
  std::vector<std::string> fills;
  for (const auto& group : elements(parsed(pictures[0].svg), "g", "cells"))
    for (const auto& tile : elements(group, "rect")) fills.push_back(text_of(tile, "fill"));
  ASSERT_THAT(fills, SizeIs(4));
  EXPECT_EQ(fills[0], "#a01228") << "x, at the end of its scale";
  EXPECT_EQ(fills[1], "#a01228");
  EXPECT_NE(fills[2], "#a01228") << "y has a scale of its own";
  EXPECT_NE(fills[3], "#a01228");
}

TEST(GrainsPictures, AreColouredByAField) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.options.facts.description["output"]["picture"] = {{"view", "xz"}, {"color", "moved/work"}};
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  results.frame(run.world, {});
  results.finish(run.world, {});
  RunResults without = read_results(folder / "run");
  EXPECT_THAT(grains_picture(without).value_or(""), HasSubstr(">speed [m/s]<")) << "the frame has no such field";
  SmallRun again(folder / "again");
  again.options.facts.description = run.options.facts.description;
  ResultsFolder more(again.options);
  more.begin(again.world, {});
  const std::vector<FieldGroup> tables{{"moved", {{"id", "1", "", 1, {7, 2, 5}}, {"work", "J", "", 1, {1, 2, 3}}}}};
  more.frame(again.world, tables);
  more.finish(again.world, {});
  RunResults with = read_results(folder / "again");
  EXPECT_THAT(grains_picture(with).value_or(""), HasSubstr(">work [J]<"));
}

TEST(MapPictures, HaveWallsAxesAndTheirFieldsPalette) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.options.walls = {{"floor", {{-1, -1, 0}, {3, -1, 0}, {3, 2, 0}, {-1, -1, 0}, {3, 2, 0}, {-1, 2, 0}}}};
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  const std::vector<FieldGroup> tables{{"cells",
                                        {{"centre", "m", "", 3, {0.5, 0, 0.5, 1.5, 0, 0.5}},
                                         {"size", "m", "", 3, {1, 2, 1, 1, 2, 1}},
                                         {"bodies", "1", "how many", 1, {1, 2}},
                                         {"void_ratio", "1", "of the cell", 1, {-1, 1}},
                                         {"rotation", "rad", "clockwise positive", 1, {1, 2}}}}};
  results.frame(run.world, tables);
  results.finish(run.world, {});
  RunResults read = read_results(folder / "run");
  const auto pictures = map_pictures(read);
  ASSERT_THAT(pictures, SizeIs(2)) << "no map of counts";
  for (const auto& [name, svg] : pictures) {
    EXPECT_THAT(words_of(parsed(svg), "axis"), testing::UnorderedElementsAre("x [m]", "z [m]")) << name;
    EXPECT_THAT(elements(parsed(svg), "line", "wall"), Not(IsEmpty())) << name;
  }
  EXPECT_EQ(pictures[0].name, "map-cells-rotation");
  EXPECT_THAT(pictures[0].svg, HasSubstr("fill=\"#144e8c\"")) << "the scale continues below zero";
  EXPECT_EQ(pictures[1].name, "map-cells-void_ratio");
  EXPECT_THAT(pictures[1].svg, testing::AllOf(HasSubstr("fill=\"#440154\""), Not(HasSubstr("fill=\"#144e8c\""))));
}

}  // namespace
}  // namespace grit::pictures_tests
