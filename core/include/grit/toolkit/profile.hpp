// Profiles of quantities across a specimen, and the shear zone in a profile.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/probe.hpp"
#include "grit/toolkit/specimen.hpp"

namespace grit {

/// Profile of a quantity of bodies at points from one side of the specimen to the other.
class Profile {
 public:
  std::string across = "z";
  std::int64_t points = 40;
  double averaging_length = 2;  ///< half width of the weight function, mean diameters

  void declare(Parameters& p) {
    p.add("across", across)
        .one_of({"x", "y", "z"})
        .doc("axis of the profile, from one side of the specimen to the other; not periodic");
    p.add("points", points)
        .at_least(3)
        .at_most(100000)
        .doc("number of points of the profile, evenly spaced, both sides included");
    p.add("averaging_length", averaging_length)
        .at_least(0.1)
        .doc("distance at which the weight of a body, 1 at a point, falls to 0, over the mean diameter");
  }
  /// Throws ParameterError if the axis is periodic.
  void prepare(const World& world) const {
    if (world.cell().periodic[static_cast<std::size_t>(axis())])
      throw ParameterError({{"across", across + ", along which the domain is periodic",
                             world.cell().periodic_everywhere()
                                 ? "an axis that is not periodic, of which this domain has none: remove the probe"
                                 : "an axis that is not periodic"}});
  }

  /// Equidistant positions at which the profile has values.
  struct Nodes {
    double first, step;  ///< m
    double at(std::size_t k) const { return first + static_cast<double>(k) * step; }
  };
  Nodes nodes(const World& world) const {
    const Region box = specimen_box(world);
    return {box.low[axis()], (box.high[axis()] - box.low[axis()]) / static_cast<double>(points - 1)};
  }
  /// Least-squares fit of value(body) by value + slope · (x − point) at each point, with weights 1 − distance /
  /// averaging_length. NaN without bodies; slope NaN with too few.
  struct Lines {
    std::vector<double> value, slope;
  };
  template <class Value>
  Lines fit(const World& world, Value value) const {
    struct Sums {
      double weight = 0, x = 0, xx = 0, f = 0, xf = 0;
    };
    std::vector<Sums> sums(static_cast<std::size_t>(points));
    const Nodes node = nodes(world);
    const double width = averaging_length * world.mean_diameter(), last_place = static_cast<double>(points - 1);
    const bool has_places = std::isfinite(node.first) && std::isfinite(node.step) && node.step > 0 && width > 0;
    for (std::size_t i = 0; i < world.positions().size() && has_places; ++i) {
      const double x = xyz(world.positions()[i])[axis()], f = value(i);
      if (!std::isfinite(x) || !std::isfinite(f)) continue;  // failed run
      const double from = std::ceil((x - width - node.first) / node.step),
                   to = std::floor((x + width - node.first) / node.step);
      if (to < 0 || from > last_place) continue;
      const auto last = static_cast<std::size_t>(std::min(to, last_place));
      for (auto k = static_cast<std::size_t>(std::max(from, 0.0)); k <= last; ++k) {
        const double off = x - node.at(k), weight = std::max(0.0, 1 - std::abs(off) / width);
        Sums& s = sums[k];
        s.weight += weight, s.x += weight * off, s.xx += weight * off * off;
        s.f += weight * f, s.xf += weight * off * f;
      }
    }
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    Lines lines;
    for (const Sums& s : sums) {
      const double spread = s.weight * s.xx - s.x * s.x;
      const bool tells = spread > 1e-6 * s.weight * s.weight * width * width;
      lines.value.push_back(tells ? (s.xx * s.f - s.x * s.xf) / spread : s.weight > 0 ? s.f / s.weight : unknown);
      lines.slope.push_back(tells ? (s.weight * s.xf - s.x * s.f) / spread : unknown);
    }
    return lines;
  }

