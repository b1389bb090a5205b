// Profiles across a specimen, and the shear zone in one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "specimen.hpp"

namespace grit {

/// Means of what bodies have at places from one side of the specimen to the other.
class Profile {
 public:
  std::string across = "z";
  double spacing = 1;  ///< of the places, mean diameters
  double reach = 2;    ///< over which bodies count, less and less, mean diameters

  void declare(Parameters& p) {
    p.add("across", across)
        .one_of({"x", "y", "z"})
        .doc("axis of the profile, from one side of the specimen to the other");
    p.add("spacing", spacing).at_least(0.1).doc("of the places of the profile, over the mean diameter");
    p.add("reach", reach)
        .at_least(0.1)
        .doc("over which a body counts, less and less with its distance from a place, over the mean diameter");
  }
  /// Chooses how many places there are; the same from then on, as the specimen is compressed or dilates.
  void prepare(const World& world) {
    const auto [low, high] = ends(world);
    const double step = spacing * world.mean_diameter();
    const double steps = step > 0 && std::isfinite((high - low) / step) ? std::floor((high - low) / step) : 0;
    places_ = 2 + static_cast<std::size_t>(std::clamp(steps, 1.0, 1e6)) - 1;
  }
  std::size_t places() const { return places_; }

  struct Nodes {
    double first, step;  ///< m
    double at(std::size_t k) const { return first + static_cast<double>(k) * step; }
  };
  Nodes nodes(const World& world) const {
    const auto [low, high] = ends(world);
    return {low, (high - low) / static_cast<double>(places_ - 1)};
  }
  /// Of each place, the mean of value(body), weighted by 1 − distance / reach; 0 where no body counts.
  template <class Value>
  std::vector<double> mean(const World& world, Value value) const {
    std::vector<double> sum(places_, 0.0), weight(places_, 0.0);
    const Nodes node = nodes(world);
    const double width = reach * world.mean_diameter();
    const int axis = across[0] - 'x';
    for (std::size_t i = 0; i < world.positions().size() && node.step > 0 && width > 0; ++i) {
      const double x = xyz(world.positions()[i])[axis];
      const auto index = [&](double place) {
        return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(places_ - 1)));
      };
      const std::size_t last = index((x + width - node.first) / node.step);
      for (std::size_t k = index(std::ceil((x - width - node.first) / node.step)); k <= last; ++k) {
        const double share = std::max(0.0, 1 - std::abs(node.at(k) - x) / width);
        sum[k] += share * value(i), weight[k] += share;
      }
    }
    for (std::size_t k = 0; k < places_; ++k) sum[k] = weight[k] > 0 ? sum[k] / weight[k] : 0;
    return sum;
  }

 private:
  struct Ends {
    double low, high;
  };
  Ends ends(const World& world) const {
    const Region box = specimen_box(world);
    const int axis = across[0] - 'x';
    return {box.low[axis], box.high[axis]};
  }
  std::size_t places_ = 2;
};

/// Where a profile that is largest in a shear zone falls off the fastest on either side: its inflection points [m]. A
/// zone that is largest at a side of the specimen ends there.
struct ShearZone {
  double low, high;
  double thickness() const { return high - low; }
};

inline ShearZone shear_zone(const Profile::Nodes& node, const std::vector<double>& profile) {
  const std::size_t count = profile.size();
  std::size_t peak = 0;
  for (std::size_t k = 0; k < count; ++k)
    if (std::abs(profile[k]) > std::abs(profile[peak])) peak = k;
  const double sign = profile[peak] < 0 ? -1 : 1;
  // Between places k and k + 1, towards the peak.
  const auto slope = [&](std::size_t k) { return sign * (profile[k + 1] - profile[k]) * (k < peak ? 1 : -1); };
  const auto steepest = [&](std::size_t from, std::size_t to) {
    std::size_t best = from;
    for (std::size_t k = from; k < to; ++k)
      if (slope(k) > slope(best)) best = k;
    double part = 0;  // of a parabola through it and its neighbours
    if (best > from && best + 1 < to) {
      const double before = slope(best - 1), here = slope(best), after = slope(best + 1);
      const double bend = before - 2 * here + after;
      if (bend < 0) part = std::clamp(0.5 * (before - after) / bend, -0.5, 0.5);
    }
    return node.at(best) + (0.5 + part) * node.step;
  };
  return {.low = peak == 0 ? node.at(0) : steepest(0, peak),
          .high = peak + 1 == count ? node.at(count - 1) : steepest(peak, count - 1)};
}

}  // namespace grit
