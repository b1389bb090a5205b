#include "report/layers.hpp"

#include <algorithm>

namespace grit {

LayersBegin where_layers_begin(std::span<const StageAndCount> frames) {
  const auto fewer = [](const StageAndCount& before, const StageAndCount& now) { return now.bodies < before.bodies; };
  const auto before = std::ranges::adjacent_find(frames, fewer);
  const bool leave = before != frames.end();
  const auto leaving = leave ? before + 1 : frames.end() - 1;
  const auto first = std::ranges::find(frames, leaving->stage, &StageAndCount::stage);
  const auto begin = leave && leaving == first ? before : first;
  return {static_cast<std::size_t>(begin - frames.begin()), leaving->stage};
}

}  // namespace grit
