#include "output/map_picture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "output/colours.hpp"
#include "output/scale.hpp"
#include "output/svg.hpp"

namespace grit {
namespace {

constexpr double width = 900, margin = 36, colour_bar = 96, tallest = 480, share_shown = 0.98, share_of_sign = 0.05;
constexpr const char* style =
    "text{font-family:'Helvetica Neue',Helvetica,Arial,'Liberation Sans','DejaVu Sans',sans-serif;font-size:12px;"
    "fill:#333}\n.title{font-size:20px;font-weight:600;fill:#111}.facts{font-size:13px;fill:#666}\n"
    ".label{font-size:14px;font-weight:600;fill:#222}.e{text-anchor:end}.small{font-size:11px;fill:#666}\n"
    ".frame{stroke:#8a8a86;stroke-width:1}.scale{stroke:#222;stroke-width:2}\n"
    "rect{shape-rendering:crispEdges}\n";

struct Colours {
  double low = 0, high = 1;
  std::span<const Rgb> scale = sequential_colours;
  std::string of(double value) const {
    return std::isfinite(value) ? colour_at(scale, (value - low) / (high - low)) : "#d4d4d0";
  }
};

Colours colours_of(const std::vector<MapCell>& cells, std::size_t panel) {
  std::vector<double> finite;
  for (const MapCell& cell : cells)
    if (std::isfinite(cell.values[panel])) finite.push_back(cell.values[panel]);
  if (finite.empty()) return {};
  std::ranges::sort(finite);
  const auto rim = static_cast<std::size_t>(0.5 * (1 - share_shown) * static_cast<double>(finite.size()));
  Colours colours{finite[rim], finite[finite.size() - 1 - rim], sequential_colours};
  const double most = std::max(-colours.low, colours.high);
  if (std::min(-colours.low, colours.high) > share_of_sign * most) colours = {-most, most, diverging_colours};
  else if (!(colours.high > colours.low))
    colours.low -= 0.5 * (most > 0 ? most : 1), colours.high += 0.5 * (most > 0 ? most : 1);
  return colours;
}

void draw_bar(Svg& svg, const Colours& colours, double factor, double top, double tall) {
  constexpr int pieces = 48;
  const double left = width - margin - 64, low = colours.low * factor, high = colours.high * factor;
  for (int i = 0; i < pieces; ++i)
    svg.rectangle({left, top + tall * (pieces - 1 - i) / pieces}, 14, tall / pieces + 0.3,
                  fmt::format("fill=\"{}\"", colour_at(colours.scale, static_cast<double>(i) / (pieces - 1))));
  const auto marks = ticks(low, high, 4);
  for (const double mark : marks) {
    const double y = top + tall * (1 - (mark - low) / (high - low));
    svg.line({left + 14, y}, {left + 18, y}, "class=\"frame\"");
    svg.text({left + 22, y + 4}, tick_label(mark, marks.size() > 1 ? marks[1] - marks[0] : 1));
  }
}

}  // namespace

std::string draw(const MapPicture& picture) {
  double low_x = std::numeric_limits<double>::infinity(), high_x = -low_x, low_y = low_x, high_y = -low_x;
  for (const MapCell& cell : picture.cells) {
    low_x = std::min(low_x, cell.x - 0.5 * cell.wide), high_x = std::max(high_x, cell.x + 0.5 * cell.wide);
    low_y = std::min(low_y, cell.y - 0.5 * cell.high), high_y = std::max(high_y, cell.y + 0.5 * cell.high);
  }
  const double span_x = std::max(high_x - low_x, 1e-12), span_y = std::max(high_y - low_y, 1e-12);
  const double scale = std::min((width - 2 * margin - colour_bar) / span_x, tallest / span_y);
  const double high = scale * span_y, panel_high = std::max(high, 140.0) + 48,
               left = margin + 0.5 * (width - 2 * margin - colour_bar - scale * span_x);
  const double bottom = 92 + panel_high * static_cast<double>(picture.labels.size());

  Svg svg(width, bottom + 36, picture.title, style);
  svg.rectangle({0, 0}, width, bottom + 36, "fill=\"#fff\"");
  svg.text({margin, 44}, picture.title, "class=\"title\"");
  svg.text({margin, 66}, picture.facts, "class=\"facts\"");
  for (std::size_t panel = 0; panel < picture.labels.size(); ++panel) {
    const double top = 112 + panel_high * static_cast<double>(panel);
    const Colours colours = colours_of(picture.cells, panel);
    const ReadableUnit unit = readable(picture.unit, std::max(std::abs(colours.low), std::abs(colours.high)));
    svg.text({margin, top - 10}, axis_title(picture.labels[panel], unit.unit), "class=\"label\"");
    for (const MapCell& cell : picture.cells)  // a hair larger, so that no paper shows between two
      svg.rectangle(
          {left + (cell.x - 0.5 * cell.wide - low_x) * scale, top + (high_y - cell.y - 0.5 * cell.high) * scale},
          cell.wide * scale + 0.2, cell.high * scale + 0.2, fmt::format("fill=\"{}\"", colours.of(cell.values[panel])));
    draw_bar(svg, colours, unit.factor, top, std::clamp(high, 100.0, 240.0));
  }
  const double length = nice_step(140 / scale, 1), end = left + length * scale;
  const auto unit = readable("m", length);
  svg.line({left, bottom + 4}, {end, bottom + 4}, "class=\"scale\"");
  svg.text({end + 10, bottom + 8}, fmt::format("{:g} {}", length * unit.factor, unit.unit));
  svg.text({left + scale * span_x, bottom + 8}, picture.horizontal + " →\u2003" + picture.vertical + " ↑",
           "class=\"e small\"");
  return std::move(svg).finish();
}

}  // namespace grit
