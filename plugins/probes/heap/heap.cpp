#include "heap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "grit/plugin.hpp"

namespace grit {
namespace {

constexpr double pi = std::numbers::pi;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The top of the highest grain in each square column of one mean diameter about the axis, above the base [m]. All
/// columns have the same area, so that their tops are equally high above the mean slope.
class Surface {
 public:
  /// `rings`: no heap reaches farther, over the width.
  Surface(double width, std::size_t rings) : width_(width), limit_(width * static_cast<double>(rings)) {}

  void add(double x, double y, double top) {
    if (!(std::hypot(x, y) < limit_)) return;
    double& height = tops_[{column(x), column(y)}];
    height = std::max(height, top);
  }
  /// Mean height of the columns of each ring of one width about the axis; empty columns have the height 0.
  std::vector<double> profile() const {
    std::vector<double> sum;
    for (const auto& [at, top] : tops_) {
      const std::size_t ring = ring_of(at.first, at.second);
      if (ring >= sum.size()) sum.resize(ring + 1);
      sum[ring] += top;
    }
    // Only rings below the first empty one matter.
    sum.erase(std::ranges::find(sum, 0.0), sum.end());
    std::vector<double> columns(sum.size());
    each_column(sum.size(), [&](double, double, std::size_t ring, double) { ++columns[ring]; });
    for (std::size_t ring = 0; ring < sum.size(); ++ring) sum[ring] /= columns[ring];
    return sum;
  }
  /// Calls use(x, y, ring, top) for all columns of the first rings, with the centre of each.
  template <class Use>
  void each_column(std::size_t rings, Use use) const {
    const auto most = static_cast<std::int64_t>(rings);
    for (std::int64_t i = -most; i < most; ++i)
      for (std::int64_t j = -most; j < most; ++j) {
        const std::size_t ring = ring_of(i, j);
        if (ring >= rings) continue;
        const auto found = tops_.find({i, j});
        use(centre(i), centre(j), ring, found == tops_.end() ? 0 : found->second);
      }
  }

 private:
  std::int64_t column(double x) const { return static_cast<std::int64_t>(std::floor(x / width_)); }
  double centre(std::int64_t column) const { return (static_cast<double>(column) + 0.5) * width_; }
  std::size_t ring_of(std::int64_t i, std::int64_t j) const {
    return static_cast<std::size_t>(std::hypot(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5));
  }

  double width_, limit_;
  std::map<std::pair<std::int64_t, std::int64_t>, double> tops_;
};

/// Least-squares line of heights over distances from the axis.
struct Line {
  double count = 0, r = 0, h = 0, rr = 0, rh = 0;
  void add(double radius, double height) {
    ++count, r += radius, h += height, rr += radius * radius, rh += radius * height;
  }
  /// Slope angle, positive if it falls outwards [rad]; NaN without columns at two distances.
  double angle() const {
    const double spread = count * rr - r * r;
    return count >= 3 && spread > 1e-12 * count * rr ? std::atan(-(count * rh - r * h) / spread) : nan;
  }
};

/// The slope: rings between the one below `high` and the last one above `low`, which must follow each other.
struct Slope {
  std::size_t first, last;  // past the last
};
Slope slope_of(const std::vector<double>& profile, double low, double high) {
  auto from = static_cast<std::size_t>(std::ranges::max_element(profile) - profile.begin());
  while (from < profile.size() && profile[from] > high) ++from;
  std::size_t to = from;
  while (to < profile.size() && profile[to] >= low) ++to;
  return {from, to};
}

constexpr double lowest_slope = 1.5;  // mean diameters: below, single grains that rolled away
constexpr std::size_t fewest_rings = 3;

}  // namespace

void Heap::declare(Parameters& p) {
  p.add("base", base).unit("m").doc("centre of the base: where the vertical axis meets the floor");
  p.add("sectors", sectors).at_least(3).at_most(360).doc("sectors about the vertical axis in which slopes are fitted");
  p.add("lower", lower)
      .at_least(0)
      .below(1)
      .doc("lower end of the fitted part of the slope, over the height of the heap; at least 1.5 mean diameters count");
  p.add("upper", upper)
      .above(0)
      .at_most(1)
      .doc("upper end of the fitted part of the slope, over the height of the heap");
  p.check(
      [this](const Complain& complain) {
        if (!(lower < upper)) complain("upper", "an upper end not above the lower one", "more than lower");
      },
      {"lower", "upper"});
}

std::vector<Channel> Heap::channels() const {
  return {
      {"angle", "rad", "slope angle; NaN if the slope is less than three mean diameters long", {}},
      {"angle_deviation", "rad", "standard deviation of the angle between sectors; NaN with fewer than two", {}},
      {"height", "m", "height of the highest grain's top above the base; grains without contacts do not count", {}},
      {"radius", "m", "radius of the base: mean over the sectors of the outermost grain's distance from the axis", {}}};
}

void Heap::sample(const World& world, ChannelValues& values) {
  const auto positions = world.positions();
  std::vector<bool> rests(positions.size(), false);  // grains in flight are no part of the heap
  for (const Contact& contact : world.contacts()) {
    rests[contact.a] = true;
    if (!contact.with_wall) rests[contact.b] = true;
  }
  const auto sector_of = [this](double x, double y) {
    const double turn = (std::atan2(y, x) / (2 * pi) + 0.5) * static_cast<double>(sectors);
    return std::min(static_cast<std::size_t>(turn), static_cast<std::size_t>(sectors) - 1);
  };
  Surface surface(world.mean_diameter(), positions.size() + 1);
  std::vector<double> furthest(static_cast<std::size_t>(sectors), 0);
  double highest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 place = xyz(positions[i]) - base;
    const double top = place.z() + positions[i].w, distance = std::hypot(place.x(), place.y());
    if (!rests[i] || !(top > 0) || !std::isfinite(distance)) continue;
    surface.add(place.x(), place.y(), top);
    double& sector = furthest[sector_of(place.x(), place.y())];
    sector = std::max(sector, distance + positions[i].w), highest = std::max(highest, top);
  }
  const std::vector<double> profile = surface.profile();
  const double height = profile.empty() ? 0 : *std::ranges::max_element(profile);
  const auto [first, last] =
      slope_of(profile, std::max(lower * height, lowest_slope * world.mean_diameter()), upper * height);
  Line all;
  std::vector<Line> lines(furthest.size());
  if (last >= first + fewest_rings)
    surface.each_column(last, [&](double x, double y, std::size_t ring, double top) {
      if (ring < first) return;
      all.add(std::hypot(x, y), top), lines[sector_of(x, y)].add(std::hypot(x, y), top);
    });
  double count = 0, sum = 0, squares = 0;
  for (const Line& line : lines)
    if (const double angle = line.angle(); std::isfinite(angle)) ++count, sum += angle, squares += angle * angle;
  values["angle"] = all.angle();
  values["angle_deviation"] = count > 1 ? std::sqrt(std::max(0.0, squares - sum * sum / count) / (count - 1)) : nan;
  values["height"] = highest;
  values["radius"] = std::accumulate(furthest.begin(), furthest.end(), 0.0) / static_cast<double>(sectors);
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "heap",
                                     .version = "1.0.0",
                                     .doc = "angle of repose, height and radius of a conical heap",
                                     .make_probe = []() -> grit::Probe* { return new grit::Heap; }};
  return &info;
}
