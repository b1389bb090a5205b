#include "output/map_picture.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "svg_elements.hpp"

namespace grit::map_picture_tests {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Cells of 1 mm side by side with these values.
MapPicture row_of(const std::vector<double>& values, bool about_zero) {
  MapPicture picture;
  picture.panels = {{"value", about_zero}};
  picture.unit = "1";
  for (std::size_t i = 0; i < values.size(); ++i)
    picture.cells.push_back({1e-3 * static_cast<double>(i), 0, 1e-3, 1e-3, {values[i]}});
  return picture;
}

/// Colours and rectangles of the tiles.
struct Tile {
  std::string colour;
  double x, y, wide, high;
};
std::vector<Tile> tiles(const MapPicture& picture) {
  std::vector<Tile> all;
  for (const auto& group : elements(parsed(draw(picture)), "g", "cells"))
    for (const auto& tile : elements(group, "rect"))
      all.push_back({text_of(tile, "fill"), number_of(tile, "x"), number_of(tile, "y"), number_of(tile, "width"),
                     number_of(tile, "height")});
  return all;
}
std::set<std::string> colours(const MapPicture& picture) {
  std::set<std::string> all;
  for (const Tile& tile : tiles(picture)) all.insert(tile.colour);
  return all;
}

constexpr const char *white = "#f6f6f4", *red = "#a01228", *blue = "#144e8c", *dark = "#440154", *bright = "#fde725";

// The palette is a property of the field, whatever the values at an instant.
TEST(MapPicture, HasThePaletteOfItsFieldWhateverTheNumbers) {
  EXPECT_EQ(colours(row_of({-2, 0, 2}, true)), (std::set<std::string>{blue, white, red}));
  EXPECT_EQ(colours(row_of({0, 2}, true)), (std::set<std::string>{white, red})) << "no negative number there";
  EXPECT_EQ(colours(row_of({-2, 0}, true)), (std::set<std::string>{white, blue}));
  EXPECT_EQ(colours(row_of({0, 0}, true)), (std::set<std::string>{white}));
  EXPECT_EQ(colours(row_of({-2, 2}, false)), (std::set<std::string>{dark, bright})) << "numbers on both sides";
  EXPECT_THAT(colours(row_of({7, 7, nan}, false)), testing::AllOf(Contains("#d4d4d0"), SizeIs(2)));
}

TEST(MapPicture, HasAColourScaleWithGivenEnds) {
  MapPicture dilute = row_of({0, 1, 2, 1e6, std::numeric_limits<double>::infinity()}, false);
  EXPECT_EQ(tiles(dilute).at(2).colour, dark) << "one cell makes all others alike";
  dilute.panels[0].ends.most = 2;
  EXPECT_EQ(tiles(dilute).at(2).colour, bright);
  EXPECT_EQ(tiles(dilute).at(4).colour, "#d4d4d0");
  dilute.panels[0].ends.low = 1;
  EXPECT_EQ(tiles(dilute).at(1).colour, dark);
  dilute.panels[0].ends.high = 4;
  EXPECT_NE(tiles(dilute).at(2).colour, bright) << "the set end counts";
  MapPicture cloud = row_of({10, 20}, false);
  cloud.panels[0].ends.most = 2;
  EXPECT_EQ(colours(cloud), (std::set<std::string>{dark, bright})) << "all are above";
}

TEST(MapPicture, HasAxesWithUnitsAndWalls) {
  MapPicture picture = row_of({1, 2, 3, 4}, false);
  picture.cells.push_back({0, 2e-3, 1e-3, 1e-3, {5}});
  const auto bare = parsed(draw(picture));
  EXPECT_THAT(words_of(bare, "axis"), testing::UnorderedElementsAre("x [mm]", "z [mm]"));
  EXPECT_GE(words_of(bare, "m").size(), 4u + 2);
  EXPECT_EQ(elements(bare, "line", "wall").size(), 0u);
  picture.walls = {{-0.5e-3, -0.5e-3, 3.5e-3, -0.5e-3}, {-1, -1, 1, -1}};
  const auto svg = parsed(draw(picture));
  const auto walls = elements(svg, "line", "wall");
  ASSERT_GE(walls.size(), 1u);
  const auto all = tiles(picture);
  const auto lowest = std::ranges::max_element(all, {}, [](const Tile& tile) { return tile.y + tile.high; });
  EXPECT_NEAR(number_of(walls[0], "y1"), lowest->y + lowest->high, 1.5) << "where the cells end";
  // Ticks are at their values: 0 is the centre of the first cell, 3 that of the last.
  const auto texts = elements(svg, "text", "m");
  const auto place = [&](const std::string& number) {
    for (const auto& text : texts)
      if (text.data() == number && text_of(text, "class") == "m") return number_of(text, "x");
    return nan;
  };
  const auto left = std::ranges::min_element(all, {}, &Tile::x);
  EXPECT_NEAR(place("0"), left->x + 0.5 * left->wide, 1.5);
  EXPECT_NEAR((place("3") - place("0")) / 3, left->wide, 1);
}

// From −3 to 14.4: steps of 5 leave three ticks within, steps of 2 nine.
TEST(MapPicture, HasEnoughTicksWhereStepsFallBadly) {
  MapPicture picture = row_of({1, 2}, false);
  picture.cells[0].y = -2.5e-3, picture.cells[1].y = 13.9e-3;
  std::size_t upwards = 0;
  for (const auto& text : elements(parsed(draw(picture)), "text", "e")) upwards += text.data().size() <= 3;
  EXPECT_GE(upwards, 8u);
}

/// Number of tiles at each pixel of their bounding box.
struct Cover {
  int wide, high;
  std::vector<int> count;
  int at(int row, int column) const { return count[static_cast<std::size_t>(row * wide + column)]; }
};
Cover cover_of(const std::vector<Tile>& all) {
  double left = 1e9, right = 0, top = 1e9, bottom = 0;
  for (const Tile& tile : all) {
    left = std::min(left, tile.x), right = std::max(right, tile.x + tile.wide);
    top = std::min(top, tile.y), bottom = std::max(bottom, tile.y + tile.high);
  }
  Cover cover{static_cast<int>(right - left), static_cast<int>(bottom - top), {}};
  cover.count.resize(static_cast<std::size_t>(cover.wide * cover.high));
  for (const Tile& tile : all)
    for (int y = 0; y < tile.high; ++y)
      for (int x = 0; x < tile.wide; ++x) {
        const int column = static_cast<int>(tile.x - left) + x, row = static_cast<int>(tile.y - top) + y;
        ++cover.count[static_cast<std::size_t>(row * cover.wide + column)];
      }
  return cover;
}

// Cells that move with the material: rows shifted relative to each other, rows and columns moved apart.
TEST(MapPicture, HasNoCracksBetweenCellsThatMoved) {
  MapPicture picture;
  picture.panels = {{"strain", true}};
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 12; ++k) picture.cells.push_back({1.3 * i + 0.1 * k, 1.2 * k, 1, 1, {std::sin(i + 2.0 * k)}});
  const auto all = tiles(picture);
  for (const Tile& tile : all)
    for (const double edge : {tile.x, tile.y, tile.wide, tile.high}) EXPECT_EQ(edge, std::round(edge));
  const Cover cover = cover_of(all);
  const double scale = cover.wide / (1.3 * 19 + 0.1 * 11 + 1);
  int seams = 0, twice = 0;
  for (int row = 0; row < cover.high; ++row)
    for (int column = 0; column < cover.wide; ++column) {
      const int here = cover.at(row, column);
      twice += here > 1;
      // Well within the sheared sheet, relative to the nearest row of cells.
      const double z = 1.2 * 11 + 0.5 - (row + 0.5) / scale, k = std::clamp(std::round(z / 1.2), 0.0, 11.0),
                   x = (column + 0.5) / scale - 0.5 - 0.1 * k;
      if (x > 0.5 && x < 1.3 * 19 - 0.5) seams += here == 0;
    }
  EXPECT_EQ(seams, 0);
  EXPECT_EQ(twice, 0);
}

