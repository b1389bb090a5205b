#include "output/map_picture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/clipped.hpp"
#include "output/colours.hpp"
#include "output/heading.hpp"
#include "output/scale.hpp"
#include "output/strays.hpp"
#include "output/svg.hpp"

namespace grit {
namespace {

constexpr double inner_width = Heading::widest - 2 * Heading::margin, axis_wide = 58, axis_high = 50, colour_bar = 92,
                 panel_gap = 20, tallest_panel = 480,
                 label_letter = 8.4;                 // px
constexpr int few = 4;                               // up to this number wide panels are stacked
constexpr int most_columns = 3, large_enough = 200;  // of panels; px of the longer side
constexpr double scale_fraction = 0.98;              // of the cells, in the middle, covered by the colour scale
constexpr double gap_closed = 0.75;                  // of a cell: wider gaps stay empty
constexpr double wall_reach = 0.2;                   // of the longer side of the cells' box
constexpr double wall_margin = 0.02;  // of the longer side of the plot, so that no wall lies on the frame
constexpr const char* map_style =
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

Colours colours_of(const std::vector<MapCell>& cells, std::size_t panel, const MapPanel& look) {
  const bool about_zero = look.about_zero;
  std::vector<double> finite;
  for (const MapCell& cell : cells)
    if (drawable(cell.values[panel])) finite.push_back(cell.values[panel]);
  Colours colours;
  if (about_zero) colours = {-1, 1, diverging_colours};
  if (finite.empty()) return colours;
  std::ranges::sort(finite);
  const auto rim = static_cast<std::size_t>(0.5 * (1 - scale_fraction) * static_cast<double>(finite.size()));
  colours.low = finite[rim], colours.high = finite[finite.size() - 1 - rim];
  const double most = std::max(std::abs(colours.low), std::abs(colours.high));
  if (about_zero) colours.high = most > 0 ? most : 1, colours.low = -colours.high;
  else if (!(colours.high - colours.low > 1e-9 * most))  // ignores round-off
    colours.low -= 0.5 * (most > 0 ? most : 1), colours.high += 0.5 * (most > 0 ? most : 1);
  const auto [low, high] = with_ends({colours.low, colours.high}, look.ends, about_zero);
  colours.low = low, colours.high = high;
  return colours;
}

/// Maps metres to pixels of a panel's plot, whose upper left corner is (0, 0).
struct Plot {
  double low_x, high_y, scale;  ///< m, px/m
  int wide, high;               ///< px
  double across(double x) const { return (x - low_x) * scale; }
  double down(double y) const { return (high_y - y) * scale; }
};

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
  /// Never below the precision of the coordinates [m].
  double span() const { return std::max({high - low, 1e-12, 1e-9 * std::abs(low), 1e-9 * std::abs(high)}); }
};

/// The cells that are no outliers.
std::vector<MapCell> near_cells(const std::vector<MapCell>& cells) {
  std::vector<double> positions, sizes;
  for (const MapCell& cell : cells)
    positions.insert(positions.end(), {cell.x, cell.y, 0}), sizes.push_back(std::max(cell.wide, cell.high));
  const Fences fences(positions, median(sizes), far_to_draw);
  std::vector<MapCell> near;
  for (const MapCell& cell : cells)
    if (drawable(cell.x) && drawable(cell.y) && fences.hold(0, cell.x - 0.5 * cell.wide, cell.x + 0.5 * cell.wide) &&
        fences.hold(1, cell.y - 0.5 * cell.high, cell.y + 0.5 * cell.high))
      near.push_back(cell);
  return near;
}

/// Width available to a panel in so many columns [px].
double panel_space(int columns) { return (inner_width - panel_gap * (columns - 1)) / columns; }

/// The plot of a panel in so many columns, each with space for axes and the colour scale.
Plot plot_of(const MapPicture& picture, int columns) {
  Extent x, y;
  for (const MapCell& cell : picture.cells)
    if (std::isfinite(cell.x + cell.y + cell.wide + cell.high))
      for (const double side : {-0.5, 0.5}) x.add(cell.x + side * cell.wide), y.add(cell.y + side * cell.high);
  if (!std::isfinite(x.low)) x = y = {0, 1};
  const double reach = wall_reach * std::max(x.span(), y.span());
  const Extent cells_x = x, cells_y = y;
  bool walls = false;
  const auto near = [&](double a, double b, const Extent& range) {
    return std::max(a, b) > range.low - reach && std::min(a, b) < range.high + reach;
  };
  for (const Segment& wall : picture.walls) {
    if (!drawable(wall.x1 + wall.x2) || !drawable(wall.y1 + wall.y2)) continue;
    if (!near(wall.x1, wall.x2, cells_x) || !near(wall.y1, wall.y2, cells_y)) continue;
    for (const double end : {wall.x1, wall.x2}) x.add(std::clamp(end, cells_x.low - reach, cells_x.high + reach));
    for (const double end : {wall.y1, wall.y2}) y.add(std::clamp(end, cells_y.low - reach, cells_y.high + reach));
    walls = true;
  }
  if (walls) {
    const double border = wall_margin * std::max(x.span(), y.span());
    x = {x.low - border, x.high + border}, y = {y.low - border, y.high + border};
  }
  const double space = panel_space(columns) - axis_wide - colour_bar;
  const double scale = std::min(space / x.span(), tallest_panel / y.span());
  return {x.low, y.high, scale, std::max(1, static_cast<int>(std::lround(scale * x.span()))),
          std::max(1, static_cast<int>(std::lround(scale * y.span())))};
}

/// The index of the cell at each pixel of the plot, row by row; -1 for none. It is the nearest cell, in units of the
/// cell's size. Gaps are closed by morphological closing: cells grow by whole pixels, then shrink again except at
/// pixels surrounded by cells.
std::vector<int> cells_by_pixel(const std::vector<MapCell>& cells, const Plot& plot) {
  struct Seen {  // px of the plot
    double x, y, half_wide, half_high;
    int beyond_x, beyond_y;
  };
  std::vector<Seen> seen;
  int margin = 0;
  for (const MapCell& cell : cells) {
    const double half_wide = 0.5 * cell.wide * plot.scale, half_high = 0.5 * cell.high * plot.scale;
    const auto beyond = [](double half) { return half > 0 ? static_cast<int>(std::lround(gap_closed * half)) : 0; };
    seen.push_back(
        {plot.across(cell.x), plot.down(cell.y), half_wide, half_high, beyond(half_wide), beyond(half_high)});
    margin = std::max({margin, seen.back().beyond_x, seen.back().beyond_y});
  }
  // Includes a margin for grown cells.
  const int wide = plot.wide + 2 * margin, high = plot.high + 2 * margin;
  const auto index_of = [](int row, int column, int length) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(length) + static_cast<std::size_t>(column);
  };
  std::vector<int> nearest(index_of(high, 0, wide), -1);
  std::vector<double> distance(nearest.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Seen& cell = seen[i];
    if (!(cell.half_wide > 0 && cell.half_high > 0) || !std::isfinite(cell.x + cell.y)) continue;
    const auto pixels = [&](double middle, double reach, int count) {
      const double first = std::ceil(middle + margin - reach - 0.5), last = std::floor(middle + margin + reach - 0.5);
      return std::pair(static_cast<int>(std::max(first, 0.0)), static_cast<int>(std::min(last, count - 1.0)));
    };
    const auto [left, right] = pixels(cell.x, cell.half_wide + cell.beyond_x, wide);
    const auto [top, bottom] = pixels(cell.y, cell.half_high + cell.beyond_y, high);
    for (int row = top; row <= bottom; ++row)
      for (int column = left; column <= right; ++column) {
        const double off = std::max(std::abs(column - margin + 0.5 - cell.x) / cell.half_wide,
                                    std::abs(row - margin + 0.5 - cell.y) / cell.half_high);
        const auto p = index_of(row, column, wide);
        if (off < distance[p]) distance[p] = off, nearest[p] = static_cast<int>(i);
      }
  }
  std::vector<int> before(index_of(high + 1, 0, wide + 1));  // pixels of cells above and to the left
  for (int row = 0; row < high; ++row)
    for (int column = 0, along = 0; column < wide; ++column) {
      along += nearest[index_of(row, column, wide)] >= 0 ? 1 : 0;
      before[index_of(row + 1, column + 1, wide + 1)] = before[index_of(row, column + 1, wide + 1)] + along;
    }
  constexpr double inside = 1 + 1e-6;
  std::vector<int> owner(index_of(plot.high, 0, plot.wide), -1);
  for (int row = 0; row < plot.high; ++row)
    for (int column = 0; column < plot.wide; ++column) {
      const auto p = index_of(row + margin, column + margin, wide);
      if (nearest[p] < 0) continue;
      const auto [across, up] = std::pair(seen[static_cast<std::size_t>(nearest[p])].beyond_x,
                                          seen[static_cast<std::size_t>(nearest[p])].beyond_y);
      const auto until = [&](int down, int right) {
        return before[index_of(row + margin + down, column + margin + right, wide + 1)];
      };
      const int about =
          until(up + 1, across + 1) - until(-up, across + 1) - until(up + 1, -across) + until(-up, -across);
      if (distance[p] <= inside || about == (2 * across + 1) * (2 * up + 1))
        owner[index_of(row, column, plot.wide)] = nearest[p];
    }
  return owner;
}

