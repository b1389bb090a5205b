// A map of cells as a picture: knows numbers, not worlds.
#pragma once

#include <string>
#include <vector>

namespace grit {

/// A cell of a map: its middle, what it fills [m], and a value of each panel, in SI; not finite: grey.
struct MapCell {
  double x, y, wide, high;
  std::vector<double> values;
};

struct MapPicture {
  std::string title;
  std::string facts;  ///< one line
  std::string horizontal = "x", vertical = "z";
  std::vector<MapCell> cells;
  std::vector<std::string> labels;  ///< of the panels
  std::string unit;                 ///< of all values
};

/// The picture as SVG, 900 px wide: a panel a value, below each other, each with the scale of its colours. It shows 98
/// of 100 cells, the middle ones; blue–white–red about zero where they lie on both sides of it, else from dark to
/// bright.
std::string draw(const MapPicture& picture);

}  // namespace grit