// Columns shifted relative to each other by half a cell; rows and columns moved apart.
TEST(MapPicture, HasNoHolesWhereGapsCross) {
  MapPicture picture;
  picture.panels = {{"strain", true}};
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k)
      picture.cells.push_back({1.6 * i, 1.6 * k + 0.5 * (i % 2), 1, 1, {std::sin(i + 2.0 * k)}});
  const auto all = tiles(picture);
  const Cover cover = cover_of(all);
  const double scale = cover.wide / (1.6 * 3 + 1);
  int holes = 0, beyond = 0;
  for (int row = 0; row < cover.high; ++row)
    for (int column = 0; column < cover.wide; ++column) {
      const int here = cover.at(row, column);
      const double x = (column + 0.5) / scale, z = (cover.high - row - 0.5) / scale;  // from the corner of all
      if (z > 0.52 && z < 1.6 * 2 + 0.98) holes += here == 0;
      // No further than the cells, except in gaps: the first column ends below, the second begins above.
      if ((x < 0.98 && z > 1.6 * 2 + 1.02) || (x > 1.62 && x < 2.58 && z < 0.48)) beyond += here > 0;
    }
  EXPECT_EQ(holes, 0);
  EXPECT_EQ(beyond, 0);
}

TEST(MapPicture, KeepsTheEdgesOfEmptyRegions) {
  MapPicture picture;
  picture.panels = {{"value", false}};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (i != 1 || k != 1) picture.cells.push_back({1.0 * i, 1.0 * k, 1, 1, {1.0 * i + 3 * k}});
  double area = 0, wide = 0;
  for (const Tile& tile : tiles(picture)) area += tile.wide * tile.high, wide = std::max(wide, tile.wide);
  EXPECT_NEAR(area / (wide * wide), 8, 0.05);
}

