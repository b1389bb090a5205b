// Grains coloured by layers at the start of a stage, without a browser.
#include <gmock/gmock.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>

#include "report/pictures.hpp"
#include "report/report_page.hpp"
#include "results.hpp"

namespace grit::layers_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Instants of a run: stage, and heights of grains by id; a grain without a height does not exist.
struct Instant {
  const char* stage;
  std::vector<std::optional<double>> heights;
};

void write(const std::filesystem::path& folder, const std::vector<Instant>& instants) {
  ResultsOptions options;
  options.folder = folder;
  options.facts.description = {{"title", "layers"}};
  ResultsFolder results(options);
  results.begin(FakeWorld(), {});
  for (const auto& [stage, heights] : instants) {
    FakeWorld world;
    world.stage_name = stage;
    for (std::size_t id = 0; id < heights.size(); ++id) {
      if (!heights[id]) continue;
      world.add({static_cast<double>(id), 0, *heights[id]}, 0.1);
      world.id.back() = static_cast<std::uint32_t>(id);
    }
    results.frame(world, {});
  }
  results.finish(FakeWorld(), {});
}

/// Classes of the discs, from the left.
std::vector<std::string> classes(const std::string& svg) {
  std::istringstream text(svg);
  boost::property_tree::ptree tree;
  read_xml(text, tree);
  std::vector<std::pair<double, std::string>> discs;
  const auto look = [&](auto& self, const boost::property_tree::ptree& of) -> void {
    for (const auto& [tag, child] : of) {
      if (tag == "circle")
        discs.emplace_back(child.get<double>("<xmlattr>.cx"), child.get<std::string>("<xmlattr>.class"));
      self(self, child);
    }
  };
  look(look, tree);
  std::ranges::sort(discs);
  std::vector<std::string> all;
  for (auto& [x, name] : discs) all.push_back(std::move(name));
  return all;
}

std::optional<std::string> drawn(const std::filesystem::path& folder) {
  RunResults run = read_results(folder);
  return layers_picture(run);
}

/// Frame and stage on the page.
nlohmann::json on_the_page(const std::filesystem::path& folder) {
  return json_of(report_page(std::span(&folder, 1)).html).at("runs").at(0).at("grains").at("layers");
}

nlohmann::json begin(std::size_t frame, const char* stage) { return {{"frame", frame}, {"stage", stage}}; }

TEST(Layers, AreOfTheStartOfTheLastStage) {
  const Folder folder;
  write(folder / "run", {{"fill", {4, 3, 2, 1}}, {"shear", {1, 4.5, 8.5, 11}}, {"shear", {5, 5, 5, 5}}});
  const auto svg = drawn(folder / "run");
  ASSERT_TRUE(svg);
  EXPECT_THAT(classes(*svg), ElementsAre("c0", "c3", "c7", "c9")) << "of ten, from 1 to 11";
  EXPECT_THAT(*svg, HasSubstr("layers by z at the start of shear"));
  EXPECT_EQ(on_the_page(folder / "run"), begin(1, "shear"));
}

TEST(Layers, IgnoreGrainsFarFromAllOthers) {
  const Folder folder;
  write(folder / "run", {{"shear", {1, 4.5, 8.5, 11, -900, 2000}}, {"shear", {5, 5, 5, 5, 5, 5}}});
  EXPECT_THAT(classes(drawn(folder / "run").value()), ElementsAre("c0", "c3", "c7", "c9", "c0", "c9"));
}

TEST(Layers, AreOfTheStageInWhichGrainsBeginToLeave) {
  const Folder folder;
  write(folder / "run",
        {{"fill", {1, 2, {}, 11}}, {"out", {1, 2, 6, 11}}, {"out", {{}, 2, 6, 11}}, {"more", {{}, 1, 1, 1}}});
  EXPECT_THAT(classes(drawn(folder / "run").value()), ElementsAre("c1", "c5", "c9"));
  EXPECT_EQ(on_the_page(folder / "run"), begin(1, "out"));
  // The first frame of that stage has already lost one, and later bodies have no layer.
  write(folder / "other", {{"fill", {1, 2, 11}}, {"out", {{}, 2, 11}}, {"out", {{}, 2, 11, 7}}});
  const std::string svg = drawn(folder / "other").value();
  EXPECT_THAT(classes(svg), ElementsAre("c1", "c9", "n"));
  EXPECT_THAT(svg, HasSubstr("layers by z at the start of out"));
  EXPECT_EQ(on_the_page(folder / "other"), begin(0, "out"));
}

TEST(Layers, AreDrawnWithoutAFrameThatIsDamaged) {
  const Folder folder;
  write(folder / "run", {{"fill", {1, 2}}, {"shear", {1, 3, 11}}, {"shear", {5, 5, 5}}, {"shear", {5, 5, 5}}});
  std::ofstream(folder / "run/frames/000002.h5") << "no frame";
  EXPECT_THAT(classes(drawn(folder / "run").value()), ElementsAre("c0", "c2", "c9"));
}

TEST(Layers, AreNotDrawnForTheFrameThatDefinesThem) {
  const Folder folder;
  write(folder / "run", {{"fill", {1, 2}}, {"shear", {1, 2}}});
  EXPECT_FALSE(drawn(folder / "run"));
  write(folder / "none", {});
  EXPECT_FALSE(drawn(folder / "none"));
}

}  // namespace
}  // namespace grit::layers_tests
