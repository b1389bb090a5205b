// Title and facts above a picture, and the width that they need.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "output/svg.hpp"

namespace grit {

/// Number of code points.
std::size_t letters(std::string_view text);

/// Title and facts at the upper left, wrapped to the width of the frame, which is fitted to the content below.
class Heading {
 public:
  static constexpr double widest = 900, margin = 36;  ///< px

  /// `inner`: width of the content below [px]. Facts are separated by "  ·  ".
  Heading(const std::string& title, const std::string& facts, double inner);
  double width() const { return width_; }  ///< of the frame, margins included: that of the content, within bounds
  double inner() const { return width_ - 2 * margin; }
  double bottom() const;  ///< top of the content below
  void draw(Svg& svg) const;

  /// Styles of the classes "title" and "facts".
  static constexpr std::string_view style =
      "text{font-family:'Helvetica Neue',Helvetica,Arial,'Liberation Sans','DejaVu Sans',sans-serif;font-size:12px;"
      "fill:#333}\n.title{font-size:20px;font-weight:600;fill:#111}.facts{font-size:13px;fill:#666}\n";

 private:
  double width_;
  std::vector<std::string> title_, facts_;
};

}  // namespace grit
