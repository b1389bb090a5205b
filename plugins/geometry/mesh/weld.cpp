#include "weld.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grit {
namespace {

constexpr std::size_t most_edges = 50'000;  // a distance is found for them in a few seconds
constexpr int decades = 14;                 // of distances that are tried, from round-off
constexpr double close_enough = 1.02;       // ratio of the distances between which the smallest one lies

/// Whether each edge coincides with another one, or with several if `crowded`.
bool closes(std::span<const Segment> edges, double distance, bool crowded) {
  Weld weld(distance);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& [from, to] : edges) {
    const std::uint32_t a = weld.number(from), b = weld.number(to);
    if (a == b) return false;
    ++sides[std::minmax(a, b)];
  }
  return std::ranges::all_of(sides, [&](const auto& one) { return one.second == 2 || (crowded && one.second > 2); });
}

double rounded_up(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::ceil(x / unit) * unit;
}

}  // namespace

std::uint32_t Weld::number(const Vec3& point) {
  const auto [known, inserted] =
      exact_.try_emplace({point.x(), point.y(), point.z()}, static_cast<std::uint32_t>(points_.size()));
  if (!inserted) return known->second;
  if (distance_ > 0) {
    if (const auto other = close_to(point)) return known->second = *other;
    cells_[cell(point)].push_back(known->second);
  }
  points_.push_back(point);
  return known->second;
}

Weld::Cell Weld::cell(const Vec3& point) const {
  return {std::floor(point.x() / distance_), std::floor(point.y() / distance_), std::floor(point.z() / distance_)};
}

std::optional<std::uint32_t> Weld::close_to(const Vec3& point) const {
  const Cell own = cell(point);
  for (const double x : {-1, 0, 1})
    for (const double y : {-1, 0, 1})
      for (const double z : {-1, 0, 1})
        if (const auto found = cells_.find({own[0] + x, own[1] + y, own[2] + z}); found != cells_.end())
          for (const std::uint32_t other : found->second)
            if ((points_[other] - point).norm() <= distance_) return other;
  return {};
}

std::optional<double> closing_distance(std::span<const Segment> free, std::span<const Segment> all, bool crowded) {
  if (free.empty() || free.size() > most_edges) return {};
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : all) shortest = std::min(shortest, (to - from).norm());
  const double most = 0.9 * shortest;
  double high = shortest * std::pow(10, -decades), low = high / 10;
  while (!closes(free, high, crowded)) {
    if (high >= most) return {};
    low = std::exchange(high, std::min(10 * high, most));
  }
  while (high > close_enough * low) {
    const double between = std::sqrt(low * high);
    (closes(free, between, crowded) ? high : low) = between;
  }
  high = rounded_up(high);
  return closes(all, high, crowded) ? std::optional(high) : std::nullopt;
}

}  // namespace grit
