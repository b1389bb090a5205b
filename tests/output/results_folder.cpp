#include "output/results_folder.hpp"

#include <gmock/gmock.h>

#include <boost/property_tree/xml_parser.hpp>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "bodies/packing_file.hpp"
#include "fake_world.hpp"
#include "folder.hpp"
#include "grit/error.hpp"
#include "output/checkpoint.hpp"
#include "svg_elements.hpp"

namespace grit::results_folder_tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

const std::vector<ProbeGroup> probes{
    {"test", {{"shear_displacement", "m", "", {}}, {"stress_ratio", "1", "", {}}, {"profile", "m", "", {4}}}},
    {"energy", {{"kinetic_energy", "J", "", {}}}}};

ResultsOptions options(const std::filesystem::path& folder) {
  ResultsOptions options;
  options.folder = folder;
  options.title = "direct shear";
  options.facts.description = {{"title", "direct shear"}, {"seed", 4}};
  options.facts.seed = 4;
  options.facts.threads = 2;
  options.facts.plugins.push_back({"contact", "linear-rolling", "1.0", "/lib/linear-rolling.so", build_tag()});
  options.picture = PictureRequest{"test/shear_displacement", {"test/stress_ratio", "energy/kinetic_energy"}};
  return options;
}

NumberedWorld world_of_two() {
  NumberedWorld world;
  world.add(4, {0.1, 0.2, 1.0 / 3}, 0.05);
  world.add(1, {0.5, 0.2, 0.3}, 0.05);
  return world;
}

void sample(ResultsFolder& results, const NumberedWorld& world, double x, double y) {
  const double displacement[] = {x}, ratio[] = {y}, profile[] = {0, 1, 2, 3}, energy[] = {x * y};
  const std::span<const double> test[] = {displacement, ratio, profile}, rest[] = {energy};
  results.sample(0, world, test);
  results.sample(1, world, rest);
}

