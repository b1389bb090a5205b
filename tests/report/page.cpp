// Content of a page: the numbers of the results, and messages on unreadable files.
#include <gmock/gmock.h>

#include <cmath>

#include "grit/error.hpp"
#include "report/report_page.hpp"
#include "results.hpp"

namespace grit::page_tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

ReportPage page_of(const std::filesystem::path& folder, const GrainLimits& limits = {}) {
  return report_page(std::span(&folder, 1), limits);
}

json channel_of(const json& run, const std::string& probe, const std::string& name) {
  for (const auto& one : run.at("probes"))
    if (one.at("name") == probe)
      for (const auto& channel : one.at("channels"))
        if (channel.at("name") == name) return channel;
  throw std::runtime_error("the page has no " + probe + "/" + name);
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(ReportPage, HasTheCurvesToTheLastBit) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.write();
  const auto page = page_of(folder / "run");
  EXPECT_THAT(page.problems, IsEmpty());
  const json shown = json_of(page.html).at("runs").at(0);
  EXPECT_EQ(shown.at("probes").at(0).at("name"), "test") << "curves of the test are first";
  EXPECT_EQ(shown.at("probes").at(0).at("channels").at(0).at("name"), "time");

  const json ratio = channel_of(shown, "test", "stress_ratio");
  EXPECT_EQ(ratio.at("label"), "stress ratio");
  EXPECT_EQ(ratio.at("unit"), "1");
  EXPECT_EQ(ratio.at("about"), "shear over normal");
  EXPECT_EQ(ratio.at("width"), 1);
  EXPECT_EQ(ratio.at("samples"), 5);
  EXPECT_EQ(ratio.at("filled"), true);
  const auto values = numbers_of<double>(page.html, ratio.at("data"));
  ASSERT_EQ(values.size(), run.ratio.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_TRUE(same_bits(values[i], run.ratio[i])) << i;
  EXPECT_THAT(numbers_of<double>(page.html, channel_of(shown, "test", "time").at("data")),
              ElementsAre(0, 0.25, 0.5, 0.75, 1));

  const json stress = channel_of(shown, "test", "stress");
  EXPECT_EQ(stress.at("width"), 3);
  EXPECT_EQ(stress.at("shown_unit"), "kPa");
  EXPECT_EQ(stress.at("factor"), 1e-3);
  EXPECT_EQ(numbers_of<double>(page.html, stress.at("data")).at(14), 2e5);
}

TEST(ReportPage, WritesUnitsAndNamesAsInPictures) {
  const Folder folder;
  SmallRun run(folder / "run");
  ResultsFolder results(run.options);
  const std::vector<ProbeGroup> probes{{"test",
                                        {{"sigma_1", "N m-3", "sigma_1 of the mean", {}},
                                         {"phi_s", "degree", "of the interface", {}},
                                         {"speed", "m s-1", "mean", {}}}}};
  results.begin(run.world, probes);
  const double weight[] = {2.6e4}, angle[] = {30}, speed[] = {0.02};
  const std::span<const double> values[] = {weight, angle, speed};
  results.sample(0, run.world, values);
  results.finish(run.world, {});
  const json shown = json_of(page_of(folder / "run").html).at("runs").at(0);
  const auto told = [&](const char* name) {
    const json channel = channel_of(shown, "test", name);
    return channel.at("label").get<std::string>() + " [" + channel.at("shown_unit").get<std::string>() + "] of " +
           channel.at("unit").get<std::string>() + ": " + channel.at("about").get<std::string>();
  };
  EXPECT_EQ(told("sigma_1"), "σ₁ [kN/m³] of N m-3: σ₁ of the mean");
  EXPECT_EQ(told("phi_s"), "φ_s [°] of degree: of the interface");
  EXPECT_EQ(told("speed"), "speed [mm/s] of m s-1: mean");
}

TEST(ReportPage, HasTheGrainsWithinQuantisation) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.write();
  const auto page = page_of(folder / "run");
  const json grains = json_of(page.html).at("runs").at(0).at("grains");
  EXPECT_EQ(grains.at("low"), json({0, 0, 1}));
  EXPECT_EQ(grains.at("high"), json({2, 1, 3}));
  EXPECT_DOUBLE_EQ(grains.at("mean_diameter").get<double>(), 2 * 0.875 / 3);
  ASSERT_THAT(grains.at("frames"), SizeIs(2));
  ASSERT_THAT(grains.at("bodies"), SizeIs(1)) << "both frames have the same bodies";
  EXPECT_EQ(grains.at("left_out"), 0);

  const auto radius = numbers_of<float>(page.html, grains.at("bodies").at(0).at("data"));
  const auto id = numbers_of<std::int32_t>(page.html, grains.at("bodies").at(0).at("data"));
  ASSERT_EQ(radius.size(), 6u);
  EXPECT_THAT(std::vector(radius.begin(), radius.begin() + 3), ElementsAre(0.25f, 0.125f, 0.5f));
  EXPECT_THAT(std::vector(id.begin() + 3, id.end()), ElementsAre(2, 5, 7));

  const json &first = grains.at("frames").at(0), &second = grains.at("frames").at(1);
  EXPECT_EQ(first.at("time"), 1);
  EXPECT_EQ(second.at("time"), 2);
  EXPECT_EQ(second.at("stage"), "shear");
  EXPECT_EQ(first.at("low"), json({0, 0, 1}));
  EXPECT_EQ(second.at("low"), json({0.5, 0, 1}));
  EXPECT_EQ(second.at("base"), 0);
  const auto before = planes_of(page.html, first.at("data")), after = planes_of(page.html, second.at("data"));
  ASSERT_EQ(before.size(), 3u * (3 + 1 + 3)) << "position, speed, rotation; no displacement was kept";
  EXPECT_THAT(std::vector(before.begin(), before.begin() + 3), ElementsAre(32768, 65535, 0)) << "x by id";
  const auto x_of_7 = static_cast<std::uint16_t>(before[2] + after[2]);
  EXPECT_NEAR(2 * x_of_7 / 65535.0, 0.5, 2e-5);
  EXPECT_EQ(after[0], 0) << "a body that has not moved";
  EXPECT_EQ(grains.at("stages").at("shear").at("ranges").at("speed"), 5);
  EXPECT_THAT(std::vector(after.begin() + 9, after.begin() + 12), ElementsAre(0, 0, 65535)) << "speed";
  EXPECT_EQ(grains.at("stages").at("shear").at("ranges").at("rotation"), 1);
  EXPECT_THAT(std::vector(after.begin() + 15, after.begin() + 18), ElementsAre(0, 32768, 49151)) << "rotation about y";
}

