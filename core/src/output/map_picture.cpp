#include "output/map_picture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "output/clipped.hpp"
#include "output/colours.hpp"
#include "output/scale.hpp"
#include "output/strays.hpp"
#include "output/svg.hpp"

namespace grit {
namespace {

constexpr double width = 900, margin = 36, axis_wide = 58, axis_high = 50, colour_bar = 104, tallest = 480;
constexpr double share_shown = 0.98;  // of the cells, in the middle: the rest is drawn as the scale's ends
constexpr double gap_closed = 0.75;   // of a cell: what is wider between two is a place without cells
constexpr double wall_reach = 0.2;    // of the longer side of the cells' box
constexpr const char* style =
    "text{font-family:'Helvetica Neue',Helvetica,Arial,'Liberation Sans','DejaVu Sans',sans-serif;font-size:12px;"
    "fill:#333}\n.title{font-size:20px;font-weight:600;fill:#111}.facts{font-size:13px;fill:#666}\n"
    ".label{font-size:14px;font-weight:600;fill:#222}.axis{font-size:13px;fill:#222}.m{text-anchor:middle}\n"
    ".e{text-anchor:end}.small{font-size:11px;fill:#666}.frame{fill:none;stroke:#8a8a86;stroke-width:1}\n"
    ".wall{stroke:#1c1c1c;stroke-width:2;stroke-linecap:round}.cells rect{shape-rendering:crispEdges}\n";

struct Colours {
  double low = 0, high = 1;
  std::span<const Rgb> scale = sequential_colours;
  std::string of(double value) const {
    return drawable(value) ? colour_at(scale, (value - low) / (high - low)) : "#d4d4d0";
  }
};

Colours colours_of(const std::vector<MapCell>& cells, std::size_t panel, bool about_zero) {
  std::vector<double> finite;
  for (const MapCell& cell : cells)
    if (drawable(cell.values[panel])) finite.push_back(cell.values[panel]);
  Colours colours;
  if (about_zero) colours = {-1, 1, diverging_colours};
  if (finite.empty()) return colours;
  std::ranges::sort(finite);
  const auto rim = static_cast<std::size_t>(0.5 * (1 - share_shown) * static_cast<double>(finite.size()));
  colours.low = finite[rim], colours.high = finite[finite.size() - 1 - rim];
  const double most = std::max(std::abs(colours.low), std::abs(colours.high));
  if (about_zero) colours.high = most > 0 ? most : 1, colours.low = -colours.high;
  else if (!(colours.high - colours.low > 1e-9 * most))  // round-off is nothing to see
    colours.low -= 0.5 * (most > 0 ? most : 1), colours.high += 0.5 * (most > 0 ? most : 1);
  return colours;
}

/// Where metres are in the plot of a panel, which begins at the pixel (0, 0).
struct Plot {
  double low_x, high_y, scale;  ///< m, px/m
  int wide, high;               ///< px
  double across(double x) const { return (x - low_x) * scale; }
  double down(double y) const { return (high_y - y) * scale; }
};

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
  /// Never so small that places within it have no digits left [m].
  double span() const { return std::max({high - low, 1e-12, 1e-9 * std::abs(low), 1e-9 * std::abs(high)}); }
};

/// Those that are not far from all others, and no larger than that.
std::vector<MapCell> near_cells(const std::vector<MapCell>& cells) {
  std::vector<double> places, sizes;
  for (const MapCell& cell : cells)
    places.insert(places.end(), {cell.x, cell.y, 0}), sizes.push_back(std::max(cell.wide, cell.high));
  const Fences fences(places, median(sizes), far_to_draw);
  std::vector<MapCell> near;
  for (const MapCell& cell : cells)
    if (drawable(cell.x) && drawable(cell.y) && fences.hold(0, cell.x - 0.5 * cell.wide, cell.x + 0.5 * cell.wide) &&
        fences.hold(1, cell.y - 0.5 * cell.high, cell.y + 0.5 * cell.high))
      near.push_back(cell);
  return near;
}

Plot plot_of(const MapPicture& picture) {
  Range x, y;
  for (const MapCell& cell : picture.cells)
    if (std::isfinite(cell.x + cell.y + cell.wide + cell.high))
      for (const double side : {-0.5, 0.5}) x.add(cell.x + side * cell.wide), y.add(cell.y + side * cell.high);
  if (!std::isfinite(x.low)) x = y = {0, 1};
  const double reach = wall_reach * std::max(x.span(), y.span());
  const Range cells_x = x, cells_y = y;
  const auto near = [&](double a, double b, const Range& range) {
    return std::max(a, b) > range.low - reach && std::min(a, b) < range.high + reach;
  };
  for (const Segment& wall : picture.walls) {
    if (!drawable(wall.x1 + wall.x2) || !drawable(wall.y1 + wall.y2)) continue;
    if (!near(wall.x1, wall.x2, cells_x) || !near(wall.y1, wall.y2, cells_y)) continue;
    for (const double end : {wall.x1, wall.x2}) x.add(std::clamp(end, cells_x.low - reach, cells_x.high + reach));
    for (const double end : {wall.y1, wall.y2}) y.add(std::clamp(end, cells_y.low - reach, cells_y.high + reach));
  }
  const double scale = std::min((width - 2 * margin - axis_wide - colour_bar) / x.span(), tallest / y.span());
  return {x.low, y.high, scale, std::max(1, static_cast<int>(std::lround(scale * x.span()))),
          std::max(1, static_cast<int>(std::lround(scale * y.span())))};
}

/// By pixel of the plot, row by row, the place of its cell; -1 of none. It is the cell that is nearest in its own
/// measure, as far as it reaches or along a row or a column to the next one.
std::vector<int> cells_by_pixel(const std::vector<MapCell>& cells, const Plot& plot) {
  const auto wide = static_cast<std::size_t>(plot.wide), high = static_cast<std::size_t>(plot.high);
  std::vector<int> owner(wide * high, -1);
  std::vector<double> distance(owner.size(), std::numeric_limits<double>::infinity());
  constexpr double inside = 1 + 1e-6;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double x = plot.across(cells[i].x), y = plot.down(cells[i].y), half_wide = 0.5 * cells[i].wide * plot.scale,
                 half_high = 0.5 * cells[i].high * plot.scale;
    if (!(half_wide > 0 && half_high > 0) || !std::isfinite(x + y)) continue;
    const auto pixels = [](double middle, double half, int count) {
      const double first = std::ceil(middle - (1 + gap_closed) * half - 0.5),
                   last = std::floor(middle + (1 + gap_closed) * half - 0.5);
      return std::pair(static_cast<int>(std::max(first, 0.0)), static_cast<int>(std::min(last, count - 1.0)));
    };
    const auto [left, right] = pixels(x, half_wide, plot.wide);
    const auto [top, bottom] = pixels(y, half_high, plot.high);
    for (int row = top; row <= bottom; ++row)
      for (int column = left; column <= right; ++column) {
        const double off = std::max(std::abs(column + 0.5 - x) / half_wide, std::abs(row + 0.5 - y) / half_high);
        const auto p = static_cast<std::size_t>(row) * wide + static_cast<std::size_t>(column);
        if (off < distance[p]) distance[p] = off, owner[p] = static_cast<int>(i);
      }
  }
  // Along rows first, then along columns, where what rows have closed counts: so crossings of gaps are closed too.
  std::vector<bool> taken(owner.size());
  for (std::size_t p = 0; p < owner.size(); ++p) taken[p] = distance[p] <= inside;
  const auto close = [&](std::size_t lines, std::size_t length, auto at, auto size) {
    for (std::size_t line = 0; line < lines; ++line)
      for (std::size_t k = 0, next = 0; k < length; ++k) {  // next: behind the last pixel that is taken
        const std::size_t p = at(line, k);
        if (!taken[p]) continue;
        const double gap = static_cast<double>(k - next);
        if (next > 0 && gap <= gap_closed * plot.scale * size(cells[static_cast<std::size_t>(owner[p])]))
          for (std::size_t i = next; i < k; ++i) taken[at(line, i)] = owner[at(line, i)] >= 0;
        next = k + 1;
      }
  };
  close(
      high, wide, [&](std::size_t row, std::size_t column) { return row * wide + column; },
      [](const MapCell& cell) { return cell.wide; });
  close(
      wide, high, [&](std::size_t column, std::size_t row) { return row * wide + column; },
      [](const MapCell& cell) { return cell.high; });
  for (std::size_t p = 0; p < owner.size(); ++p)
    if (!taken[p]) owner[p] = -1;
  return owner;
}