TEST(ResultsFolder, HoldsAWholeRun) {
  const Folder folder;
  auto world = world_of_two();
  ResultsFolder results(options(folder / "run"));
  results.begin(world, probes);
  EXPECT_EQ(json::parse(text_of(folder / "run/description.json")).at("seed"), 4);
  auto run = json::parse(text_of(folder / "run/run.json"));
  EXPECT_EQ(run.at("status"), "running");
  EXPECT_EQ(run.at("description").at("title"), "direct shear");
  EXPECT_EQ(run.at("seed"), 4);
  EXPECT_EQ(run.at("threads"), 2);
  EXPECT_EQ(run.at("ranks"), 1);
  EXPECT_EQ(run.at("plugins").at(0).at("name"), "linear-rolling");
  EXPECT_EQ(run.at("plugins").at(0).at("build").at("compiler"), build_tag().compiler);
  EXPECT_NE(run.at("grit").at("version"), "");
  EXPECT_TRUE(run.at("host").contains("cpu"));

  for (int i = 0; i < 5; ++i) {
    world.steps = static_cast<std::uint64_t>(10 * i);
    world.now = i;
    sample(results, world, 1e-3 * i, 0.8 - 0.1 * (i - 3) * (i - 3));
  }
  results.frame(world, {});
  world.stage_name = "consolidation";
  results.stage_ended(world, "void ratio 0.598");
  run = json::parse(text_of(folder / "run/run.json"));
  EXPECT_EQ(run.at("status"), "running");
  EXPECT_EQ(run.at("stages").at(0).at("name"), "consolidation");
  EXPECT_EQ(run.at("stages").at(0).at("reached"), "void ratio 0.598");
  EXPECT_EQ(run.at("stages").at(0).at("step"), 40);

  RunSummary summary;
  summary.status = "done";
  summary.steps = 40;
  summary.time = 4;
  summary.bodies = 2;
  summary.time_step = 1e-6;
  summary.critical_time_step = 1.25e-6;
  summary.contacts_per_body = 4.5;
  summary.wall_seconds = 2;
  summary.particle_steps_per_second = 40;
  summary.rebuilds = 3;
  summary.phases = {{"contact forces", 1.5, 1.25}};
  summary.probes = {{"packing", 4, 0.25}};
  results.finish(world, summary);
  run = json::parse(text_of(folder / "run/run.json"));
  EXPECT_EQ(run.at("status"), "done");
  EXPECT_EQ(run.at("steps"), 40);
  EXPECT_EQ(run.at("time_step_s"), 1e-6);
  EXPECT_EQ(run.at("critical_time_step_s"), 1.25e-6);
  EXPECT_EQ(run.at("contacts_per_body"), 4.5);
  EXPECT_EQ(run.at("wall_s"), 2);
  EXPECT_EQ(run.at("particle_steps_per_s"), 40);
  EXPECT_EQ(run.at("rebuilds"), 3);
  EXPECT_EQ(run.at("phases_s").at("contact forces"), 1.5);
  EXPECT_EQ(run.at("parallel_s").at("contact forces"), 1.25);
  EXPECT_EQ(run.at("probes").at("packing"), Description({{"samples", 4}, {"seconds", 0.25}}));

  const std::vector<Row> grains = read_packing(folder / "run/packing.txt");
  ASSERT_EQ(grains.size(), 2u);
  EXPECT_EQ(grains[0].x, 0.5) << "in the order of their ids";
  EXPECT_EQ(grains[1].z, 1.0 / 3);

  const auto file = hdf5::File(folder / "run/series.h5", hdf5::Mode::read).group("test").dataset("profile");
  EXPECT_TRUE(std::filesystem::exists(folder / "run/frames/000000.h5"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run/frames.xdmf"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    EXPECT_NE(entry.path().extension(), ".part");

  boost::property_tree::ptree svg;
  read_xml((folder / "run/picture.svg").string(), svg);
  EXPECT_EQ(svg.get<std::string>("svg.title"), "direct shear");
  EXPECT_THAT(text_of(folder / "run/picture.svg"), AllOf(HasSubstr("shear displacement [mm]"), HasSubstr(">0.800<")));
}

TEST(ResultsFolder, WritesGrainsInsideThePeriodicCell) {
  const Folder folder;
  NumberedWorld world;
  world.make_periodic({1, 1, 1}, {3, 3, 3});
  world.box.periodic = {true, true, false};
  world.add(0, {0.9, 3.1, 3.1}, 0.25);
  ResultsFolder results(options(folder / "run"));
  RunSummary summary;
  summary.status = "done";
  results.begin(world, probes);
  results.finish(world, summary);
  const std::vector<Row> grains = read_packing(folder / "run/packing.txt");
  ASSERT_EQ(grains.size(), 1u);
  EXPECT_DOUBLE_EQ(grains[0].x, 2.9);
  EXPECT_DOUBLE_EQ(grains[0].y, 1.1);
  EXPECT_EQ(grains[0].z, 3.1);
  EXPECT_EQ(grains[0].w, 0.25);
}

TEST(ResultsFolder, RefusesAFolderThatHoldsARun) {
  const Folder folder;
  const auto world = world_of_two();
  ResultsFolder(options(folder / "run")).begin(world, probes);
  std::ofstream(folder / "run/notes.txt") << "mine";
  std::ofstream(folder / "run/checkpoint.h5") << "old";
  std::ofstream(folder / "run/grains.pvd") << "old";
  EXPECT_THAT(error_of<FileError>([&] { ResultsFolder(options(folder / "run")); }),
              AllOf(HasSubstr("run: holds a run already (run.json)"), HasSubstr("choose another folder")));
  auto again = options(folder / "run");
  again.existing = Existing::overwrite;
  ResultsFolder(again).begin(world, probes);
  EXPECT_FALSE(std::filesystem::exists(folder / "run/checkpoint.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run/grains.pvd"));
  EXPECT_EQ(text_of(folder / "run/notes.txt"), "mine");
}

/// Names and contents of all files below a folder.
std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[entry.path().string()] = text_of(entry.path());
  return files;
}

TEST(ResultsFolder, KeepsTheOldResultsOfARunThatDoesNotBegin) {
  const Folder folder;
  const auto world = world_of_two();
  ResultsFolder(options(folder / "run")).begin(world, probes);
  std::ofstream(folder / "run/checkpoint.h5") << "old";
  const auto before = files_in(folder / "run");
  auto again = options(folder / "run");
  again.existing = Existing::overwrite;
  { const ResultsFolder never_begun(again); }
  EXPECT_EQ(files_in(folder / "run"), before);
  again.picture->x = "test/no_channel";
  EXPECT_THROW(ResultsFolder(again).begin(world, probes), Error);
  EXPECT_EQ(files_in(folder / "run"), before);
  again.picture.reset();
  ResultsFolder late(again);
  std::ofstream(folder / "run/frames/photo.jpg") << "mine";
  EXPECT_THAT(error_of<FileError>([&] { late.begin(world, probes); }), HasSubstr("frames/photo.jpg"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run/series.h5"));
}

TEST(ResultsFolder, LeavesNothingIfItCannotBegin) {
  const Folder folder;
  auto world = world_of_two();
  // Two probes of one name have no place in one file, which is found after run.json is written.
  const std::vector<ProbeGroup> twice{probes[0], probes[0]};
  auto wanted = options(folder / "run");
  wanted.picture.reset();
  EXPECT_THROW(ResultsFolder(wanted).begin(world, twice), FileError);
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
  ResultsFolder(wanted).begin(world, probes);
}

TEST(ResultsFolder, IsOfOneRunAtATime) {
  const Folder folder;
  const auto world = world_of_two();
  std::optional<ResultsFolder> first(options(folder / "run"));
  first->begin(world, probes);
  const std::string before = text_of(folder / "run/run.json");
  auto second = options(folder / "run");
  for (const Existing existing : {Existing::refuse, Existing::overwrite, Existing::resume}) {
    second.existing = existing;
    EXPECT_THAT(error_of<FileError>([&] { ResultsFolder results(second); }),
                HasSubstr("run: another run is writing there; wait for it, or choose another folder"));
  }
  EXPECT_EQ(text_of(folder / "run/run.json"), before);
  EXPECT_TRUE(std::filesystem::exists(folder / "run/series.h5"));
  first.reset();
  EXPECT_NO_THROW(ResultsFolder results(second));
}

TEST(ResultsFolder, ContinuesAResumedRun) {
  const Folder folder;
  auto world = world_of_two();
  std::vector<std::byte> extent;
  {
    ResultsFolder results(options(folder / "run"));
    results.begin(world, probes);
    for (world.steps = 10; world.steps <= 30; world.steps += 10) {
      sample(results, world, 0.001 * static_cast<double>(world.steps), 0.5);
      results.frame(world, {});
      results.stage_ended(world, "step " + std::to_string(world.steps));
      if (world.steps == 20) results.flush(), extent = saved_state(results);
    }
    results.checkpoint(Checkpoint{"stage", 0, 20, {}});
  }
  auto more = options(folder / "run");
  more.existing = Existing::resume;
  ResultsFolder results(more);
  restore_state(results, extent);
  world.steps = 20;
  results.begin(world, probes);
  world.steps = 21;
  sample(results, world, 0.002, 0.6);
  RunSummary summary;
  summary.status = "done";
  results.final_state(Checkpoint{"stage", 0, 21, {}});
  results.finish(world, summary);
  const auto series = hdf5::File(folder / "run/series.h5", hdf5::Mode::read);
  EXPECT_THAT(series.group("test").dataset("step").read<int>(), ElementsAre(10, 20, 21));
  EXPECT_FALSE(std::filesystem::exists(folder / "run/frames/000002.h5"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run/frames/000001.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run/checkpoint.h5")) << "it is the final state now";
  EXPECT_TRUE(std::filesystem::exists(folder / "run/final.h5"));
  EXPECT_THAT(text_of(folder / "run/picture.svg"),
              testing::ContainsRegex("points=\"[0-9.]+,[0-9.]+ [0-9.]+,[0-9.]+ [0-9.]+,[0-9.]+\""))
      << "two points before the checkpoint and one after it";
  const auto run = json::parse(text_of(folder / "run/run.json"));
  EXPECT_EQ(run.at("stages").size(), 2u);
  EXPECT_EQ(run.at("resumed_at_step"), 20);
  EXPECT_EQ(run.at("resumed"), 1);
}

/// A run of four samples and frames, the last two after its checkpoint, that was killed.
struct KilledRun {
  KilledRun() {
    ResultsFolder results(options(folder / "run"));
    results.begin(world, probes);
    for (world.steps = 10; world.steps <= 40; world.steps += 10) {
      sample(results, world, 0.001 * static_cast<double>(world.steps), 0.5);
      results.frame(world, {});
      if (world.steps != 20) continue;
      results.flush(), state = saved_state(results);
      results.checkpoint(Checkpoint{"stage", 0, 20, {}});
    }
    results.flush();
  }
  /// Continues it by a step. Throws what restoring it throws.
  void resume() {
    auto more = options(folder / "run");
    more.existing = Existing::resume;
    ResultsFolder results(more);
    restore_state(results, state);
    world.steps = 20;
    results.begin(world, probes);
    world.steps = 21;
    sample(results, world, 0.002, 0.6);
    results.flush();
  }
  std::vector<int> steps() const {
    return hdf5::File(folder / "run/series.h5", hdf5::Mode::read).group("test").dataset("step").read<int>();
  }
  std::map<std::string, std::string> files() const { return files_in(folder / "run"); }

  const Folder folder;
  NumberedWorld world = world_of_two();
  std::vector<std::byte> state;
};

TEST(ResultsFolder, RestoresTheSeriesWhateverStateTheyAreIn) {
  KilledRun run;
  const auto series = run.folder / "run/series.h5";
  const std::string whole = text_of(series);
  const auto journal = run.folder / "run/series.journal";
  const std::string longer = text_of(journal);
  const auto restored_from = [&](const std::string& bytes) {
    std::ofstream(series, std::ios::binary) << bytes;
    std::ofstream(journal, std::ios::binary) << longer << "half of a sample";
    run.resume();
    EXPECT_THAT(run.steps(), ElementsAre(10, 20, 21)) << bytes.size() << " of " << whole.size() << " bytes";
  };
  for (std::size_t part = 0; part < 12; ++part) restored_from(whole.substr(0, whole.size() * part / 12));
  restored_from(whole);
  restored_from(whole + std::string(5000, '\0'));
  restored_from(std::string(whole.size(), '\0'));
  std::filesystem::remove(series);
  run.resume();
  EXPECT_THAT(run.steps(), ElementsAre(10, 20, 21));
}

TEST(ResultsFolder, ChangesNothingIfItCannotBeResumed) {
  KilledRun run;
  const auto refused_because = [&](const std::string& file) {
    const auto before = run.files();
    EXPECT_THAT(error_of<FileError>([&] { run.resume(); }), HasSubstr(file));
    EXPECT_EQ(run.files(), before);
  };
  const std::string frame = text_of(run.folder / "run/frames/000001.h5");
  std::ofstream(run.folder / "run/frames/000001.h5") << "damaged";
  refused_because("frames/000001.h5: cannot read");
  std::ofstream(run.folder / "run/frames/000001.h5", std::ios::binary) << frame;
  const std::string journal = text_of(run.folder / "run/series.journal");
  std::filesystem::resize_file(run.folder / "run/series.journal", 30);
  refused_because("series.journal: ");
  std::ofstream(run.folder / "run/series.journal", std::ios::binary) << journal;
  // To free space.
  std::filesystem::remove(run.folder / "run/frames/000000.h5");
  run.resume();
  EXPECT_THAT(text_of(run.folder / "run/frames.xdmf"),
              AllOf(HasSubstr("frames/000001.h5:"), testing::Not(HasSubstr("frames/000000.h5:"))));
  EXPECT_FALSE(std::filesystem::exists(run.folder / "run/frames/000002.h5"));
}

TEST(ResultsFolder, RefusesMoreFramesThanSteps) {
  KilledRun run;
  const std::uint64_t frames = std::uint64_t{1} << 50;
  std::memcpy(run.state.data() + 3 * sizeof frames, &frames, sizeof frames);  // after the samples of two probes
  const auto before = run.files();
  EXPECT_THAT(error_of<Error>([&] { run.resume(); }), HasSubstr("altered: there are more frames than steps"));
  EXPECT_EQ(run.files(), before);
}

/// A run that is killed while it writes its last results resumes from there.
TEST(ResultsFolder, KeepsItsLastTwoCheckpointsUntilItIsDone) {
  const Folder folder;
  auto world = world_of_two();
  const auto wanted = options(folder / "run");
  ResultsFolder results(wanted);
  results.begin(world, probes);
  const auto step_of = [&](const char* file) { return read_checkpoint(folder / file, wanted.facts).step; };
  for (const std::uint64_t step : {10u, 20u, 30u}) results.checkpoint(Checkpoint{"stage", 0, step, {}});
  results.final_state(Checkpoint{"stage", 0, 40, {}});
  EXPECT_EQ(step_of("run/checkpoint.h5"), 30u);
  EXPECT_EQ(step_of("run/checkpoint-previous.h5"), 20u);
  EXPECT_EQ(step_of("run/final.h5"), 40u);
  RunSummary summary;
  summary.status = "done";
  results.finish(world, summary);
  EXPECT_FALSE(has_checkpoint(folder / "run"));
  EXPECT_EQ(step_of("run/final.h5"), 40u);
}

TEST(ResultsFolder, ReplacesNoFileThatAppearedDuringTheRun) {
  const Folder folder;
  auto world = world_of_two();
  ResultsFolder results(options(folder / "run"));
  results.begin(world, probes);
  EXPECT_NO_THROW(results.expect_room());
  for (const std::string name : {"packing.txt", "picture.svg", "final.h5", "frames/000000.h5"}) {
    folder.write("run/" + name, "mine");
    EXPECT_THAT(error_of<RefusedRecord>([&] { results.expect_room(); }),
                AllOf(HasSubstr("run/" + name + ": "), HasSubstr("move it away")));
    if (name == "packing.txt") {
      RunSummary done;
      done.status = "done";
      EXPECT_THROW(results.finish(world, done), RefusedRecord);
    }
    EXPECT_EQ(text_of(folder / ("run/" + name)), "mine");
    std::filesystem::remove(folder / ("run/" + name));
  }
}

TEST(ResultsFolder, ReportsWhyItCannotBeCreated) {
  const Folder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_THAT(error_of<FileError>([&] { ResultsFolder(options(folder / "file/run")); }),
              AllOf(HasSubstr("file/run: cannot create the results folder: "), HasSubstr("Not a directory")));
}

TEST(ResultsFolder, DrawsCurvesOverTime) {
  const Folder folder;
  auto over_time = options(folder / "run");
  over_time.picture = PictureRequest{"test/time", {"test/stress_ratio"}};
  auto world = world_of_two();
  ResultsFolder results(over_time);
  results.begin(world, probes);
  for (const double time : {0.0, 20.0}) {
    world.now = time;
    sample(results, world, 0, 0.5);
  }
  RunSummary summary;
  summary.status = "done";
  results.finish(world, summary);
  EXPECT_THAT(text_of(folder / "run/picture.svg"), AllOf(HasSubstr(">time [s]<"), HasSubstr(">20<")));
}

TEST(ResultsFolder, ColoursThePictureByAFieldOfItsLastFrame) {
  const Folder folder;
  auto coloured = options(folder / "run");
  coloured.picture->color = "moved/work";
  coloured.picture->scale.high = 8;
  auto world = world_of_two();
  ResultsFolder results(coloured);
  results.begin(world, probes);
  for (const double most : {2.0, 4.0}) {
    sample(results, world, 0, 0.5);
    world.steps += 10;
    const std::vector<FieldGroup> fields{
        {"moved", {{"id", "1", "id of each body", 1, {1, 4}}, {"work", "J", "done on it", 1, {0, most}}}}};
    results.frame(world, fields);
  }
  results.finish(world, {});
  const std::string svg = text_of(folder / "run/picture.svg");
  EXPECT_THAT(svg, HasSubstr(">work [J]<"));
  EXPECT_THAT(elements(parsed(svg), "circle", "c10"), SizeIs(1)) << "the grain 4: half of the end of the scale";
  EXPECT_THAT(elements(parsed(svg), "circle", "c0"), SizeIs(1));
}

TEST(ResultsFolder, KnowsTheChannelsOfThePicture) {
  const Folder folder;
  auto wrong = options(folder / "run");
  wrong.picture->x = "test/profile";
  ResultsFolder results(wrong);
  EXPECT_THAT(error_of<Error>([&] { results.begin(world_of_two(), probes); }),
              AllOf(StartsWith("/output/picture/x: found \"test/profile\""),
                    EndsWith("allowed is one of test/time, test/shear_displacement, test/stress_ratio, energy/time, "
                             "energy/kinetic_energy")));
}

}  // namespace
}  // namespace grit::results_folder_tests