TEST(ReportPage, HasScalesForEachStage) {
  const Folder folder;
  SmallRun run(folder / "run");
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  run.world.stage_name = "fill";
  results.frame(run.world, {});
  run.world.stage_name = "shear";
  run.world.velocity[0] = {0.03, 0.04, 0, 0}, run.world.rotation[1] = {0, 0.25, 0};
  results.frame(run.world, {});
  results.finish(run.world, {});
  const auto page = page_of(folder / "run");
  const json grains = json_of(page.html).at("runs").at(0).at("grains");
  EXPECT_EQ(grains.at("stages").at("fill").at("ranges").at("speed"), 5);
  EXPECT_NEAR(grains.at("stages").at("shear").at("ranges").at("speed").get<double>(), 0.05, 1e-15);
  EXPECT_EQ(grains.at("stages").at("shear").at("ranges").at("rotation"), 0.5);
  const auto shear = planes_of(page.html, grains.at("frames").at(1).at("data"));
  EXPECT_EQ(shear[11], 65535) << "the fastest of its stage";
}

TEST(ReportPage, OmitsGrainsWithoutAPosition) {
  const Folder folder;
  SmallRun run(folder / "run");
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  results.frame(run.world, {});
  run.world.position[1].z = std::numeric_limits<double>::quiet_NaN();
  results.frame(run.world, {});
  results.finish(run.world, {});
  const auto page = page_of(folder / "run");
  const json grains = json_of(page.html).at("runs").at(0).at("grains");
  EXPECT_FALSE(grains.at("frames").at(0).contains("unplaced"));
  const json& last = grains.at("frames").at(1);
  EXPECT_EQ(last.at("unplaced"), 1);
  EXPECT_EQ(grains.at("bodies").at(last.at("set").get<std::size_t>()).at("count"), 2);
  EXPECT_THAT(planes_of(page.html, last.at("data")), SizeIs(2 * (3 + 1 + 3)));
}

