// A map of cells as a picture: knows numbers, not worlds.
#pragma once

#include <string>
#include <vector>

#include "output/picture.hpp"

namespace grit {

/// A cell of a map: its middle, what it fills [m], and a value of each panel, in SI; not finite: grey.
struct MapCell {
  double x, y, wide, high;
  std::vector<double> values;
};

struct MapPanel {
  std::string label;
  bool about_zero = false;  ///< blue–white–red, zero being white, else from dark to bright
};

struct MapPicture {
  std::string title;
  std::string facts;  ///< one line
  std::string horizontal = "x", vertical = "z";
  std::vector<MapCell> cells;
  std::vector<Segment> walls;
  std::vector<MapPanel> panels;
  std::string unit;  ///< of all values
};

/// The picture as SVG, up to 900 px wide: a panel a value, each with its axes and the scale of its colours, side by
/// side where they are tall or more than four. It tells 98 of 100 cells apart, the middle ones. Cells meet: what is
/// less than three quarters of a cell between two is coloured as the nearest one. Of walls what is near the cells is
/// seen.
std::string draw(const MapPicture& picture);

}  // namespace grit