/// Title and frame of each panel.
struct PanelPlace {
  double title, left, top, right;
};
std::vector<PanelPlace> panels_of(const MapPicture& picture) {
  std::vector<PanelPlace> all;
  const auto svg = parsed(draw(picture));
  for (const auto& text : elements(svg, "text", "label")) all.push_back({number_of(text, "x"), 0, 0, 0});
  std::size_t i = 0;
  for (const auto& frame : elements(svg, "rect", "frame"))
    all.at(i).left = number_of(frame, "x"), all.at(i).top = number_of(frame, "y"),
    all.at(i).right = number_of(frame, "x") + number_of(frame, "width"), ++i;
  return all;
}

/// Cells of 1 mm in rows and columns, each with so many values.
MapPicture sheet_of(int columns, int rows, std::size_t values) {
  MapPicture picture;
  for (std::size_t k = 0; k < values; ++k) picture.panels.push_back({"stress " + std::to_string(k), true});
  picture.unit = "Pa";
  for (int i = 0; i < columns; ++i)
    for (int k = 0; k < rows; ++k)
      picture.cells.push_back({1e-3 * i, 1e-3 * k, 1e-3, 1e-3, std::vector<double>(values, 1e3 * (i + k))});
  return picture;
}

TEST(MapPicture, StandsSideBySideWhereItIsTallOrOfMany) {
  const auto narrow = panels_of(sheet_of(4, 9, 3));
  ASSERT_THAT(narrow, SizeIs(3));
  EXPECT_EQ(narrow[0].top, narrow[2].top);
  EXPECT_GT(narrow[1].left, narrow[0].right + 92) << "with its colour bar in between";
  const auto wide = panels_of(sheet_of(20, 8, 3));
  EXPECT_EQ(wide[0].left, wide[2].left) << "below each other";
  const auto tensor = panels_of(sheet_of(20, 8, 9));
  EXPECT_EQ(tensor[0].top, tensor[1].top) << "of many two in a row";
  EXPECT_GT(tensor[2].top, tensor[0].top);
  EXPECT_EQ(tensor[2].left, tensor[0].left);
  const auto tall = panels_of(sheet_of(4, 9, 9));
  EXPECT_EQ(tall[2].top, tall[0].top) << "three rows of three";
  EXPECT_EQ(tall[3].left, tall[0].left);
  for (const auto& panels : {narrow, wide, tensor, tall})
    for (const PanelPlace& panel : panels) EXPECT_EQ(panel.title, panel.left);
}

