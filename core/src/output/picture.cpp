#include "output/picture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/clipped.hpp"
#include "output/colours.hpp"
#include "output/heading.hpp"
#include "output/scale.hpp"
#include "output/svg.hpp"

namespace grit {
namespace {

constexpr double page_margin = Heading::margin, widest = Heading::widest - 2 * page_margin;  // px, between the margins
constexpr int classes = 21;  // of colour; odd, so that one is zero

// Colour-blind-safe colours with contrast on white, after Okabe and Ito.
constexpr std::array<const char*, 6> palette{"#0b5394", "#d55e00", "#00866b", "#a8518a", "#7a6a00", "#555555"};
/// Dash patterns of references.
constexpr std::array<const char*, 4> dashes{"2 4", "8 3 2 3", "6 4", "12 3"};
constexpr double peak_width = 0.015, peak_height = 0.05;  // fractions of the x axis and of the curve's range; is_peak()
constexpr double letter_width = 6.6;                      // approximate width, px

/// Approximate width of an axis title [px].
double title_wide(const std::string& title) {
  constexpr double title_letter = 7.2;
  return title_letter * static_cast<double>(letters(title));
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (!drawable(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double span() const { return high - low; }
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
  bool empty() const { return !(low <= high); }
};

int classes_of(const GrainView& view) { return view.layers > 0 ? view.layers : classes; }

/// The colour of class i: blue–white–red about zero, else from dark to bright.
std::string class_colour(int i, const GrainView& view) {
  const double place = static_cast<double>(i) / std::max(1, classes_of(view) - 1);
  return view.layers == 0 && view.symmetric ? colour_at(diverging_colours, place)
                                            : colour_at(sequential_colours, place);
}

std::string style(const Picture& picture) {
  std::string sheet(Heading::style);
  sheet +=
      ".axis{font-size:13px;fill:#222}"
      ".m{text-anchor:middle}.e{text-anchor:end}.peak{font-weight:600;paint-order:stroke;stroke:#fff;stroke-width:7px;"
      "stroke-linejoin:round}.small{font-size:11px;fill:#666}.ring{paint-order:stroke;stroke:#fff;stroke-width:4px}\n"
      ".grid{stroke:#e6e6e3;stroke-width:1}.frame{stroke:#8a8a86;stroke-width:1}\n"
      ".curve{fill:none;stroke-width:1.8;stroke-linejoin:round;stroke-linecap:round}\n"
      ".wall{stroke:#1c1c1c;stroke-width:2;stroke-linecap:round}.scale{stroke:#222;stroke-width:2}\n"
      ".link{stroke:#1c1c1c;stroke-linecap:round}.faint{opacity:.3}\n"
      ".grains{stroke:#4a4a4a;stroke-opacity:.55}.n{fill:#c9c9c5}\n";
  for (std::size_t i = 0; i < palette.size(); ++i)
    sheet += fmt::format(".k{0}{{stroke:{1}}}.f{0}{{fill:{1}}}\n", i, palette[i]);
  for (std::size_t i = 0; i < dashes.size(); ++i)
    sheet += fmt::format(".r{}{{stroke:#666;stroke-dasharray:{}}}\n", i, dashes[i]);
  if (picture.grains)
    for (int i = 0; i < classes_of(*picture.grains); ++i)
      sheet += fmt::format(".c{}{{fill:{}}}", i, class_colour(i, *picture.grains));
  return sheet + '\n';
}

/// Names of curves and of references in the order of their first appearance; their indices select the line style.
struct Names {
  std::vector<std::string> curves, references;

  explicit Names(const std::vector<Panel>& panels) {
    for (const auto& panel : panels)
      for (const auto& curve : panel.curves) {
        auto& names = curve.reference ? references : curves;
        if (std::ranges::find(names, curve.name) == names.end()) names.push_back(curve.name);
      }
  }
  static std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  }
  std::size_t colour_of(const std::string& name) const { return index_of(curves, name) % palette.size(); }
  /// The style class of a line.
  std::string style_of(const std::string& name, bool reference) const {
    return reference ? fmt::format("r{}", index_of(references, name) % dashes.size())
                     : fmt::format("k{}", colour_of(name));
  }
  bool tell_apart() const { return curves.size() > 1 || !references.empty(); }
};

/// Lays out the legend row by row and draws it unless `svg` is null. Returns its height [px].
double legend(Svg* svg, const Names& names, double top) {
  if (!names.tell_apart()) return 0;
  constexpr double sample = 26, row = 20;
  double x = page_margin, y = top;
  const auto entry = [&](const std::string& name, bool reference) {
    if (name.empty()) return;
    const double wide = sample + 7 + letter_width * static_cast<double>(letters(name));
    if (x > page_margin && x + wide > page_margin + widest) x = page_margin, y += row;
    if (svg) {
      svg->line({x, y}, {x + sample, y}, fmt::format("class=\"curve {}\"", names.style_of(name, reference)));
      svg->text({x + sample + 7, y + 4}, name);
    }
    x += wide + 22;
  };
  for (const auto& name : names.curves) entry(name, false);
  for (const auto& name : names.references) entry(name, true);
  return y - top + row;
}

class PanelDrawing {
 public:
  PanelDrawing(Svg& svg, const Panel& panel, const Names& names, Point corner, double wide, double high)
      : svg_(svg), panel_(panel), names_(names) {
    left_ = corner.x + 46, right_ = corner.x + wide - 12, top_ = corner.y + 26, bottom_ = corner.y + high - 44;
    for (const auto& curve : panel.curves)
      for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
        if (drawable(curve.x[i]) && drawable(curve.y[i])) {
          x_.add(curve.x[i]);
          y_.add(curve.y[i]);
        }
    if (x_.empty()) x_ = y_ = {0, 1};
    x_unit_ = readable(panel.x.unit, x_.largest());
    y_unit_ = readable(panel.y.unit, y_.largest());
    for (auto* end : {&x_.low, &x_.high}) *end *= x_unit_.factor;
    for (auto* end : {&y_.low, &y_.high}) *end *= y_unit_.factor;
    settle_ranges();
  }

  void draw() {
    for (const double mark : y_ticks_.marks) {
      svg_.line({left_, down(mark)}, {right_, down(mark)}, "class=\"grid\"");
      svg_.text({left_ - 7, down(mark) + 4}, tick_label(mark, y_ticks_.step), "class=\"e\"");
    }
    for (const double mark : x_ticks_.marks) {
      svg_.line({across(mark), top_}, {across(mark), bottom_}, "class=\"grid\"");
      svg_.text({across(mark), bottom_ + 17}, tick_label(mark, x_ticks_.step), "class=\"m\"");
    }
    const double base = y_.low <= 0 && y_.high >= 0 ? down(0) : bottom_;
    svg_.line({left_, base}, {right_, base}, "class=\"frame\"");
    svg_.line({left_, top_}, {left_, bottom_}, "class=\"frame\"");
    svg_.text({left_ - 40, top_ - 12}, axis_title(panel_.y.label, y_unit_.unit), "class=\"axis\"");
    svg_.text({(left_ + right_) / 2, bottom_ + 37}, axis_title(panel_.x.label, x_unit_.unit), "class=\"axis m\"");
    for (const bool reference : {true, false})  // curves above references
      for (const auto& curve : panel_.curves)
        if (curve.reference == reference) draw_curve(curve);
    for (const auto& curve : panel_.curves)
      if (panel_.peaks && !curve.reference) mark_peak(curve);
  }

 private:
  double across(double x) const { return left_ + (x - x_.low) / x_.span() * (right_ - left_); }
  double down(double y) const { return bottom_ - (y - y_.low) / y_.span() * (bottom_ - top_); }
  Point place(const Curve& curve, std::size_t i) const {
    return {across(curve.x[i] * x_unit_.factor), down(curve.y[i] * y_unit_.factor)};
  }

  /// Rounds the y range to ticks, includes zero if it is near, adds no tick for noise around one, and avoids empty
  /// ranges.
  void settle_ranges() {
    if (x_.span() <= 0) x_ = {x_.low - 0.5, x_.high + 0.5};
    if (y_.low > 0 && y_.low < 0.5 * y_.high) y_.low = 0;
    if (y_.high < 0 && y_.high > 0.5 * y_.low) y_.high = 0;
    if (y_.span() <= 1e-12 * y_.largest() || y_.span() <= 0) {
      const double border = y_.largest() > 0 ? 0.5 * y_.largest() : 1;
      y_ = {y_.low - border, y_.high + border};
    }
    // Leaves space above for the number at a peak.
    y_ticks_ = axis_ticks(y_.low + 0.03 * y_.span(), y_.high + 0.04 * y_.span(), AxisEnds::whole_steps);
    y_ = {y_ticks_.low, y_ticks_.high};
    const auto apart = [&](const AxisTicks& axis) {
      std::size_t longest = 0;
      for (const double mark : axis.marks) longest = std::max(longest, letters(tick_label(mark, axis.step)));
      const double between = axis.step / (axis.high - axis.low) * (right_ - left_);
      return letter_width * static_cast<double>(longest) + 8 < between;
    };
    x_ticks_ = axis_ticks(x_.low, x_.high, AxisEnds::kept, apart);
    x_ = {x_ticks_.low, x_ticks_.high};
  }

  void draw_curve(const Curve& curve) {
    const auto attributes = fmt::format("class=\"curve {}\"", names_.style_of(curve.name, curve.reference));
    std::vector<Point> points;
    const auto finish = [&] {
      if (!points.empty()) svg_.polyline(points, attributes);
      points.clear();
    };
    const auto count = std::min(curve.x.size(), curve.y.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (!drawable(curve.x[i]) || !drawable(curve.y[i])) {
        finish();
        continue;
      }
      const auto point = place(curve, i);
      // Skips points that move by less than a quarter of a pixel, to keep files small.
      if (points.empty() || i + 1 == count || std::hypot(point.x - points.back().x, point.y - points.back().y) > 0.25)
        points.push_back(point);
    }
    finish();
  }

  /// Whether the mean of the points on at least one side is near the peak, or there are no such points; else it is a
  /// spike of noise.
  bool is_peak(const Curve& curve, std::size_t peak) const {
    Range all;
    const std::size_t count = std::min(curve.x.size(), curve.y.size());
    for (std::size_t i = 0; i < count; ++i)
      if (drawable(curve.x[i]) && drawable(curve.y[i])) all.add(curve.y[i]);
    bool alone = true, near = false;
    for (const int step : {-1, 1}) {
      double sum = curve.y[peak], points = 1;
      const auto is_neighbour = [&](std::size_t i) {  // before the first point i wraps around to more than count
        return i < count && drawable(curve.x[i]) && drawable(curve.y[i]) &&
               std::abs(curve.x[i] - curve.x[peak]) * x_unit_.factor <= peak_width * x_.span();
      };
      for (std::size_t i = peak + static_cast<std::size_t>(step); is_neighbour(i); i += static_cast<std::size_t>(step))
        sum += curve.y[i], ++points;
      if (points == 1) continue;
      alone = false;
      near = near || std::abs(curve.y[peak] - sum / points) <= peak_height * all.span();
    }
    return alone || near;
  }

  void mark_peak(const Curve& curve) {
    std::size_t peak = 0;
    bool found = false;
    for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
      if (drawable(curve.x[i]) && drawable(curve.y[i]) && (!found || std::abs(curve.y[i]) > std::abs(curve.y[peak]))) {
        peak = i;
        found = true;
      }
    if (!found || !is_peak(curve, peak)) return;
    const auto at = place(curve, peak);
    const auto k = names_.colour_of(curve.name);
    svg_.circle(at, 3, fmt::format("class=\"f{}\"", k));
    const char* anchor = at.x > right_ - 30 ? "e" : at.x < left_ + 30 ? "" : "m";
    const double aside = at.x < left_ + 30 ? 6 : 0;
    const bool below = curve.y[peak] < 0 && at.y + 17 < bottom_;  // never among the numbers of the axis
    svg_.text({at.x + aside, below ? at.y + 17 : at.y - 8}, short_number(curve.y[peak] * y_unit_.factor),
              fmt::format("class=\"peak {} f{}\"", anchor, k));
  }

  Svg& svg_;
  const Panel& panel_;
  const Names& names_;
  double left_, right_, top_, bottom_;
  Range x_, y_;
  AxisTicks x_ticks_{}, y_ticks_{};
  ReadableUnit x_unit_, y_unit_;
};

class PolarDrawing {
 public:
  PolarDrawing(Svg& svg, const Panel& panel, const Names& names, Point corner, double wide, double high)
      : svg_(svg), panel_(panel), names_(names), corner_(corner) {
    constexpr double above = 34, around = 22;  // px, for the title and the names of directions
    radius_ = 0.5 * std::min(wide, high - above) - around;
    middle_ = {corner.x + 0.5 * wide, corner.y + above + around + radius_};
    double most = 0;
    for (const Curve& curve : panel.curves)
      for (const double y : curve.y)
        if (drawable(y)) most = std::max(most, y);
    unit_ = readable(panel.y.unit, most);
    rings_ = axis_ticks(0, most > 0 ? most * unit_.factor : 1, AxisEnds::whole_steps);
    angle_ = panel.x.unit == "rad" ? 1 : degree;
  }

  void draw() {
    constexpr double label_angle = 75 * degree;
    svg_.text({corner_.x + 6, corner_.y + 14}, axis_title(panel_.y.label, unit_.unit), "class=\"axis\"");
    for (const double ring : rings_.marks)
      if (ring > 0) svg_.circle(middle_, radius_ * ring / rings_.high, "class=\"grid\" fill=\"none\"");
    for (int spoke = 0; spoke < 12; ++spoke) svg_.line(middle_, at(spoke * 30 * degree, rings_.high), "class=\"grid\"");
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Point name = at(quarter * 90 * degree, rings_.high * (1 + 13 / radius_));
      svg_.text({name.x, name.y + 4}, fmt::format("{}°", 90 * quarter), "class=\"m\"");
    }
    for (const Curve& curve : panel_.curves) draw_curve(curve);
    for (const double ring : rings_.marks)
      if (ring > 0) {
        const Point label = at(label_angle, ring);
        svg_.text({label.x, label.y + 4}, tick_label(ring, rings_.step), "class=\"small ring m\"");
      }
  }

 private:
  static constexpr double degree = std::numbers::pi / 180;

  Point at(double angle, double value) const {
    const double r = radius_ * value / rings_.high;
    return {middle_.x + r * std::cos(angle), middle_.y - r * std::sin(angle)};
  }
  /// Each value applies to the interval of directions around it.
  void draw_curve(const Curve& curve) {
    const std::size_t count = std::min(curve.x.size(), curve.y.size());
    if (count < 2) return;
    const double half = 0.5 * std::abs(curve.x[1] - curve.x[0]);
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i)
      for (const double part : {-1.0, -0.5, 0.0, 0.5, 1.0})
        points.push_back(at(angle_ * (curve.x[i] + part * half), std::max(0.0, curve.y[i]) * unit_.factor));
    points.push_back(points.front());
    if (std::ranges::all_of(curve.y, drawable))
      svg_.polyline(points, fmt::format("class=\"curve {}\"", names_.style_of(curve.name, curve.reference)));
  }

