// A page about a run: test curves above, the grains below. Knows numbers, not worlds.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace grit {

struct Curve {
  std::string name;  ///< for the legend; one colour, or way of breaking the line, a name, in all panels
  std::vector<double> x, y;
  bool reference = false;  ///< what the others are seen against: grey and broken, without a mark
};

struct Axis {
  std::string label;
  std::string unit = "1";  ///< SI; shown with the prefix that reads best, radians as degrees
};

/// Curves that share two axes, of 4 to 8 ticks each. Points that are not drawable() interrupt a curve; the value
/// farthest from zero is marked where `peaks` says so, unless it is a spike: on both sides the mean over 1.5 % of the
/// abscissa differs from it by more than 5 % of what the curve spans.
struct Panel {
  Axis x, y;
  std::vector<Curve> curves;
  bool peaks = true;
  bool polar = false;  ///< x are directions, from the right towards above, round a middle where y is 0: a step a point
};

struct Disc {
  double x, y, radius;  ///< m
  double value;         ///< what its colour says; not drawable(): grey
};

struct Segment {
  double x1, y1, x2, y2;  ///< m
};

/// A line from grain to grain.
struct Link {
  double x1, y1, x2, y2;  ///< m
  double weight;          ///< 0 to 1 of the widest
};

/// Grains seen along an axis.
struct GrainView {
  std::string horizontal = "x", vertical = "z";
  std::vector<Disc> discs;  ///< back to front
  std::vector<Segment> walls;
  std::vector<Link> links;  ///< above the grains, which are faint then
  Axis value;
  std::string note;          ///< beneath the colour bar: the sign convention
  bool symmetric = true;     ///< blue–white–red about zero, else dark to bright from zero
  int layers = 0;            ///< above 0: values are 1, 2, … up to it, with a colour each
  std::size_t left_out = 0;  ///< bodies that are far from all others: the picture says how many
};

struct Picture {
  std::string title;
  std::string facts;  ///< one line
  std::vector<Panel> panels;
  std::optional<GrainView> grains;
};

/// The picture as SVG: 900 px wide, of grains alone as wide as they need; title and facts in as many lines as that
/// takes.
std::string draw(const Picture& picture);

}  // namespace grit
