#include "bodies/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "bodies/cloud.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

constexpr double misfit = 1e-6;     // of a periodic length, over it; the lattice is stretched by as much
constexpr double round_off = 1e-9;  // of a length, over the repeat length

/// A repeated cell: its lengths over the spacing, and positions in it over its lengths.
struct RepeatedCell {
  Vec3 lengths;
  std::vector<Vec3> positions;
};

RepeatedCell repeated_cell(const std::string& kind) {
  const double half = 0.5;
  if (kind == "bcc") return {Vec3::Constant(2 / std::sqrt(3.0)), {{0, 0, 0}, {half, half, half}}};
  if (kind == "fcc") {
    return {Vec3::Constant(std::sqrt(2.0)), {{0, 0, 0}, {half, half, 0}, {half, 0, half}, {0, half, half}}};
  }
  if (kind == "hcp") {
    return {{1, std::sqrt(3.0), std::sqrt(8.0 / 3)},
            {{0, 0, 0}, {half, half, 0}, {half, 5.0 / 6, half}, {0, 1.0 / 3, half}}};
  }
  return {Vec3::Ones(), {{0, 0, 0}}};
}

double spacing_of(const LatticeSource& source) { return source.spacing.value_or(source.diameter); }

/// Number of positions along an axis that begin at a fraction of the repeat length; it may be beyond all integers.
double positions_along(double length, double repeat, double fraction, double diameter, bool wrapped) {
  if (wrapped) return std::round(length / repeat);
  const double free = (length - diameter) / repeat + round_off - fraction;
  return free < 0 ? 0 : std::floor(free) + 1;
}

}  // namespace

Vec3 repeat_lengths(const LatticeSource& source) { return spacing_of(source) * repeated_cell(source.kind).lengths; }

double count_of_lattice(const LatticeSource& source, const std::array<bool, 3>& periodic) {
  const Vec3 repeat = repeat_lengths(source);
  double count = 0;
  for (const Vec3& position : repeated_cell(source.kind).positions) {
    double all = 1;
    for (int k = 0; k < 3; ++k)
      all *= positions_along(source.high[k] - source.low[k], repeat[k], position[k], source.diameter,
                             periodic[static_cast<std::size_t>(k)]);
    count += all;
  }
  return count;
}

std::vector<Row> make_lattice(const LatticeSource& source, const Cell& cell) {
  constexpr double most = 4e9;
  const auto wrapped = wrapped_axes("lattice", {source.low, source.high}, cell);
  Vec3 repeat = repeat_lengths(source);
  const Vec3 size = source.high - source.low;
  for (int k = 0; k < 3; ++k) {
    if (!wrapped[static_cast<std::size_t>(k)]) continue;
    const double times = std::max(1.0, std::round(size[k] / repeat[k]));
    if (std::abs(size[k] - times * repeat[k]) > misfit * size[k])
      throw Error("lattice: the box is " + number(size[k] / repeat[k]) + " repeat lengths of " + number(repeat[k]) +
                  " m long along the periodic axis " + "xyz"[k] + "; use a whole number of them, such as " +
                  fmt::format("{:.0f}", times) + " with a spacing of " +
                  fmt::format("{:.10g}", spacing_of(source) * size[k] / (times * repeat[k])) + " m");
    repeat[k] = size[k] / times;
  }
  const double count = count_of_lattice(source, wrapped);
  if (count == 0)
    throw Error("lattice: no body of diameter " + number(source.diameter) +
                " m fits into the box; use a larger box or a smaller diameter");
  if (count > most)
    throw Error("lattice: " + number(count) + " bodies; allowed are up to 4e9: use a smaller box or a larger spacing");

  const RepeatedCell repeated = repeated_cell(source.kind);
  const double radius = 0.5 * source.diameter;
  const auto along = [&](int axis, const Vec3& position) {
    return static_cast<std::int64_t>(positions_along(size[axis], repeat[axis], position[axis], source.diameter,
                                                     wrapped[static_cast<std::size_t>(axis)]));
  };
  const auto at = [&](int axis, std::int64_t index, const Vec3& position) {
    const double place = source.low[axis] + radius + (static_cast<double>(index) + position[axis]) * repeat[axis];
    return wrapped[static_cast<std::size_t>(axis)] && place >= source.high[axis] ? place - size[axis] : place;
  };
  std::vector<Row> bodies;
  bodies.reserve(static_cast<std::size_t>(count));
  std::array<std::int64_t, 3> most_cells{};
  for (int k = 0; k < 3; ++k)
    for (const Vec3& position : repeated.positions)
      most_cells[static_cast<std::size_t>(k)] = std::max(most_cells[static_cast<std::size_t>(k)], along(k, position));
  for (std::int64_t z = 0; z < most_cells[2]; ++z)
    for (std::int64_t y = 0; y < most_cells[1]; ++y)
      for (std::int64_t x = 0; x < most_cells[0]; ++x)
        for (const Vec3& position : repeated.positions)
          if (x < along(0, position) && y < along(1, position) && z < along(2, position))
            bodies.push_back({at(0, x, position), at(1, y, position), at(2, z, position), radius});
  return bodies;
}

}  // namespace grit
