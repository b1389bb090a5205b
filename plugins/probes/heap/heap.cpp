#include "heap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "grit/plugin.hpp"

namespace grit {
namespace {

constexpr double pi = std::numbers::pi;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Surface of one sector: the top of the highest grain in each ring of one mean diameter, above the base; NaN in a ring
/// without a grain.
struct Surface {
  double width;  // of a ring [m]
  std::vector<double> height;

  void add(double distance, double top) {
    const auto ring = static_cast<std::size_t>(distance / width);
    if (ring >= height.size()) height.resize(ring + 1, nan);
    height[ring] = std::fmax(height[ring], top);
  }
  double radius(std::size_t ring) const { return (static_cast<double>(ring) + 0.5) * width; }
};

/// Slope angle of the rings whose height is between two limits, by a least-squares line [rad]; NaN with fewer than 3.
double angle_of(const Surface& surface, double low, double high) {
  double count = 0, r = 0, h = 0, rr = 0, rh = 0;
  for (std::size_t ring = 0; ring < surface.height.size(); ++ring) {
    const double height = surface.height[ring], radius = surface.radius(ring);
    if (!(height >= low && height <= high)) continue;
    ++count, r += radius, h += height, rr += radius * radius, rh += radius * height;
  }
  const double spread = count * rr - r * r;
  if (count < 3 || !(spread > 0)) return nan;
  return std::atan(-(count * rh - r * h) / spread);
}

}  // namespace

void Heap::declare(Parameters& p) {
  p.add("base", base).unit("m").doc("centre of the base: where the vertical axis meets the floor");
  p.add("sectors", sectors).at_least(3).at_most(360).doc("sectors about the vertical axis in which slopes are fitted");
  p.add("lower", lower)
      .at_least(0)
      .below(1)
      .doc("lower end of the fitted part of the slope, over the height of the heap");
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
      {"angle", "rad", "mean slope angle of the sectors; NaN if no sector has three rings of grains", {}},
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
  const double width = world.mean_diameter();
  std::vector<Surface> surfaces(static_cast<std::size_t>(sectors), Surface{width, {}});
  std::vector<double> furthest(surfaces.size(), 0);
  double highest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 place = xyz(positions[i]) - base;
    const double top = place.z() + positions[i].w, distance = std::hypot(place.x(), place.y());
    if (!rests[i] || !(top > 0) || !std::isfinite(distance)) continue;
    const double turn = (std::atan2(place.y(), place.x()) / (2 * pi) + 0.5) * static_cast<double>(sectors);
    const std::size_t sector = std::min(static_cast<std::size_t>(turn), surfaces.size() - 1);
    surfaces[sector].add(distance, top);
    furthest[sector] = std::max(furthest[sector], distance + positions[i].w), highest = std::max(highest, top);
  }
  double count = 0, sum = 0, squares = 0, reach = 0;
  for (std::size_t sector = 0; sector < surfaces.size(); ++sector) {
    reach += furthest[sector] / static_cast<double>(sectors);
    const double angle = angle_of(surfaces[sector], lower * highest, upper * highest);
    if (std::isfinite(angle)) ++count, sum += angle, squares += angle * angle;
  }
  const double mean = count > 0 ? sum / count : nan;
  values["angle"] = mean;
  values["angle_deviation"] = count > 1 ? std::sqrt(std::max(0.0, squares - count * mean * mean) / (count - 1)) : nan;
  values["height"] = highest, values["radius"] = reach;
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