  Svg& svg_;
  const Panel& panel_;
  const Names& names_;
  Point corner_, middle_{};
  double radius_ = 0, angle_ = 1;
  AxisTicks rings_{};
  ReadableUnit unit_;
};

/// Layout of the view of grains and its colour scale.
struct ViewLayout {
  Range x, y;                ///< m
  double scale = 1;          ///< px/m
  double wide, high;         ///< px
  ColourRange values{0, 1};  ///< of the outermost colours
  ReadableUnit unit{};       ///< of these values
  std::string value_title;   ///< above the colour bar
  double bar = 0;            ///< width of the colour bar, including the gap [px]; 0 without one
};

constexpr double bar_gap = 28;  // between the view and the colour bar, px

ViewLayout layout(const GrainView& view) {
  constexpr double tallest = 640;
  ViewLayout result;
  std::vector<double> sizes;
  for (const auto& disc : view.discs) {
    if (!drawable(disc.x) || !drawable(disc.y) || !drawable(disc.radius)) continue;
    for (const double side : {-disc.radius, disc.radius}) {
      result.x.add(disc.x + side);
      result.y.add(disc.y + side);
    }
    if (drawable(disc.value)) sizes.push_back(std::abs(disc.value));
  }
  // Walls may extend far beyond the grains; they are shown over a third of the grains' extent.
  const bool bare = result.x.empty();
  const double reach = bare ? 0 : 0.35 * std::max(result.x.span(), result.y.span());
  const Range x = result.x, y = result.y;
  for (const auto& wall : view.walls) {
    if (!drawable(wall.x1) || !drawable(wall.y1) || !drawable(wall.x2) || !drawable(wall.y2)) continue;
    const auto beyond = [&](double a, double b, const Range& range) {
      return std::max(a, b) < range.low - reach || std::min(a, b) > range.high + reach;
    };
    if (!bare && (beyond(wall.x1, wall.x2, x) || beyond(wall.y1, wall.y2, y))) continue;  // e.g. a gate moved far away
    const auto within = [&](double value, const Range& range) {
      return bare ? value : std::clamp(value, range.low - reach, range.high + reach);
    };
    for (const double end : {wall.x1, wall.x2}) result.x.add(within(end, x));
    for (const double end : {wall.y1, wall.y2}) result.y.add(within(end, y));
  }
  if (result.x.empty()) result.x = result.y = {0, 1};
  const double most = std::max(result.x.span(), result.y.span());
  if (result.x.span() < 1e-3 * most) result.x = {result.x.low - 0.1 * most, result.x.high + 0.1 * most};
  if (result.y.span() < 1e-3 * most) result.y = {result.y.low - 0.1 * most, result.y.high + 0.1 * most};
  if (most <= 0) {
    const double border = std::max({0.5, 1e-3 * std::abs(result.x.low), 1e-3 * std::abs(result.y.low)});
    result.x = {result.x.low - border, result.x.low + border},
    result.y = {result.y.low - border, result.y.low + border};
  }
  if (!sizes.empty()) {
    double limit = colour_limit(std::move(sizes));
    if (!(limit > 0)) limit = 1;
    result.values = with_ends({view.symmetric ? -limit : 0, limit}, view.ends, view.symmetric);
    result.unit = readable(view.value.unit, std::max(std::abs(result.values.low), std::abs(result.values.high)));
    result.value_title = axis_title(view.value.label, result.unit.unit);
    constexpr double numbers = 64;  // px
    const double words =
        std::max(title_wide(result.value_title), letter_width * static_cast<double>(letters(view.note)));
    result.bar = bar_gap + std::max(numbers, words);
  }
  result.scale = std::min((widest - result.bar) / result.x.span(), tallest / result.y.span());
  result.wide = result.scale * result.x.span();
  result.high = result.scale * result.y.span();
  return result;
}

int class_of(double value, const ColourRange& values, const GrainView& view) {
  if (view.layers > 0) return std::clamp(static_cast<int>(std::lround(value)), 1, view.layers) - 1;
  const double place = (value - values.low) / (values.high - values.low);
  return static_cast<int>(std::lround(std::clamp(place, 0.0, 1.0) * (classes - 1)));
}

void draw_grains(Svg& svg, const GrainView& view, const ViewLayout& at, double left, double top) {
  const auto place = [&](double x, double y) {
    return Point{left + (x - at.x.low) * at.scale, top + (at.y.high - y) * at.scale};
  };
  svg.clip("view", {left - 3, top - 3}, at.wide + 6, at.high + 6);
  svg.open_group("clip-path=\"url(#view)\"");
  double mean = 0;
  for (const auto& disc : view.discs)
    if (drawable(disc.radius)) mean += disc.radius / static_cast<double>(view.discs.size());
  svg.open_group(fmt::format("class=\"grains{}\" stroke-width=\"{:.2f}\"", view.links.empty() ? "" : " faint",
                             std::clamp(0.12 * mean * at.scale, 0.05, 0.8)));
  std::vector<std::string> names;
  for (int i = 0; i < classes_of(view); ++i) names.push_back(fmt::format("class=\"c{}\"", i));
  for (const auto& disc : view.discs) {
    if (!drawable(disc.x) || !drawable(disc.y) || !drawable(disc.radius)) continue;
    const bool coloured = drawable(disc.value);
    svg.circle(place(disc.x, disc.y), disc.radius * at.scale,
               coloured ? names[static_cast<std::size_t>(class_of(disc.value, at.values, view))] : "class=\"n\"");
  }
  svg.close_group();
  // Clips at half the view's extent beyond its edges, so that cut ends are not visible.
  const double beyond_x = 0.5 * at.x.span(), beyond_y = 0.5 * at.y.span();
  const auto in_sight = [&](const Segment& segment) {
    return clipped(segment, at.x.low - beyond_x, at.x.high + beyond_x, at.y.low - beyond_y, at.y.high + beyond_y);
  };
  for (const Link& link : view.links)
    if (const auto seen = in_sight({link.x1, link.y1, link.x2, link.y2}))
      svg.line(place(seen->x1, seen->y1), place(seen->x2, seen->y2),
               fmt::format("class=\"link\" stroke-width=\"{:.2f}\"",
                           std::max(0.8, 1.2 * mean * at.scale * std::clamp(link.weight, 0.0, 1.0))));
  std::set<std::array<long, 4>> drawn;  // an edge that two triangles share is one line
  for (const auto& wall : view.walls) {
    const auto seen = in_sight(wall);
    if (!seen) continue;
    auto a = place(seen->x1, seen->y1), b = place(seen->x2, seen->y2);
    if (std::pair(b.x, b.y) < std::pair(a.x, a.y)) std::swap(a, b);
    if (std::hypot(a.x - b.x, a.y - b.y) < 0.01) continue;
    if (drawn.insert({std::lround(100 * a.x), std::lround(100 * a.y), std::lround(100 * b.x), std::lround(100 * b.y)})
            .second)
      svg.line(a, b, "class=\"wall\"");
  }
  svg.close_group();
}

void draw_scale_bar(Svg& svg, const GrainView& view, const ViewLayout& at, double left, double top) {
  const double y = top + at.high + 24;
  const double length = nice_step(std::min(140.0, 0.5 * at.wide) / at.scale, 1);
  const auto unit = readable("m", length);
  const double end = left + length * at.scale;
  svg.line({left, y}, {end, y}, "class=\"scale\"");
  for (const double x : {left, end}) svg.line({x, y - 4}, {x, y + 4}, "class=\"scale\"");
  const std::string label = fmt::format("{:g} {}", length * unit.factor, unit.unit),
                    axes = view.horizontal + " →\u2003" + view.vertical + " ↑";
  svg.text({end + 10, y + 4}, label);
  const double taken = end + 10 + letter_width * static_cast<double>(letters(label) + letters(axes) + 2);
  if (taken < left + at.wide) svg.text({left + at.wide, y + 4}, axes, "class=\"e small\"");
  else svg.text({left, y + 22}, axes, "class=\"small\"");
}

void draw_colour_bar(Svg& svg, const GrainView& view, const ViewLayout& at, double left, double top) {
  if (at.bar == 0) return;
  const double tall = std::clamp(at.high - 60, 120.0, 240.0), first = top + 20;
  svg.text({left, top + 4}, at.value_title, "class=\"axis\"");
  const int pieces = classes_of(view);
  for (int i = 0; i < pieces; ++i)
    svg.rectangle({left, first + tall * (pieces - 1 - i) / pieces}, 14, tall / pieces + 0.3,
                  fmt::format("class=\"c{}\"", i));
  double high = at.values.high * at.unit.factor, low = at.values.low * at.unit.factor;
  auto marks = ticks(low, high, 4);
  if (view.layers > 0) {  // a number at the middle of each piece
    low = 0.5, high = view.layers + 0.5;
    marks.clear();
    for (int layer = 1; layer <= view.layers; ++layer) marks.push_back(layer);
  }
  for (const double mark : marks) {
    const double y = first + tall * (1 - (mark - low) / (high - low));
    svg.line({left + 14, y}, {left + 18, y}, "class=\"frame\"");
    svg.text({left + 22, y + 4}, tick_label(mark, marks.size() > 1 ? marks[1] - marks[0] : 1));
  }
  if (!view.note.empty()) svg.text({left, first + tall + 20}, view.note, "class=\"small\"");
}

}  // namespace