/// Pixels of one cell that make a rectangle.
struct Tile {
  int cell, x, y, wide, high;
};

/// Whole pixels: two tiles that meet have no seam at any zoom.
std::vector<Tile> tiles_of(const std::vector<int>& owner, const Plot& plot) {
  std::vector<Tile> tiles;
  std::vector<std::size_t> above, here;  // of the row before and of this one, from left to right
  for (int row = 0; row < plot.high; ++row) {
    here.clear();
    std::size_t candidate = 0;
    for (int column = 0; column < plot.wide;) {
      const auto at = [&](int x) { return owner[static_cast<std::size_t>(row * plot.wide + x)]; };
      const int cell = at(column), first = column;
      while (column < plot.wide && at(column) == cell) ++column;
      if (cell < 0) continue;
      while (candidate < above.size() && tiles[above[candidate]].x < first) ++candidate;
      if (candidate < above.size()) {
        if (Tile& tile = tiles[above[candidate]];
            std::tuple(tile.cell, tile.x, tile.wide) == std::tuple(cell, first, column - first)) {
          ++tile.high;
          here.push_back(above[candidate]);
          continue;
        }
      }
      here.push_back(tiles.size());
      tiles.push_back({cell, first, row, column - first, 1});
    }
    above.swap(here);
  }
  return tiles;
}

