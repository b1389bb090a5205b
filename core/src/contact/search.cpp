#include "contact/search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "contact/spatial_order.hpp"
#include "grit/contact/lanes.hpp"

namespace grit {
namespace {

/// Positive, and at most `gap` if that is positive.
float rounded_down(double gap) {
  const auto near = static_cast<float>(gap);
  return std::max(near > gap ? std::nextafter(near, 0.0f) : near, std::numeric_limits<float>::min());
}

/// By how many periods a cell of the grid lies beyond it, if the period has `cells`.
int periods_beyond(int place, int cells) { return place >= 0 ? place / cells : -((cells - 1 - place) / cells); }

}  // namespace

int NeighbourSearch::Grid::index(int axis, double coordinate) const {
  const double cell = (coordinate - origin[axis]) * per_length[axis];
  return static_cast<int>(std::floor(std::clamp(cell, -1e9, 1e9)));
}

void NeighbourSearch::build(const Bodies& bodies, const Cell& cell, const Skins& skins, Team& team) {
  build(bodies, all_chunks(bodies.count()), cell, skins, team);
}

void NeighbourSearch::build(const Bodies& bodies, std::span<const std::uint32_t> chunks, const Cell& cell,
                            const Skins& skins, Team& team) {
  cell_ = cell, skins_ = skins;
  any_periodic_ = cell.periodic[0] || cell.periodic[1] || cell.periodic[2];
  if (chunks.empty()) return grids_.clear();
  Extent box = extent(bodies, chunks, team);
  box.take_periods(cell);
  const double smallest = box.smallest, largest = box.largest;
  double thinnest = skins.largest();
  for (const std::uint32_t chunk : chunks) thinnest = std::min(thinnest, skins.of_chunk(chunk));
  for (int k = 0; k < 3; ++k) {
    period_[k] = cell.periodic[as_index(k)] ? cell.high[k] - cell.low[k] : 0;
    per_period_[k] = cell.periodic[as_index(k)] ? 1 / period_[k] : 0;
    to_image_[static_cast<std::size_t>(k)] = cell.period(k);
  }

  // Each size class spans a factor of 2.5 in radius: one class suffices up to this ratio.
  const int classes =
      largest <= 3.01 * smallest ? 1 : 1 + static_cast<int>(std::log(largest / smallest) / std::log(2.5));
  const auto class_of = [&](double radius) {
    if (classes == 1) return 0;
    const double place = std::log(radius / smallest) / std::log(largest / smallest) * classes;
    return std::clamp(static_cast<int>(place), 0, classes - 1);
  };
  grids_.resize(as_index(classes));
  for (Grid& grid : grids_) grid.members.clear(), grid.largest_radius = grid.largest_reach = 0;
  std::size_t count = 0;
  for (const std::uint32_t chunk : chunks) {
    const ChunkRange range(chunk, bodies.count());
    count += range.last - range.first;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const double radius = bodies.position[i].w;
      Grid& grid = grids_[as_index(class_of(radius))];
      grid.members.push_back(static_cast<std::uint32_t>(i));
      grid.largest_radius = std::max(grid.largest_radius, radius);
      grid.largest_reach = std::max(grid.largest_reach, radius + skins.of_chunk(chunk));
    }
  }
  // A rank searches a part of a periodic cell, with cells as wide as if it had all bodies.
  const std::size_t times = bodies.count() / count;
  const Vec3 length = box.high - box.low;
  std::vector<std::size_t> cell_of(count);
  for (int c = 0; c < classes; ++c) {
    Grid& grid = grids_[as_index(c)];
    const std::vector<std::uint32_t>& members = grid.members;
    const double width = 2 * (grid.largest_radius + thinnest) + skins.reach();
    grid.size = grid_size(length, std::max(width, 1e-300), times * members.size());
    grid.origin = box.low;
    for (int k = 0; k < 3; ++k) grid.per_length[k] = length[k] > 0 ? grid.size[as_index(k)] / length[k] : 0;
    team.each_body(members.size(), [&](std::size_t m) {
      const Row& x = bodies.position[members[m]];
      const auto place = [&](int k, double value) {
        return as_index(std::clamp(grid.index(k, value), 0, grid.size[as_index(k)] - 1));
      };
      cell_of[m] = (place(2, x.z) * as_index(grid.size[1]) + place(1, x.y)) * as_index(grid.size[0]) + place(0, x.x);
    });
    grid.start.assign(as_index(grid.size[0]) * as_index(grid.size[1]) * as_index(grid.size[2]) + 1, 0);
    for (std::size_t m = 0; m < members.size(); ++m) ++grid.start[cell_of[m] + 1];
    std::partial_sum(grid.start.begin(), grid.start.end(), grid.start.begin());
    grid.body.resize(members.size());
    grid.next = grid.start;
    for (std::size_t m = 0; m < members.size(); ++m) grid.body[grid.next[cell_of[m]]++] = members[m];
    grid.place(bodies, skins, team);
  }
}