TEST(ReportPage, ShowsTheGrainsAlthoughOneIsFarAway) {
  const Folder folder;
  SmallRun run(folder / "run");
  for (int i = 0; i < 40; ++i)
    run.world.add({0.1 * i, 0, 2}, 0.1), run.world.id.back() = static_cast<std::uint32_t>(10 + i);
  run.world.rotation.resize(43, {0, 0, 0});
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  results.frame(run.world, {});
  run.world.position[1].z = 20;
  results.frame(run.world, {});
  run.world.position[1].z = 2e6;
  results.frame(run.world, {});
  results.finish(run.world, {});
  const auto page = page_of(folder / "run");
  const json grains = json_of(page.html).at("runs").at(0).at("grains"), &frames = grains.at("frames");
  EXPECT_FALSE(frames.at(0).contains("strays"));
  EXPECT_EQ(frames.at(1).at("strays"), 1);
  EXPECT_EQ(frames.at(1).at("high").at(2), 3) << "the box of the others";
  EXPECT_EQ(frames.at(2).at("unplaced"), 1) << "the others would have the same quantised position";
  EXPECT_EQ(grains.at("high").at(2), 20);
}

TEST(ReportPage, HasTheCoordinatesOfLists) {
  const Folder folder;
  SmallRun run(folder / "run");
  ResultsFolder results(run.options);
  const std::vector<ProbeGroup> probes{{"chains",
                                        {{"direction", "degree", "middle", {2}},
                                         {"force", "N", "by direction", {2}, "direction"},
                                         {"strain", "1", "whole", {2}, "", {"xx", "xz"}}}}};
  results.begin(run.world, probes);
  const double at[] = {90, 270}, force[] = {1, 2}, none[] = {INFINITY, std::numeric_limits<double>::quiet_NaN()};
  const std::span<const double> values[] = {at, force, none};
  results.sample(0, run.world, values);
  results.finish(run.world, {});
  const json shown = json_of(page_of(folder / "run").html).at("runs").at(0);
  EXPECT_EQ(channel_of(shown, "chains", "force").at("coordinate"), "direction");
  EXPECT_EQ(channel_of(shown, "chains", "direction").at("coordinate"), "");
  EXPECT_EQ(channel_of(shown, "chains", "strain").at("components"), json({"xx", "xz"}));
  EXPECT_EQ(channel_of(shown, "chains", "force").at("filled"), true);
  EXPECT_EQ(channel_of(shown, "chains", "strain").at("filled"), false) << "it has no number that can be drawn";
}

TEST(ReportPage, HasTheContactsAboveTheMean) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.write();
  auto page = page_of(folder / "run");
  json grains = json_of(page.html).at("runs").at(0).at("grains");
  const json frame = grains.at("frames").at(0);
  // √32, 0.3/√3 and 20: the mean is 8.6.
  EXPECT_NEAR(frame.at("mean_force").get<double>(), (std::sqrt(32.0) + 0.3 / std::sqrt(3.0) + 20) / 3, 1e-12);
  ASSERT_EQ(frame.at("contacts"), 1);
  EXPECT_EQ(frame.at("strongest"), 20);
  EXPECT_EQ(grains.at("reach"), 1);
  EXPECT_THAT(planes_of(page.html, frame.at("chains")), ElementsAre(2, 0, 32768, 32768, 16384, 65535))
      << "the third body by id, (0, 0, −0.5) of ±1, the strongest";

  run.world.contact.pop_back();
  run.options.existing = Existing::overwrite;
  run.write();
  page = page_of(folder / "run", {.contacts = 0});
  grains = json_of(page.html).at("runs").at(0).at("grains");
  EXPECT_EQ(grains.at("frames").at(0).at("contacts"), 0) << "within the limit";
}

TEST(ReportPage, HasWallsAndTheirDisplacements) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.write();
  auto page = page_of(folder / "run");
  const json grains = json_of(page.html).at("runs").at(0).at("grains");
  EXPECT_EQ(grains.at("walls").at(0).at("name"), "floor");
  EXPECT_THAT(numbers_of<float>(page.html, grains.at("walls").at(0).at("data")),
              ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  EXPECT_EQ(grains.at("frames").at(1).at("walls"), json({{0, 0, 0, -0.25}}));
  page = page_of(folder / "run", {.wall_corners = 2});
  EXPECT_THAT(json_of(page.html).at("runs").at(0).at("grains").at("frames").at(1).at("walls"), IsEmpty());
}