/// An axis that ends where it is told, even where whole steps leave it fewer than 4 ticks or more than 8.
AxisTicks axis_within(double low, double high, double pixels, double room) {
  const auto apart = [&](const AxisTicks& axis) { return axis.step / (axis.high - axis.low) * pixels >= room; };
  const AxisTicks axis = axis_ticks(low, high, AxisEnds::kept, apart);
  if (axis.low == low && axis.high == high) return axis;
  return {low, high, nice_step(high - low, 7), ticks(low, high, 7)};
}

void draw_bar(Svg& svg, const Colours& colours, double factor, double top, double tall) {
  constexpr int pieces = 48;
  const double left = width - margin - 64, low = colours.low * factor, high = colours.high * factor;
  for (int i = 0; i < pieces; ++i)
    svg.rectangle({left, top + tall * (pieces - 1 - i) / pieces}, 14, tall / pieces + 0.3,
                  fmt::format("fill=\"{}\"", colour_at(colours.scale, static_cast<double>(i) / (pieces - 1))));
  const AxisTicks axis = axis_within(low, high, tall, 14);
  for (const double mark : axis.marks) {
    const double y = top + tall * (1 - (mark - low) / (high - low));
    svg.line({left + 14, y}, {left + 18, y}, "class=\"frame\"");
    svg.text({left + 22, y + 4}, tick_label(mark, axis.step));
  }
}