 private:
  int axis() const { return across[0] - 'x'; }
};

/// Shear zone in a profile: its ends are the inflection points on both sides of the peak [m], where the profile falls
/// fastest, at most as far as it falls to a quarter of the peak. A zone with its peak at a side of the specimen ends
/// there; if it also falls fastest there, it has no inflection point, and the other end is NaN.
struct ShearZone {
  double low, high;
  double extent;  ///< width of the range around the peak that exceeds a twentieth of it [m]
  double thickness() const { return high - low; }
};

/// From the finite points of a profile; NaN if there are fewer than three, or if all are 0.
inline ShearZone shear_zone(const Profile::Nodes& node, const std::vector<double>& profile) {
  std::vector<double> place, size;
  for (std::size_t k = 0; k < profile.size(); ++k)
    if (std::isfinite(profile[k])) place.push_back(node.at(k)), size.push_back(profile[k]);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (size.size() < 3) return {unknown, unknown, unknown};
  const auto larger = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto peak = static_cast<std::ptrdiff_t>(std::ranges::max_element(size, larger) - size.begin());
  if (size[static_cast<std::size_t>(peak)] == 0) return {unknown, unknown, unknown};
  if (size[static_cast<std::size_t>(peak)] < 0)
    for (double& one : size) one = -one;
  const auto at = [&](std::ptrdiff_t k) { return static_cast<std::size_t>(k); };
  // From the peak outwards: the steepest slope between two points, refined by a parabola through it and its neighbours.
  const auto end = [&](std::ptrdiff_t way) {
    const auto last = way < 0 ? std::ptrdiff_t{0} : static_cast<std::ptrdiff_t>(size.size()) - 1;
    if (peak == last) return place[at(last)];
    const auto fall = [&](std::ptrdiff_t k) {
      return (size[at(k)] - size[at(k + way)]) / (place[at(k + way)] - place[at(k)]) * static_cast<double>(way);
    };
    std::ptrdiff_t best = peak;
    for (std::ptrdiff_t k = peak; k != last; k += way) {
      if (fall(k) > fall(best)) best = k;
      if (size[at(k + way)] < 0.25 * size[at(peak)]) break;
    }
    if (best == peak && peak == static_cast<std::ptrdiff_t>(size.size()) - 1 - last) return unknown;
    double part = 0.5;
    if (best != peak && best + way != last) {
      const double before = fall(best - way), here = fall(best), after = fall(best + way),
                   bend = before - 2 * here + after;
      if (bend < 0) part += std::clamp(0.5 * (before - after) / bend, -0.5, 0.5);
    }
    return place[at(best)] + part * (place[at(best + way)] - place[at(best)]);
  };
  const auto faint = [&](std::ptrdiff_t way) {
    const auto last = way < 0 ? std::ptrdiff_t{0} : static_cast<std::ptrdiff_t>(size.size()) - 1;
    const double least = size[at(peak)] / 20;
    for (std::ptrdiff_t k = peak; k != last; k += way)
      if (const double here = size[at(k)], next = size[at(k + way)]; next < least)
        return std::lerp(place[at(k)], place[at(k + way)], (here - least) / (here - next));
    return place[at(last)];
  };
  return {.low = end(-1), .high = end(1), .extent = faint(1) - faint(-1)};
}

/// Channels of the shear zone in the profile of `what`.
inline std::vector<Channel> zone_channels(const std::string& what) {
  const std::string unknown = "; NaN if fewer than three points have bodies or all values are 0",
                    no_inflection = unknown + ", or if peak and steepest fall are at a side";
  return {{"zone_low", "m", "lower inflection point of the profile of " + what + no_inflection, {}},
          {"zone_high", "m", "upper inflection point" + no_inflection, {}},
          {"zone_thickness", "m", "thickness of the shear zone, between the inflection points" + no_inflection, {}},
          {"zone_diameters", "1", "thickness of the shear zone over the mean diameter" + no_inflection, {}},
          {"zone_extent_diameters",
           "1",
           "width over which " + what + " exceeds a twentieth of its peak, over the mean diameter" + unknown,
           {}}};
}
/// Writes zone_channels().
inline void fill_zone(const ShearZone& zone, const World& world, ChannelValues& values) {
  values["zone_low"] = zone.low;
  values["zone_high"] = zone.high;
  values["zone_thickness"] = zone.thickness();
  values["zone_diameters"] = zone.thickness() / world.mean_diameter();
  values["zone_extent_diameters"] = zone.extent / world.mean_diameter();
}

}  // namespace grit
