// Writes SVG: shapes in user units (pixels), rounded to a hundredth.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace grit {

/// Escapes a text for SVG and HTML. One with bytes that these cannot hold becomes that of visible_text().
std::string escaped(std::string_view text);

struct Point {
  double x = 0, y = 0;
};

class Svg {
 public:
  /// `style`: style sheet of the classes; `title`: text for screen readers.
  Svg(double width, double height, std::string_view title, std::string_view style);

  // `attributes` are written verbatim, e.g. `class="grid"`.
  void open_group(std::string_view attributes);
  void close_group();
  /// A rectangle that clips groups with clip-path="url(#id)".
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
