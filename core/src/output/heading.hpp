// Title and facts above a picture, and how wide it has to be for them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "output/svg.hpp"

namespace grit {

/// What a reader counts: code points.
std::size_t letters(std::string_view text);

/// Title and facts at the upper left, in as many lines as the frame needs, which is fitted to what it is above.
class Heading {
 public:
  static constexpr double widest = 900, margin = 36;  ///< px

  /// `inner` is how wide what stands below is [px]. Facts stand between "  ·  ".
  Heading(const std::string& title, const std::string& facts, double inner);
  double width() const { return width_; }  ///< of the frame, margins included: of what is below, within bounds
  double inner() const { return width_ - 2 * margin; }
  double bottom() const;  ///< where what is below may begin
  void draw(Svg& svg) const;

  /// Of classes "title" and "facts".
  static constexpr std::string_view style =
      "text{font-family:'Helvetica Neue',Helvetica,Arial,'Liberation Sans','DejaVu Sans',sans-serif;font-size:12px;"
      "fill:#333}\n.title{font-size:20px;font-weight:600;fill:#111}.facts{font-size:13px;fill:#666}\n";

 private:
  double width_;
  std::vector<std::string> title_, facts_;
};

}  // namespace grit
