// Maps of cells: numbers of the frames, selection of maps, ranges of colour scales.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "report/cell_maps.hpp"
#include "report/pictures.hpp"
#include "report/report_page.hpp"
#include "results.hpp"

namespace grit::cell_maps_tests {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const double nan = std::numeric_limits<double>::quiet_NaN();

/// Two cells side by side along x, with a number and a strain each.
FieldGroup two_cells(double density, double shear) {
  return {"cells",
          {{"centre", "m", "", 3, {0.5, 0, 0.5, 1.5, 0, 0.5}},
           {"size", "m", "", 3, {1, 2, 1, 1, 2, 1}},
           {"density", "kg m-3", "of the cell", 1, {density, 2 * density}},
           {"strain", "1", "of the cell", 2, {0.1, -shear, 0.2, shear}, {"zz", "xz"}}}};
}

json made_of(CellMaps& maps) { return maps.result(); }

TEST(CellMaps, HaveABoxWithoutCellsFarFromAllOthers) {
  DataElements data;
  CellMaps maps(data, 1 << 20);
  FieldGroup group = two_cells(1000, 0.5);
  const auto add = [&](std::vector<double> centre, std::vector<double> size, double density) {
    auto append = [](std::vector<double>& list, const std::vector<double>& more) {
      list.insert(list.end(), more.begin(), more.end());
    };
    append(group.fields[0].values, centre), append(group.fields[1].values, size);
    append(group.fields[2].values, {density}), append(group.fields[3].values, {0.1, 0});
  };
  add({1, 0, 0.5}, {1, 2, 1}, 1e300), add({1, 0, 0.5}, {1, 2, 1}, 3000);
  add({1e300, 0, 0.5}, {1, 2, 1}, 1000), add({1, 1e6, 0.5}, {1, 2, 1}, 1000), add({1, 0, 0.5}, {1, 2, 1e300}, 1000);
  maps.add(0, "shear", {group});
  const json all = made_of(maps);
  EXPECT_EQ(all.at(0).at("boxes").at("shear"), (json{{"low", {0, -1, 0}}, {"high", {2, 1, 1}}}));
  EXPECT_EQ(all.at(0).at("fields").at(0).at("ranges").at("shear"), (json{{1000, 3000}}));
}

TEST(CellMaps, HasTheCellsOfEachFrame) {
  DataElements data;
  CellMaps maps(data, 1 << 20);
  maps.add(0, "shear", {two_cells(1000, 0.5)});
  maps.add(1, "shear", {two_cells(1200, 1)});
  const json all = made_of(maps);
  ASSERT_THAT(all, SizeIs(1));
  const json& map = all.at(0);
  EXPECT_EQ(map.at("probe"), "cells");
  EXPECT_EQ(map.at("boxes").at("shear").at("low"), json({0, -1, 0}));
  EXPECT_EQ(map.at("boxes").at("shear").at("high"), json({2, 1, 1}));
  ASSERT_THAT(map.at("frames"), SizeIs(2));
  EXPECT_EQ(map.at("frames").at(1).at("frame"), 1);
  EXPECT_EQ(map.at("frames").at(1).at("cells"), 2);
  EXPECT_THAT(numbers_of<float>(data.html(), map.at("frames").at(1).at("data")),
              ElementsAre(0.5f, 1.5f, 0, 0, 0.5f, 0.5f, 1, 1, 2, 2, 1, 1, 1200, 2400, 0.1f, 0.2f, -1, 1));
  const json &density = map.at("fields").at(0), &strain = map.at("fields").at(1);
  EXPECT_EQ(density.at("name"), "density");
  EXPECT_THAT(density.at("components"), IsEmpty());
  EXPECT_EQ(strain.at("components"), json({"zz", "xz"}));
}

TEST(CellMaps, HasOneScaleForAStage) {
  DataElements data;
  CellMaps maps(data, 1 << 20);
  maps.add(0, "fill", {two_cells(10, 50)});
  maps.add(1, "shear", {two_cells(1000, 0.5)});
  maps.add(2, "shear", {two_cells(1200, 1)});
  const json fields = made_of(maps).at(0).at("fields");
  EXPECT_EQ(fields.at(0).at("ranges").at("fill"), json::parse("[[10, 20]]"));
  EXPECT_EQ(fields.at(0).at("ranges").at("shear"), json::parse("[[1000, 2400]]"));
  EXPECT_EQ(fields.at(0).at("signed"), json::parse("[false]"));
  EXPECT_EQ(fields.at(1).at("ranges").at("shear").at(1), json({-1, 1}));
  EXPECT_EQ(fields.at(1).at("signed"), json({true, true})) << "E_zz too, although it is positive throughout";
}

TEST(CellMaps, HasABoxForAStage) {
  DataElements data;
  CellMaps maps(data, 1 << 20);
  FieldGroup taller = two_cells(10, 50);
  taller.fields[0].values[2] = 4.5;
  maps.add(0, "fill", {taller});
  maps.add(1, "shear", {two_cells(1000, 0.5)});
  const json boxes = made_of(maps).at(0).at("boxes");
  EXPECT_EQ(boxes.at("fill").at("high"), json({2, 1, 5}));
  EXPECT_EQ(boxes.at("shear").at("high"), json({2, 1, 1}));
}

TEST(CellMaps, LeavesTheFarthestOfManyCellsToTheEndsOfTheScale) {
  FieldGroup group{"cells", {{"centre", "m", "", 3, {}}, {"size", "m", "", 3, {}}, {"value", "1", "", 1, {}}}};
  for (int i = 0; i < 1000; ++i) {
    for (const double x : {i + 0.5, 0.5, 0.5}) group.fields[0].values.push_back(x);
    for (int k = 0; k < 3; ++k) group.fields[1].values.push_back(1);
    group.fields[2].values.push_back(i == 17 ? 1e9 : i == 18 ? nan : i == 19 ? INFINITY : i);
  }
  DataElements data;
  CellMaps maps(data, 1 << 20);
  maps.add(0, "shear", {group});
  const json range = made_of(maps).at(0).at("fields").at(0).at("ranges").at("shear").at(0);
  EXPECT_NEAR(range.at(0).get<double>(), 10, 1);
  EXPECT_NEAR(range.at(1).get<double>(), 990, 2);
}

TEST(CellMaps, EndTheScaleOfVoidRatiosBelowThoseOfDiluteCells) {
  FieldGroup group = two_cells(1, 1);
  group.fields[2] = {"void_ratio", "1", "of the cell", 1, {0.6, 250}};
  DataElements data;
  CellMaps maps(data, 1 << 20);
  maps.add(0, "flow", {group});
  group.fields[2].values = {20, 250};
  maps.add(1, "cloud", {group});
  const json ranges = made_of(maps).at(0).at("fields").at(0).at("ranges");
  EXPECT_EQ(ranges.at("flow"), json::parse("[[0.6000000238418579, 3.0]]"));
  EXPECT_EQ(ranges.at("cloud"), json::parse("[[20.0, 250.0]]"));
}

TEST(CellMaps, GivesEachProbeTheSameSpace) {
  FieldGroup many = two_cells(1, 1), few = two_cells(1, 1);
  many.name = "many";
  for (Field& field : many.fields)
    for (int doubled = 0; doubled < 2; ++doubled)
      field.values.insert(field.values.end(), field.values.begin(), field.values.end());
  DataElements data;
  CellMaps maps(data, 1000);  // a frame has 72 bytes of the one, four times as many of the other
  for (std::size_t frame = 0; frame < 5; ++frame) maps.add(frame, "shear", {many, few});
  const json all = made_of(maps);
  EXPECT_THAT(all.at(0).at("frames"), SizeIs(1));
  EXPECT_EQ(all.at(0).at("left_out"), 4);
  EXPECT_THAT(all.at(1).at("frames"), SizeIs(5));
}

TEST(CellMaps, HasSpaceForSomeFramesOnly) {
  DataElements data;
  CellMaps maps(data, 100);  // a frame has 18 numbers of 4 bytes
  maps.add(0, "shear", {two_cells(1, 1)});
  maps.add(1, "shear", {two_cells(1, 1)});
  const json map = made_of(maps).at(0);
  EXPECT_THAT(map.at("frames"), SizeIs(1));
  EXPECT_EQ(map.at("left_out"), 1);
}

TEST(CellMaps, HasNoMapOfBookkeeping) {
  DataElements data;
  CellMaps maps(data, 1 << 20);
  FieldGroup group = two_cells(1000, 0.5);
  group.fields.insert(group.fields.begin() + 2, {"bodies", "1", "whose centres lay in it", 1, {7, 8}});
  FieldGroup counted{"counted", {group.fields[0], group.fields[1], group.fields[2]}};
  maps.add(0, "shear", {group, counted});
  const json all = made_of(maps);
  ASSERT_THAT(all, SizeIs(1)) << "the other one has no other field";
  ASSERT_THAT(all.at(0).at("fields"), SizeIs(2));
  EXPECT_EQ(all.at(0).at("fields").at(0).at("name"), "density");
  EXPECT_GT(all.at(0).at("fields").at(0).at("rank"), all.at(0).at("fields").at(1).at("rank"))
      << "strain is more informative";
  EXPECT_THAT(numbers_of<float>(data.html(), all.at(0).at("frames").at(0).at("data")), SizeIs(2 * (6 + 1 + 2)));
}

TEST(CellMaps, AreNothingWithoutCells) {
  DataElements data;
  CellMaps maps(data, 1 << 20);
  maps.add(0, "shear", {{"cells", {{"centre", "m", "", 3, {}}, {"size", "m", "", 3, {}}, {"value", "1", "", 1, {}}}}});
  EXPECT_THAT(made_of(maps), IsEmpty());
}

/// A run whose frames have these tables.
void write_with(const std::filesystem::path& folder, const std::vector<FieldGroup>& fields) {
  SmallRun run(folder);
  ResultsFolder results(run.options);
  results.begin(run.world, {});
  results.frame(run.world, fields);
  results.finish(run.world, {});
}

TEST(CellMaps, AreTablesWithCentreAndSize) {
  const Folder folder;
  FieldGroup contacts{"contacts", {{"start", "m", "", 3, {1, 2, 3}}, {"force", "N", "", 1, {4}}}};
  FieldGroup plane{"plane", {{"centre", "m", "", 2, {1, 2}}, {"size", "m", "", 3, {1, 2, 3}}, {"a", "1", "", 1, {4}}}};
  FieldGroup other = two_cells(1000, 0.5);
  other.fields.push_back({"of_something_else", "1", "", 1, {1, 2, 3}});
  write_with(folder / "run", {contacts, other, plane});
  const std::filesystem::path path = folder / "run";
  const json maps = json_of(report_page(std::span(&path, 1)).html).at("runs").at(0).at("grains").at("maps");
  ASSERT_THAT(maps, SizeIs(1));
  EXPECT_EQ(maps.at(0).at("probe"), "cells");
  ASSERT_THAT(maps.at(0).at("fields"), SizeIs(2)) << "with as many rows as cells";
  EXPECT_EQ(maps.at(0).at("fields").at(1).at("components"), json({"zz", "xz"}));
}

TEST(CellMaps, AreDrawnWithoutABrowser) {
  const Folder folder;
  FieldGroup cells = two_cells(1000, 0.5);
  cells.fields[2].values[1] = nan;
  write_with(folder / "run", {cells});
  RunResults run = read_results(folder / "run");
  const auto pictures = map_pictures(run);
  ASSERT_THAT(pictures, SizeIs(2));
  EXPECT_EQ(pictures[0].name, "map-cells-density");
  EXPECT_EQ(pictures[1].name, "map-cells-strain");
  EXPECT_THAT(pictures[0].svg, testing::AllOf(HasSubstr("density of cells"), HasSubstr("density [kg/m³]"),
                                              HasSubstr("fill=\"#d4d4d0\"")))
      << "a cell without a number is grey";
  EXPECT_THAT(pictures[1].svg, testing::AllOf(HasSubstr("strain zz"), HasSubstr("strain xz"),
                                              HasSubstr("fill=\"#a01228\""), HasSubstr("fill=\"#144e8c\"")))
      << "red for positive, blue for negative";
}

}  // namespace
}  // namespace grit::cell_maps_tests