void NeighbourSearch::Grid::place(const Bodies& bodies, const Skins& skins, Team& team) {
  for (auto* array : {&x, &y, &z, &reach}) array->resize(body.size() + lane_width<Lane>);
  team.each_body(body.size(), [&](std::size_t n) {
    const Row& one = bodies.position[body[n]];
    x[n] = one.x, y[n] = one.y, z[n] = one.z, reach[n] = one.w + skins.of_body(body[n]);
  });
  for (auto* array : {&x, &y, &z, &reach})
    std::fill(array->end() - static_cast<std::ptrdiff_t>(lane_width<Lane>), array->end(), 0.0);
}

template <class Use>
void NeighbourSearch::each_near(const Grid& grid, std::uint32_t begin, std::uint32_t end, const Row& centre,
                                double reach, Use use) const {
  constexpr std::size_t width = lane_width<Lane>;
  // Centres are less than a period apart.
  const auto apart = [&](int axis, const std::vector<double>& place, std::uint32_t n, double from) {
    const Lane distance = abs(detail::load_lanes<Lane>(&place[n]) - Lane(from));
    return period_[axis] > 0 ? min(distance, Lane(period_[axis]) - distance) : distance;
  };
  for (std::uint32_t n = begin; n < end; n += width) {
    const Lane x = apart(0, grid.x, n, centre.x), y = apart(1, grid.y, n, centre.y), z = apart(2, grid.z, n, centre.z);
    const Lane near = Lane(reach) + detail::load_lanes<Lane>(&grid.reach[n]);
    std::uint32_t set = detail::bits(x * x + y * y + z * z < Lane(1 + 1e-12) * near * near);
    if (end - n < width) set &= (1u << (end - n)) - 1;
    for (; set != 0; set &= set - 1) use(n + static_cast<std::uint32_t>(std::countr_zero(set)));
  }
}

void NeighbourSearch::neighbours(const Bodies& bodies, std::uint32_t body, std::vector<Candidate>& candidates) const {
  const std::size_t before = candidates.size();
  const std::uint32_t own_clump = bodies.clumps.clump_of(body);
  const auto find = [&]<bool skewed>() {
    each_around<skewed>(bodies, body, [&](std::uint32_t other) {
      if (other <= body || (own_clump != no_clump && bodies.clumps.clump_of(other) == own_clump)) return;
      if (const auto found = pair<skewed>(bodies, body, other)) candidates.push_back(*found);
    });
  };
  if (cell_.skewed()) find.template operator()<true>();
  else find.template operator()<false>();
  std::sort(candidates.begin() + static_cast<std::ptrdiff_t>(before), candidates.end(),
            [](const Candidate& x, const Candidate& y) { return x.b < y.b; });
}

void NeighbourSearch::neighbours_below(const Bodies& bodies, std::uint32_t body, std::uint32_t below,
                                       std::vector<Candidate>& candidates) const {
  const std::uint32_t own_clump = bodies.clumps.clump_of(body);
  const auto find = [&]<bool skewed>() {
    each_around<skewed>(bodies, body, [&](std::uint32_t other) {
      if (other >= below || (own_clump != no_clump && bodies.clumps.clump_of(other) == own_clump)) return;
      if (const auto found = pair<skewed>(bodies, other, body)) candidates.push_back(*found);
    });
  };
  if (cell_.skewed()) find.template operator()<true>();
  else find.template operator()<false>();
}