/// The small run with work of two of its bodies and the pressure on its wall in the last two of three frames.
void write_with_fields(const std::filesystem::path& folder) {
  SmallRun run(folder);
  run.options.facts.description["output"] =
      Description::parse(R"({"color_scales": [{"of": "moved/work", "high": 3}]})");
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  results.frame(run.world, {});
  for (const double level : {1.0, 2.0}) {
    const std::vector<FieldGroup> fields{
        {"facets", {{"pressure", "Pa", "on the facet", 1, {4e3 * level}, {}, "floor"}}},
        {"moved", {{"id", "1", "", 1, {7, 5}}, {"work", "J", "done on it", 1, {level, -level}}}}};
    results.frame(run.world, fields);
  }
  results.finish(run.world, {});
}

TEST(ReportPage, HasNumbersOfBodiesFromFields) {
  const Folder folder;
  write_with_fields(folder / "run");
  const auto page = page_of(folder / "run");
  const json run = json_of(page.html).at("runs").at(0), grains = run.at("grains");
  EXPECT_EQ(run.at("color_scales"), json::parse(R"([{"of": "moved/work", "high": 3}])"));
  ASSERT_THAT(grains.at("values"), SizeIs(1));
  EXPECT_EQ(grains.at("values").at(0).at("name"), "moved/work");
  EXPECT_EQ(grains.at("values").at(0).at("label"), "work");
  EXPECT_EQ(grains.at("values").at(0).at("unit"), "J");
  EXPECT_EQ(grains.at("stages").at("shear").at("values"), json::parse("[[-2.0, 2.0, 2.0]]"));
  EXPECT_FALSE(grains.at("frames").at(0).contains("values"));
  // Of the bodies 2, 5 and 7, in the range of the stage; 65535 is none.
  EXPECT_THAT(planes_of(page.html, grains.at("frames").at(1).at("values")), ElementsAre(65535, 16384, 49151));
  EXPECT_THAT(planes_of(page.html, grains.at("frames").at(2).at("values")), ElementsAre(65535, 0, 65534));
  const json small = json_of(page_of(folder / "run", {.value_bytes = 17}).html).at("runs").at(0).at("grains");
  EXPECT_THAT(small.at("values"), IsEmpty()) << "three frames of three bodies have 18 bytes";
  EXPECT_EQ(small.at("values_left_out"), 1);
}

TEST(ReportPage, HasNumbersOfFacetsFromFields) {
  const Folder folder;
  write_with_fields(folder / "run");
  const auto page = page_of(folder / "run");
  const json grains = json_of(page.html).at("runs").at(0).at("grains");
  ASSERT_THAT(grains.at("wall_fields"), SizeIs(1));
  const json field = grains.at("wall_fields").at(0);
  EXPECT_EQ(field.at("name"), "facets/pressure");
  EXPECT_EQ(field.at("wall"), "floor");
  EXPECT_EQ(field.at("unit"), "kPa");
  EXPECT_EQ(field.at("factor"), 1e-3);
  EXPECT_EQ(grains.at("stages").at("shear").at("wall_fields"), json::parse("[8000.0]"));
  EXPECT_FALSE(grains.at("frames").at(0).contains("wall_fields"));
  const json last = grains.at("frames").at(2).at("wall_fields");
  ASSERT_THAT(last, SizeIs(1));
  EXPECT_EQ(last.at(0).at(0), 0) << "the first wall of the frame";
  EXPECT_EQ(last.at(0).at(1), 0);
  EXPECT_THAT(numbers_of<float>(page.html, last.at(0).at(2)), ElementsAre(8000));
}

TEST(ReportPage, HasTheBoxOfGrainsWithTheirSurfaces) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.write();
  const json grains = json_of(page_of(folder / "run").html).at("runs").at(0).at("grains");
  EXPECT_EQ(grains.at("frames").at(0).at("surface"), json::parse("[[-0.5, -0.5, 0.5], [2.125, 1.125, 3.125]]"));
  EXPECT_EQ(grains.at("walls").at(0).at("low"), json::parse("[0.0, 0.0, 0.0]"));
  EXPECT_EQ(grains.at("walls").at(0).at("high"), json::parse("[1.0, 1.0, 0.0]"));
}

