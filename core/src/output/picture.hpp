// Draws a picture of a run: curves above, grains below. Independent of the simulation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/colours.hpp"

namespace grit {

struct Curve {
  std::string name;  ///< in the legend; a name has the same colour, or dash pattern, in all panels
  std::vector<double> x, y;
  bool reference = false;  ///< drawn grey and dashed, without a peak mark
};

struct Axis {
  std::string label;
  std::string unit = "1";  ///< SI; shown with a readable prefix, radians as degrees
};

/// Curves that share two axes with 4 to 8 ticks each. Points that are not drawable() interrupt a curve. With `peaks`
/// the value of largest magnitude is marked, unless it is a spike: on both sides the mean over 1.5 % of the abscissa
/// differs from it by more than 5 % of the curve's range.
struct Panel {
  Axis x, y;
  std::vector<Curve> curves;
  bool peaks = true;
  bool polar = false;  ///< polar steps: x are directions, counter-clockwise from the right; y is 0 at the centre
};

struct Disc {
  double x, y, radius;  ///< m
  double value;         ///< sets the colour; grey if not drawable()
};

struct Segment {
  double x1, y1, x2, y2;  ///< m
};

/// A line from grain to grain.
struct Link {
  double x1, y1, x2, y2;  ///< m
  double weight;          ///< 0 to 1 of the widest
};

/// Grains as seen along an axis.
struct GrainView {
  std::string horizontal = "x", vertical = "z";
  std::vector<Disc> discs;  ///< back to front
  std::vector<Segment> walls;
  std::vector<Link> links;  ///< drawn above the grains, which are then faint
  Axis value;
  std::string note;          ///< below the colour bar: the sign convention
  bool symmetric = true;     ///< blue–white–red about zero, else dark to bright from zero
  ScaleEnds ends = {};       ///< of the colours
  int layers = 0;            ///< if above 0: values are 1, 2, … up to this, each with its own colour
  std::size_t left_out = 0;  ///< number of outliers, which are not drawn; stated in the picture
};

struct Picture {
  std::string title;
  std::string facts;  ///< one line
  std::vector<Panel> panels;
  std::optional<GrainView> grains;
};

/// The picture as SVG, 900 px wide; a view of grains alone is as wide as it needs. Title and facts are wrapped.
std::string draw(const Picture& picture);

}  // namespace grit
