#include "contact/chunk_boxes.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "contact/search.hpp"

namespace grit {

ChunkBoxes::ChunkBoxes(const Bodies& bodies, const Cell& cell, const Skins& skins, Ranks& ranks, Team& team)
    : boxes_(chunks_of(bodies.count())) {
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[static_cast<std::size_t>(k)]) period_[k] = cell.high[k] - cell.low[k];
  if (cell.skewed())
    for (std::uint8_t image = 0; image < all_images; ++image) {
      const std::array<int, 3> periods = image_shift(image);
      Vec3 shift = Vec3::Zero();
      bool there = true;
      for (std::size_t k = 0; k < 3; ++k) {
        there = there && (periods[k] == 0 || cell.periodic[k]);
        if (periods[k] != 0 && cell.periodic[k]) shift += periods[k] * cell.period(static_cast<int>(k));
      }
      if (there) shifts_.push_back(shift);
    }
  team.each(ranks.last() - ranks.first(), [&](std::size_t own) {
    const std::size_t chunk = ranks.first() + own;
    const ChunkRange range(chunk, bodies.count());
    const Vec3 limit = Vec3::Constant(std::numeric_limits<double>::max());
    Box& box = boxes_[chunk] = {limit, -limit};
    for (std::size_t i = range.first; i < range.last; ++i) {
      // Somewhat larger, so that rounding cannot matter.
      const Vec3 reach = Vec3::Constant((1 + 1e-9) * (bodies.position[i].w + skins.of_chunk(chunk) + skins.reach()));
      box.low = box.low.cwiseMin(xyz(bodies.position[i]) - reach);
      box.high = box.high.cwiseMax(xyz(bodies.position[i]) + reach);
    }
  });
  ranks.complete(boxes_);
}

bool ChunkBoxes::near(const Box& one, const Box& other) const {
  const auto overlap = [&](int k, double shift) {
    return one.low[k] + shift <= other.high[k] && other.low[k] <= one.high[k] + shift;
  };
  if (!shifts_.empty())
    return std::ranges::any_of(shifts_, [&](const Vec3& shift) {
      return overlap(0, shift[0]) && overlap(1, shift[1]) && overlap(2, shift[2]);
    });
  for (int k = 0; k < 3; ++k) {
    bool along = overlap(k, 0);
    for (const double shift : {-period_[k], period_[k]}) along = along || (shift != 0 && overlap(k, shift));
    if (!along) return false;
  }
  return true;
}

ChunkBoxes::Box ChunkBoxes::around(std::size_t first, std::size_t last) const {
  Box all = boxes_[first];
  for (std::size_t chunk = first; chunk < last; ++chunk)
    all.low = all.low.cwiseMin(boxes_[chunk].low), all.high = all.high.cwiseMax(boxes_[chunk].high);
  return all;
}

std::vector<std::size_t> ChunkBoxes::near_below(std::size_t first, std::size_t last) const {
  std::vector<std::size_t> found;
  if (first == last) return found;
  const Box all = around(first, last);
  for (std::size_t chunk = 0; chunk < first; ++chunk)
    if (near(boxes_[chunk], all)) found.push_back(chunk);
  return found;
}

}  // namespace grit
