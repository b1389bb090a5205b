// Draws a map of cells. Independent of the simulation.
#pragma once

#include <string>
#include <vector>

#include "output/picture.hpp"

namespace grit {

/// A cell of a map: its centre, its size [m], and a value for each panel in SI units. Values that are not finite are
/// grey.
struct MapCell {
  double x, y, wide, high;
  std::vector<double> values;
};

struct MapPanel {
  std::string label;
  bool about_zero = false;  ///< blue–white–red with white at zero, else from dark to bright
  ScaleEnds ends = {};      ///< of the colours
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

/// The picture as SVG, up to 900 px wide: one panel per value, each with axes and a colour scale, side by side if they
/// are tall or more than four. The colour scale covers the middle 98 % of the cells, or has the given ends. Gaps of
/// less than three quarters of a cell are closed by the nearest cell. Walls are drawn near the cells only.
std::string draw(const MapPicture& picture);

}  // namespace grit