/// A rectangle of pixels of one cell.
struct Tile {
  int cell, x, y, wide, high;
};

/// Tiles of whole pixels, so that adjacent ones have no seam at any zoom.
std::vector<Tile> tiles_of(const std::vector<int>& owner, const Plot& plot) {
  std::vector<Tile> tiles;
  std::vector<std::size_t> above, here;  // tiles in the previous and in this row, from left to right
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

/// An axis with the given ends, even if this gives fewer than 4 ticks or more than 8.
AxisTicks axis_within(double low, double high, double pixels, double spacing) {
  const auto apart = [&](const AxisTicks& axis) { return axis.step / (axis.high - axis.low) * pixels >= spacing; };
  const AxisTicks axis = axis_ticks(low, high, AxisEnds::kept, apart);
  if (axis.low == low && axis.high == high) return axis;
  return {low, high, nice_step(high - low, 7), ticks(low, high, 7)};
}

void draw_bar(Svg& svg, const Colours& colours, double factor, double left, double top, double tall) {
  constexpr int pieces = 48;
  const double low = colours.low * factor, high = colours.high * factor;
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

/// Draws ticks within the plot, and numbers to its left and below it.
void draw_axes(Svg& svg, const MapPicture& picture, const Plot& plot, double left, double top) {
  const double span_x = plot.wide / plot.scale, span_y = plot.high / plot.scale, low_y = plot.high_y - span_y;
  const ReadableUnit unit = readable(
      "m", std::max({std::abs(plot.low_x), std::abs(plot.low_x + span_x), std::abs(low_y), std::abs(plot.high_y)}));
  const double bottom = top + plot.high;
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
    picture.facts += fmt::format("  ·  {} outlying cells not shown", grouped(far));
  const int count = static_cast<int>(picture.panels.size());
  struct Panel {
    Colours colours;
    ReadableUnit unit;
    std::string title;
  };
  std::vector<Panel> panels;
  double longest = 0;
  for (std::size_t i = 0; i < picture.panels.size(); ++i) {
    const Colours colours = colours_of(picture.cells, i, picture.panels[i]);
    ReadableUnit unit = readable(picture.unit, std::max(std::abs(colours.low), std::abs(colours.high)));
    std::string title = axis_title(picture.panels[i].label, unit.unit);
    longest = std::max(longest, label_letter * static_cast<double>(letters(title)));
    panels.push_back({colours, std::move(unit), std::move(title)});
  }
  const auto panel_wide = [&](const Plot& plot) { return axis_wide + std::max(plot.wide + colour_bar, longest); };
  // Tall panels, and many panels, are placed side by side as long as they stay large enough.
  Plot plot = plot_of(picture, 1);
  int columns = 1;
  for (int more = 2; more <= std::min(count, most_columns) && (plot.high > plot.wide || count > few); ++more)
    if (const Plot smaller = plot_of(picture, more); std::max(smaller.wide, smaller.high) >= large_enough &&
                                                     panel_wide(smaller) <= panel_space(more) + 1)  // whole pixels
      plot = smaller, columns = more;
  const Heading heading(picture.title, picture.facts, columns * (panel_wide(plot) + panel_gap) - panel_gap);
  const double first = std::round(Heading::margin + axis_wide +
                                  0.5 * (heading.inner() + panel_gap - columns * (panel_wide(plot) + panel_gap)));
  const double panel_high = std::max<double>(plot.high, 150) + axis_high + 44;
  const double bottom = heading.bottom() + panel_high * ((count + columns - 1) / columns);
  const double span_x = plot.wide / plot.scale, span_y = plot.high / plot.scale;
  const std::vector<Tile> tiles = tiles_of(cells_by_pixel(picture.cells, plot), plot);

  Svg svg(heading.width(), bottom, picture.title, std::string(Heading::style) + map_style);
  svg.rectangle({0, 0}, heading.width(), bottom, "fill=\"#fff\"");
  heading.draw(svg);
  for (std::size_t panel = 0; panel < panels.size(); ++panel) {
    const int row = static_cast<int>(panel) / columns, column = static_cast<int>(panel) % columns;
    const double left = first + std::round(column * (panel_wide(plot) + panel_gap)),
                 top = std::round(heading.bottom() + 22 + panel_high * row);
    const auto& [colours, unit, title] = panels[panel];
    svg.text({left, top - 12}, title, "class=\"label\"");
    svg.open_group("class=\"cells\"");
    for (const Tile& tile : tiles)
      svg.rectangle(
          {left + tile.x, top + tile.y}, tile.wide, tile.high,
          fmt::format("fill=\"{}\"", colours.of(picture.cells[static_cast<std::size_t>(tile.cell)].values[panel])));
    svg.close_group();
    svg.rectangle({left, top}, plot.wide, plot.high, "class=\"frame\"");
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
    draw_bar(svg, colours, unit.factor, left + plot.wide + 24, top, std::clamp<double>(plot.high, 100, 240));
  }
  return std::move(svg).finish();
}

}  // namespace grit
