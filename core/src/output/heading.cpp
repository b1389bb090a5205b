#include "output/heading.hpp"

#include <algorithm>

namespace grit {
namespace {

constexpr double narrowest = 420;                            // px, of a frame: in less a title breaks into single words
constexpr double heading_letter = 11.8, facts_letter = 6.9;  // approximate widths, px
constexpr double first_line = 44, title_line = 26, facts_line = 19;
constexpr std::string_view between = "  ·  ";

std::vector<std::string> parts_of(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(separator, at);
    parts.emplace_back(text.substr(at, end - at));
    if (end == text.npos) return parts;
    at = end + separator.size();
  }
}

/// Lines of at most `most` letters, broken at the separator, and within parts that are too long at spaces.
std::vector<std::string> wrapped(std::string_view text, std::string_view separator, double most) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& part, std::string_view glue) {
    const bool fits =
        !lines.empty() && static_cast<double>(letters(lines.back()) + letters(glue) + letters(part)) <= most;
    if (fits) lines.back().append(glue) += part;
    else lines.push_back(part);
  };
  for (const std::string& part : parts_of(text, separator)) {
    if (static_cast<double>(letters(part)) <= most) {
      add(part, separator);
      continue;
    }
    bool first = true;
    for (const std::string& word : parts_of(part, " ")) {
      add(word, first ? separator : " ");
      first = false;
    }
  }
  return lines;
}

}  // namespace

std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

Heading::Heading(const std::string& title, const std::string& facts, double inner)
    : width_(std::clamp(inner + 2 * margin, narrowest, widest)),
      title_(wrapped(title, " ", this->inner() / heading_letter)),
      facts_(wrapped(facts, between, this->inner() / facts_letter)) {}

double Heading::bottom() const {
  return first_line + title_line * static_cast<double>(title_.size() - 1) +
         facts_line * static_cast<double>(facts_.size()) + 29;
}

void Heading::draw(Svg& svg) const {
  double y = first_line;
  for (const std::string& line : title_) svg.text({margin, y}, line, "class=\"title\""), y += title_line;
  y += 22 - title_line;
  for (const std::string& line : facts_) svg.text({margin, y}, line, "class=\"facts\""), y += facts_line;
}

}  // namespace grit
