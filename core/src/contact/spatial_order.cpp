#include "contact/spatial_order.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace grit {
namespace {

std::uint64_t spread(std::uint64_t x) {  // moves the bits of x to every third position
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<std::uint32_t> all_chunks(std::size_t bodies) {
  std::vector<std::uint32_t> all(chunks_of(bodies));
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

void Extent::take_periods(const Cell& cell) {
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[as_index(k)]) low[k] = cell.low[k], high[k] = cell.high[k];
}

Extent extent(const Bodies& bodies, std::span<const std::uint32_t> chunks, Team& team) {
  std::vector<Extent> parts(chunks.size());
  team.each(parts.size(), [&](std::size_t k) {
    const ChunkRange range(chunks[k], bodies.count());
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Row& body = bodies.position[i];
      parts[k].add({body.w, body.w, xyz(body), xyz(body)});
    }
  });
  Extent all;
  for (const Extent& part : parts) all.add(part);
  return all;
}

std::array<int, 3> grid_size(const Vec3& length, double width, std::size_t bodies) {
  const double most = 4.0 * static_cast<double>(bodies) + 64;
  std::array<int, 3> size{};
  for (;; width *= 1.5) {
    double total = 1;
    for (int k = 0; k < 3; ++k) {
      const double fitting = std::floor(length[k] / width);
      const double count = fitting > 1 ? std::min(fitting, 2e6) : 1;  // one of a length that is not a number
      size[as_index(k)] = static_cast<int>(count);
      total *= count;
    }
    if (total <= most) return size;
  }
}

Curve::Curve(const Extent& box, std::size_t bodies)
    : low_(box.low),
      length_(box.high - box.low),
      size_(grid_size(length_, std::max(2 * box.largest, 1e-300), bodies)) {}

std::uint64_t Curve::key(const Vec3& x) const {
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) {
    const double share = length_[k] > 0 ? (x[k] - low_[k]) / length_[k] : 0;
    const double cells_before = share * size_[as_index(k)];
    key |= spread(static_cast<std::uint64_t>(std::clamp(cells_before, 0.0, size_[as_index(k)] - 1.0))) << k;
  }
  return key;
}

int Curve::bits() const {
  std::uint64_t largest = 0;
  for (int k = 0; k < 3; ++k) largest |= spread(static_cast<std::uint64_t>(size_[as_index(k)] - 1)) << k;
  return static_cast<int>(std::bit_width(largest));
}

void sort_along(const Curve& curve, std::vector<CurvePlace>& places, Team& team) {
  // Stretches of the curve, at most as many as chunks, each of which one thread sorts.
  const int bits = curve.bits();
  const int shift = std::max(0, bits + 1 - static_cast<int>(std::bit_width(chunks_of(places.size()))));
  std::vector<std::uint32_t> start((std::size_t{1} << std::max(0, bits - shift)) + 1, 0);
  for (const CurvePlace& one : places) ++start[(one.key >> shift) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  std::vector<CurvePlace> sorted(places.size());
  for (const CurvePlace& one : places) sorted[next[one.key >> shift]++] = one;
  team.each(next.size(), [&](std::size_t stretch) {
    std::sort(sorted.begin() + start[stretch], sorted.begin() + start[stretch + 1]);
  });
  places.swap(sorted);
}

std::vector<std::uint32_t> spatial_order(const Bodies& bodies, const Cell& cell, Team& team) {
  const std::size_t count = bodies.count();
  if (count == 0) return {};
  Extent box = extent(bodies, all_chunks(count), team);
  box.take_periods(cell);
  const Curve curve(box, count);
  std::vector<CurvePlace> places(count);
  team.each_body(count, [&](std::size_t i) { places[i] = curve.place(bodies, i); });
  sort_along(curve, places, team);
  std::vector<std::uint32_t> order;
  order.reserve(count);
  for (const CurvePlace& one : places) order.push_back(one.body);
  return order;
}

}  // namespace grit