template <bool skewed>
std::optional<Candidate> NeighbourSearch::pair(const Bodies& bodies, std::uint32_t a, std::uint32_t b) const {
  const Row &own = bodies.position[a], &other = bodies.position[b];
  double d[3] = {other.x - own.x, other.y - own.y, other.z - own.z};
  std::uint8_t image = 0;
  if constexpr (skewed) {
    std::array<int, 3> shift{};
    for (int k = 2; k >= 0; --k) {
      // Two bodies in the cell are no farther apart; half a period more is the side of an image.
      const double most = k == 0 ? 2 : 1;
      const double periods = std::clamp(std::nearbyint(d[k] * per_period_[k]), -most, most);
      for (int j = 0; j <= k; ++j) d[j] -= periods * to_image_[static_cast<std::size_t>(k)][j];
      shift[static_cast<std::size_t>(k)] = -static_cast<int>(periods);
    }
    image = image_with(shift);
  } else if (any_periodic_) {
    int place = 1;
    for (int k = 0; k < 3; ++k, place *= 3) {
      const double periods = std::nearbyint(d[k] * per_period_[k]);
      d[k] -= periods * period_[k];
      image = static_cast<std::uint8_t>(image + (periods > 0 ? 2 * place : periods < 0 ? place : 0));
    }
  }
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const double contact = own.w + other.w, near = contact + ((skins_.of_body(a) + skins_.reach()) + skins_.of_body(b));
  if (!(square < near * near)) return {};
  const double acts = contact + skins_.reach();
  const float gap = square < acts * acts ? 0 : rounded_down(std::sqrt(square) - acts);
  return Candidate{a, b, gap, image};
}

template <bool skewed, class Take>
void NeighbourSearch::each_around(const Bodies& bodies, std::uint32_t body, Take take) const {
  const Row own = bodies.position[body];
  const double centre[3] = {own.x, own.y, own.z}, skin = skins_.of_body(body) + skins_.reach();
  for (const Grid& grid : grids_) {
    if (grid.body.empty()) continue;
    const double reach = own.w + skin + grid.largest_reach;
    int first[3], last[3];
    const auto reach_along = [&](int k, double from) {
      first[k] = grid.index(k, from - reach), last[k] = grid.index(k, from + reach);
      if (!cell_.periodic[as_index(k)]) {
        first[k] = std::clamp(first[k], 0, grid.size[as_index(k)] - 1),
        last[k] = std::clamp(last[k], 0, grid.size[as_index(k)] - 1);
      } else if (last[k] - first[k] >= grid.size[as_index(k)]) {
        first[k] = 0, last[k] = grid.size[as_index(k)] - 1;  // each cell once
      }
    };
    for (int k = 0; k < 3; ++k) reach_along(k, centre[k]);
    const auto wrapped = [&](int k, int place) {
      if constexpr (skewed) return place - grid.size[as_index(k)] * periods_beyond(place, grid.size[as_index(k)]);
      return place < 0                         ? place + grid.size[as_index(k)]
             : place >= grid.size[as_index(k)] ? place - grid.size[as_index(k)]
                                               : place;
    };
    // Bodies of cells beyond a side are seen from where this body has its image there.
    const bool all_z = skewed && last[2] - first[2] + 1 >= grid.size[2];
    for (int cz = first[2]; cz <= last[2]; ++cz) {
      const int beyond_z = skewed ? periods_beyond(cz, grid.size[2]) : 0;
      bool all_y = all_z;
      if constexpr (skewed) {
        reach_along(1, centre[1] - beyond_z * cell_.tilt[2]);
        if (all_y) first[1] = 0, last[1] = grid.size[1] - 1;
        all_y = all_y || last[1] - first[1] + 1 >= grid.size[1];
      }
      for (int cy = first[1]; cy <= last[1]; ++cy) {
        if constexpr (skewed) {
          reach_along(0, centre[0] - beyond_z * cell_.tilt[1] - periods_beyond(cy, grid.size[1]) * cell_.tilt[0]);
          if (all_y) first[0] = 0, last[0] = grid.size[0] - 1;
        }
        const std::size_t line =
            (as_index(wrapped(2, cz)) * as_index(grid.size[1]) + as_index(wrapped(1, cy))) * as_index(grid.size[0]);
        // Cells in a row hold consecutive bodies, up to a side of the cell.
        for (int cx = first[0]; cx <= last[0];) {
          const int from = wrapped(0, cx), length = std::min(last[0] - cx, grid.size[0] - 1 - from) + 1;
          const std::uint32_t begin = grid.start[line + as_index(from)],
                              end = grid.start[line + as_index(from + length)];
          cx += length;
          if constexpr (skewed) {
            for (std::uint32_t n = begin; n < end; ++n) take(grid.body[n]);
          } else {
            each_near(grid, begin, end, own, own.w + skin, [&](std::uint32_t n) { take(grid.body[n]); });
          }
        }
      }
    }
  }
}

}  // namespace grit
