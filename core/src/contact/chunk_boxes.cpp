#include "contact/chunk_boxes.hpp"

#include <algorithm>
#include <limits>

namespace grit {

ChunkBoxes::ChunkBoxes(const Bodies& bodies, const Cell& cell, const Skins& skins, Team& team)
    : boxes_(chunks_of(bodies.count())), skewed_(cell.skewed()) {
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[static_cast<std::size_t>(k)]) period_[k] = cell.high[k] - cell.low[k];
  team.each(boxes_.size(), [&](std::size_t chunk) {
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
}

bool ChunkBoxes::near(const Box& one, const Box& other) const {
  if (skewed_) return true;
  for (int k = 0; k < 3; ++k) {
    bool along = one.low[k] <= other.high[k] && other.low[k] <= one.high[k];
    for (const double shift : {-period_[k], period_[k]})
      along = along || (shift != 0 && one.low[k] + shift <= other.high[k] && other.low[k] <= one.high[k] + shift);
    if (!along) return false;
  }
  return true;
}

std::vector<std::size_t> ChunkBoxes::near_below(std::size_t first, std::size_t last) const {
  std::vector<std::size_t> found;
  if (first == last) return found;
  Box all = boxes_[first];
  for (std::size_t chunk = first; chunk < last; ++chunk)
    all.low = all.low.cwiseMin(boxes_[chunk].low), all.high = all.high.cwiseMax(boxes_[chunk].high);
  for (std::size_t chunk = 0; chunk < first; ++chunk)
    if (near(boxes_[chunk], all)) found.push_back(chunk);
  return found;
}

}  // namespace grit