TEST(ReportPage, HasWallsThatChange) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.options.walls.push_back({"floor", {{0, 0, -3}, {1, 0, -3}, {0, 1, -3}}, "open"});
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  for (const char* stage : {"shear", "open", "open"}) {
    run.world.stage_name = stage, run.world.wall[0].position.x() += 0.125;
    results.frame(run.world, {});
  }
  results.finish(run.world, {});
  const auto page = page_of(folder / "run");
  const json grains = json_of(page.html).at("runs").at(0).at("grains");
  ASSERT_THAT(grains.at("walls"), SizeIs(2));
  EXPECT_THAT(numbers_of<float>(page.html, grains.at("walls").at(0).at("data")),
              ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  EXPECT_THAT(numbers_of<float>(page.html, grains.at("walls").at(1).at("data")),
              ElementsAre(0, 0, -3, 1, 0, -3, 0, 1, -3));
  EXPECT_EQ(grains.at("frames").at(0).at("walls"), json({{0, 0.125, 0, 0}}));
  EXPECT_EQ(grains.at("frames").at(2).at("walls"), json({{1, 0.375, 0, 0}}));
}

TEST(ReportPage, RotatesWallsWithinTheLimit) {
  const Folder folder;
  SmallRun run(folder / "run");
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  Mat3 quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  run.world.wall[0].pose.shift = run.world.wall[0].position;
  for (int i = 0; i < 3; ++i) {
    results.frame(run.world, {});
    run.world.wall[0].pose.turn = quarter * run.world.wall[0].pose.turn;
  }
  results.finish(run.world, {});
  auto page = page_of(folder / "run");
  json grains = json_of(page.html).at("runs").at(0).at("grains");
  ASSERT_THAT(grains.at("walls"), SizeIs(3));
  EXPECT_THAT(numbers_of<float>(page.html, grains.at("walls").at(1).at("data")),
              ElementsAre(0, 0, 0, 0, 1, 0, -1, 0, 0));
  EXPECT_EQ(grains.at("frames").at(2).at("walls").at(0).at(0), 2);
  page = page_of(folder / "run", {.wall_bytes = 36});
  grains = json_of(page.html).at("runs").at(0).at("grains");
  ASSERT_THAT(grains.at("walls"), SizeIs(1)) << "three corners of three floats";
  EXPECT_EQ(grains.at("frames").at(2).at("walls").at(0).at(0), 0);
}

TEST(ReportPage, OmitsFramesEvenlyBeyondTheLimit) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.write();
  for (const char* name : {"000002.h5", "000003.h5"})
    std::filesystem::copy_file(folder / "run/frames/000000.h5", folder / ("run/frames/" + std::string(name)));
  std::filesystem::copy_file(folder / "run/frames/000001.h5", folder / "run/frames/000004.h5");
  const auto frames = [&](std::size_t bytes) {
    return json_of(page_of(folder / "run", {.bytes = bytes}).html).at("runs").at(0).at("grains");
  };
  EXPECT_EQ(frames(1000).at("left_out"), 0);
  const json three = frames(3 * 3 * 20);
  EXPECT_EQ(three.at("left_out"), 2);
  ASSERT_THAT(three.at("frames"), SizeIs(3));
  const double times[] = {1, 1, 2};  // of the first, the third and the last
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(three.at("frames").at(i).at("time"), times[i]);
  EXPECT_THAT(frames(0).at("frames"), SizeIs(2)) << "the first and the last are always included";
}

TEST(ReportPage, ShowsReadablePartsOfAHalfWrittenFolder) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.write();
  std::ofstream(folder / "run/run.json") << "{\"status\": ";
  std::filesystem::resize_file(folder / "run/frames/000001.h5", 1000);
  auto page = page_of(folder / "run");
  EXPECT_THAT(page.problems, ElementsAre(HasSubstr("run.json: is not the JSON of a run"),
                                         AllOf(HasSubstr("frames/000001.h5"), HasSubstr("cannot read"))));
  EXPECT_THAT(page.html, AllOf(HasSubstr("What could not be read"), HasSubstr("run.json: is not the JSON of a run"),
                               HasSubstr(">unknown</span>")));
  EXPECT_THAT(json_of(page.html).at("runs").at(0).at("grains").at("frames"), SizeIs(1));
  EXPECT_EQ(channel_of(json_of(page.html).at("runs").at(0), "test", "stress_ratio").at("width"), 1);

  std::filesystem::resize_file(folder / "run/series.h5", 100);
  std::filesystem::remove(folder / "run/run.json");
  page = page_of(folder / "run");
  EXPECT_THAT(page.problems, SizeIs(3));
  EXPECT_THAT(page.problems, testing::Contains(HasSubstr("run.json: there is no such file")));
  EXPECT_THAT(page.problems, testing::Contains(AllOf(HasSubstr("series.h5"), HasSubstr("cannot read"))));
  EXPECT_THAT(json_of(page.html).at("runs").at(0).at("probes"), IsEmpty());

  std::filesystem::remove(folder / "run/frames/000000.h5");
  EXPECT_TRUE(json_of(page_of(folder / "run").html).at("runs").at(0).at("grains").is_null());
}