TEST(MapPicture, FitsItsFrameToTheMap) {
  const auto svg = parsed(draw(sheet_of(4, 40, 1)));
  EXPECT_EQ(number_of(svg.get_child("svg"), "width"), 420);
  const auto frame = elements(svg, "rect", "frame").at(0);
  const double right = number_of(frame, "x") + number_of(frame, "width");
  double bar = 0;
  for (const auto& piece : elements(svg, "rect"))
    if (number_of(piece, "width") == 14) bar = number_of(piece, "x");
  EXPECT_GT(bar, right);
  EXPECT_LT(bar, right + 40);
  EXPECT_NEAR(number_of(parsed(draw(sheet_of(20, 8, 1))).get_child("svg"), "width"), 900, 1);
}

TEST(MapPicture, HasNoWallOnItsFrame) {
  MapPicture picture = sheet_of(10, 5, 1);
  picture.walls = {{-1e-3, -1.5e-3, 10e-3, -1.5e-3}};
  const auto svg = parsed(draw(picture));
  const auto frame = elements(svg, "rect", "frame").at(0), wall = elements(svg, "line", "wall").at(0);
  EXPECT_LT(number_of(wall, "y1"), number_of(frame, "y") + number_of(frame, "height") - 3);
  EXPECT_GT(number_of(wall, "x1"), number_of(frame, "x") + 3);
}

TEST(MapPicture, LeavesRegionsWithoutCellsEmpty) {
  MapPicture picture = row_of({1, 2}, false);
  picture.cells[1].x = 3e-3;  // two cells are missing between
  const auto all = tiles(picture);
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_NEAR(all[1].x - all[0].x, 3 * all[0].wide, 2);
  picture.cells[1].x = 1.7e-3;  // a crack of 0.7 cells
  const auto closed = tiles(picture);
  ASSERT_THAT(closed, SizeIs(2));
  EXPECT_EQ(closed[0].x + closed[0].wide, closed[1].x);
}

// Invalid values do not affect the rest.
TEST(MapPicture, CopesWithHugeNumbers) {
  const double huge = 1e300;
  for (const bool about_zero : {false, true}) {
    MapPicture picture = row_of({-2, 0, 1, 2, 2}, about_zero);
    picture.walls = {{-10, 0, 10, 0}};
    const auto whole = tiles(picture);
    picture.walls = {{-huge, 0, huge, 0}, {-1e25, 0, 1e25, 0}};
    picture.cells[4].values = {-huge};  // had the colour of its neighbour
    picture.cells.push_back({huge, 0, 1e-3, 1e-3, {0}}), picture.cells.push_back({0, -1e20, 1e-3, 1e-3, {0}});
    picture.cells.push_back({2e-3, 0, huge, 1e-3, {0}}), picture.cells.push_back({2e-3, 0, 1e-3, 1e18, {0}});
    const auto seen = tiles(picture);
    ASSERT_EQ(seen.size(), whole.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
      EXPECT_EQ(seen[i].x, whole[i].x);
      EXPECT_EQ(seen[i].colour, i == 4 ? "#d4d4d0" : whole[i].colour);
    }
    const std::string text = draw(picture);
    EXPECT_THAT(text, testing::Not(testing::AnyOf(HasSubstr("e+"), HasSubstr("inf"), HasSubstr("nan"))));
    EXPECT_THAT(elements(parsed(text), "line", "wall"), SizeIs(1));
    EXPECT_THAT(text, HasSubstr("4 outlying cells not shown"));
  }
  for (const double all : {huge, 1e29}) {
    MapPicture picture = row_of({all, -all, all}, false);
    for (MapCell& cell : picture.cells) cell.x = all;
    EXPECT_THAT(draw(picture), testing::Not(testing::AnyOf(HasSubstr("inf"), HasSubstr("nan"))));
  }
}

TEST(MapPicture, CopesWithNothing) {
  MapPicture picture;
  picture.panels = {{"value", false}};
  EXPECT_THAT(draw(picture), testing::Not(HasSubstr("nan")));
  EXPECT_THAT(draw(row_of({nan, nan}, true)), testing::Not(HasSubstr("nan")));
  EXPECT_THAT(draw(row_of({1}, false)), testing::Not(HasSubstr("inf")));
  MapPicture nowhere = row_of({1, 2}, false);
  for (MapCell& cell : nowhere.cells) {
    cell.x = std::numeric_limits<double>::infinity();
    EXPECT_THAT(draw(nowhere), AllOf(testing::Not(HasSubstr("nan")), testing::Not(HasSubstr("inf"))));
  }
}

}  // namespace
}  // namespace grit::map_picture_tests
