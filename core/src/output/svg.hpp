// Writes SVG: shapes in user units (pixels), rounded to a hundredth.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace grit {

/// A text as it stands in SVG and HTML.
std::string escaped(std::string_view text);

struct Point {
  double x = 0, y = 0;
};

class Svg {
 public:
  /// `style` is the sheet that classes refer to; `title` is what a screen reader says.
  Svg(double width, double height, std::string_view title, std::string_view style);

  // `attributes` are written as they are, e.g. `class="grid"`.
  void open_group(std::string_view attributes);
  void close_group();
  /// A rectangle that clips what a group with clip-path="url(#id)" draws.
  void clip(std::string_view id, Point corner, double width, double height);
  void line(Point from, Point to, std::string_view attributes = {});
  void polyline(std::span<const Point> points, std::string_view attributes = {});
  void circle(Point centre, double radius, std::string_view attributes = {});
  void rectangle(Point corner, double width, double height, std::string_view attributes = {});
  void text(Point at, std::string_view text, std::string_view attributes = {});

  std::string finish() &&;

 private:
  void element(std::string_view name, std::string_view attributes);
  void attribute(std::string_view name, double value);

  std::string out_;
};

}  // namespace grit