TEST(ReportPage, RefusesAFolderThatHoldsNoRun) {
  const Folder folder;
  std::filesystem::create_directory(folder / "empty");
  EXPECT_THAT(error_of<FileError>([&] { page_of(folder / "empty"); }),
              AllOf(HasSubstr("empty: holds no run"), HasSubstr("grit run")));
  EXPECT_THAT(error_of<FileError>([&] { page_of(folder / "nothing"); }), HasSubstr("nothing: there is no such folder"));
}

TEST(ReportPage, FetchesNothingAndIsNotBrokenByNames) {
  const Folder folder;
  SmallRun run(folder / "run");
  run.options.facts.description = {{"title", "</script><script>alert(1)</script> & <!-- <b>"}};
  run.write();
  const std::string html = page_of(folder / "run").html;
  EXPECT_EQ(json_of(html).at("runs").at(0).at("title"), "</script><script>alert(1)</script> & <!-- <b>");
  EXPECT_THAT(html, HasSubstr("<h1>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt; &amp; &lt;!-- &lt;b&gt;</h1>"));
  EXPECT_THAT(html, Not(HasSubstr("<script>alert(1)")));
  EXPECT_THAT(html, AllOf(HasSubstr("default-src 'none'"), Not(HasSubstr("<link")), Not(HasSubstr(" src=")),
                          Not(HasSubstr("sourceMappingURL"))));
}

TEST(ReportPage, PutsRunsSideBySide) {
  const Folder folder;
  SmallRun one(folder / "one"), other(folder / "other");
  one.write();
  for (double& value : other.ratio) value *= 2;
  other.write();
  const std::vector<std::filesystem::path> folders{folder / "one", folder / "other"};
  const auto page = report_page(folders);
  const json runs = json_of(page.html).at("runs");
  ASSERT_THAT(runs, SizeIs(2));
  EXPECT_EQ(runs.at(0).at("name"), "one");
  EXPECT_EQ(runs.at(1).at("name"), "other");
  EXPECT_EQ(numbers_of<double>(page.html, channel_of(runs.at(1), "test", "stress_ratio").at("data")).at(4), 2.0 / 3);
  EXPECT_THAT(page.html,
              AllOf(HasSubstr("<h1>Runs side by side</h1>"), HasSubstr("one</th>"), HasSubstr("other</th>")));
  EXPECT_THAT(page.html, HasSubstr("<td class=\"name\" colspan=\"2\">a small run</td>"))
      << "a common note is written once";
  EXPECT_THAT(page.html, HasSubstr("largest overlap<small>of the mean diameter, in the last stage</small></td><td>"));
}

TEST(ReportPage, ListsWhatDiffersBetweenDescriptions) {
  const Folder folder;
  const std::vector<std::filesystem::path> folders{folder / "one", folder / "other"};
  for (const auto& path : folders) {
    SmallRun run(path);
    run.options.facts.description["seed"] = path.filename() == "one" ? 1 : 2;
    if (path.filename() == "one") run.options.facts.description["materials"]["<sand>"] = 5;
    run.write();
  }
  std::string html = report_page(folders).html;
  EXPECT_THAT(html, HasSubstr("<tr class=\"differs\"><td class=\"name\">/seed</td><td>1</td><td>2</td></tr>\n"
                              "<tr class=\"differs\"><td class=\"name\">/materials</td><td>{&lt;sand&gt;: 5}</td>"
                              "<td>–</td></tr>\n"));
  EXPECT_THAT(html, Not(HasSubstr(" more</td>")));
  EXPECT_THAT(page_of(folder / "one").html, Not(HasSubstr("class=\"differs\"")));

  SmallRun run(folder / "other");
  run.options.existing = Existing::overwrite;
  for (int i = 0; i < 23; ++i) run.options.facts.description["key" + std::to_string(i)] = i;
  run.write();
  html = report_page(folders).html;
  EXPECT_THAT(html, AllOf(HasSubstr("/key17</td>"), Not(HasSubstr("/key18</td>"))));
  EXPECT_THAT(html, HasSubstr("<td class=\"name\" colspan=\"3\">and 5 more</td>"));
}

}  // namespace
}  // namespace grit::page_tests