std::string draw(const Picture& picture) {
  const auto count = picture.panels.size();
  constexpr double gap = 16;
  const auto panel_wide_of = [&](std::size_t columns) {
    return (widest - gap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
  };
  auto columns = count <= 3 ? std::max<std::size_t>(count, 1) : count % 3 == 0 ? 3 : 2;
  for (const Panel& panel : picture.panels)  // each title fits above its panel
    while (columns > 1 && title_wide(axis_title(panel.y.label, panel.y.unit)) > panel_wide_of(columns)) --columns;
  const auto rows = (count + columns - 1) / columns;
  const auto view = picture.grains ? layout(*picture.grains) : ViewLayout{};
  const std::size_t left_out = picture.grains ? picture.grains->left_out : 0;
  const Heading heading(
      picture.title, picture.facts + (left_out > 0 ? fmt::format("  ·  {} outliers not shown", grouped(left_out)) : ""),
      count > 0 ? widest : view.wide + view.bar);
  const Names names(picture.panels);
  const double panels_top = heading.bottom() + legend(nullptr, names, 0), panel_high = columns == 1   ? 300
                                                                                       : columns == 2 ? 280
                                                                                                      : 250;
  const double panel_wide = panel_wide_of(columns);
  const double grains_top = panels_top + panel_high * static_cast<double>(rows) + (count > 0 ? 30 : 8);
  const double height = picture.grains ? grains_top + std::max(view.high, 180.0) + 56 : grains_top;

  Svg svg(heading.width(), height, picture.title, style(picture));
  svg.rectangle({0, 0}, heading.width(), height, "fill=\"#fff\"");
  heading.draw(svg);
  legend(&svg, names, heading.bottom() - 4);
  for (std::size_t i = 0; i < count; ++i) {
    const Point corner{page_margin + static_cast<double>(i % columns) * (panel_wide + gap),
                       panels_top + static_cast<double>(i / columns) * panel_high};
    if (picture.panels[i].polar) PolarDrawing(svg, picture.panels[i], names, corner, panel_wide, panel_high).draw();
    else PanelDrawing(svg, picture.panels[i], names, corner, panel_wide, panel_high).draw();
  }
  if (picture.grains) {
    const double left = page_margin + 0.5 * (heading.inner() - view.bar - view.wide);
    draw_grains(svg, *picture.grains, view, left, grains_top);
    draw_scale_bar(svg, *picture.grains, view, left, grains_top);
    draw_colour_bar(svg, *picture.grains, view, left + view.wide + bar_gap, grains_top);
  }
  return std::move(svg).finish();
}

}  // namespace grit