/// Ticks that lie within the plot, numbers on its left and below it.
void draw_axes(Svg& svg, const MapPicture& picture, const Plot& plot, double left, double top) {
  const double span_x = plot.wide / plot.scale, span_y = plot.high / plot.scale, low_y = plot.high_y - span_y;
  const ReadableUnit unit = readable(
      "m", std::max({std::abs(plot.low_x), std::abs(plot.low_x + span_x), std::abs(low_y), std::abs(plot.high_y)}));
  const double bottom = top + plot.high;
  svg.rectangle({left, top}, plot.wide, plot.high, "class=\"frame\"");
  const AxisTicks x = axis_within(plot.low_x * unit.factor, (plot.low_x + span_x) * unit.factor, plot.wide, 44),
                  y = axis_within(low_y * unit.factor, plot.high_y * unit.factor, plot.high, 20);
  for (const double mark : x.marks) {
    const double at = left + plot.across(mark / unit.factor);
    svg.line({at, bottom}, {at, bottom + 4}, "class=\"frame\"");
    svg.text({at, bottom + 17}, tick_label(mark, x.step), "class=\"m\"");
  }
  for (const double mark : y.marks) {
    const double at = top + plot.down(mark / unit.factor);
    svg.line({left - 4, at}, {left, at}, "class=\"frame\"");
    svg.text({left - 7, at + 4}, tick_label(mark, y.step), "class=\"e\"");
  }
  svg.text({left + 0.5 * plot.wide, bottom + 36}, axis_title(picture.horizontal, unit.unit), "class=\"axis m\"");
  svg.text({left - 48, top + 0.5 * plot.high}, axis_title(picture.vertical, unit.unit),
           fmt::format("class=\"axis m\" transform=\"rotate(-90 {:g} {:g})\"", left - 48, top + 0.5 * plot.high));
}

}  // namespace

std::string draw(const MapPicture& whole) {
  MapPicture picture = whole;
  picture.cells = near_cells(whole.cells);
  if (const std::size_t far = whole.cells.size() - picture.cells.size(); far > 0)
    picture.facts += fmt::format("  ·  {} of the cells far from all others, not shown", grouped(far));
  const Plot plot = plot_of(picture);
  const double left = std::round(margin + axis_wide + 0.5 * (width - 2 * margin - axis_wide - colour_bar - plot.wide));
  const double panel_high = std::max<double>(plot.high, 150) + axis_high + 44;
  const double bottom = 92 + panel_high * static_cast<double>(picture.panels.size());
  const double span_x = plot.wide / plot.scale, span_y = plot.high / plot.scale;
  const std::vector<Tile> tiles = tiles_of(cells_by_pixel(picture.cells, plot), plot);

  Svg svg(width, bottom, picture.title, style);
  svg.rectangle({0, 0}, width, bottom, "fill=\"#fff\"");
  svg.text({margin, 44}, picture.title, "class=\"title\"");
  svg.text({margin, 66}, picture.facts, "class=\"facts\"");
  for (std::size_t panel = 0; panel < picture.panels.size(); ++panel) {
    const double top = std::round(114 + panel_high * static_cast<double>(panel));
    const Colours colours = colours_of(picture.cells, panel, picture.panels[panel].about_zero);
    const ReadableUnit unit = readable(picture.unit, std::max(std::abs(colours.low), std::abs(colours.high)));
    svg.text({left, top - 12}, axis_title(picture.panels[panel].label, unit.unit), "class=\"label\"");
    svg.open_group("class=\"cells\"");
    for (const Tile& tile : tiles)
      svg.rectangle(
          {left + tile.x, top + tile.y}, tile.wide, tile.high,
          fmt::format("fill=\"{}\"", colours.of(picture.cells[static_cast<std::size_t>(tile.cell)].values[panel])));
    svg.close_group();
    const std::string id = fmt::format("plot-{}", panel);
    svg.clip(id, {left - 1, top - 1}, plot.wide + 2, plot.high + 2);
    svg.open_group(fmt::format("clip-path=\"url(#{})\"", id));
    for (const Segment& wall : picture.walls)
      if (const auto seen = clipped(wall, plot.low_x - span_x, plot.low_x + 2 * span_x, plot.high_y - 2 * span_y,
                                    plot.high_y + span_y))
        svg.line({left + plot.across(seen->x1), top + plot.down(seen->y1)},
                 {left + plot.across(seen->x2), top + plot.down(seen->y2)}, "class=\"wall\"");
    svg.close_group();
    draw_axes(svg, picture, plot, left, top);
    draw_bar(svg, colours, unit.factor, top, std::clamp<double>(plot.high, 100, 240));
  }
  return std::move(svg).finish();
}

}  // namespace grit
