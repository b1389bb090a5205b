// Where grains are told apart by the layers in which they were.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace grit {

/// A frame, as far as it matters here.
struct StageAndCount {
  std::string stage;
  std::size_t bodies;
};

struct LayersBegin {
  std::size_t frame;  ///< by whose heights layers are told
  std::string stage;  ///< that begins there
};

/// The first frame of the stage in which grains begin to leave, or else of the last one; where a stage's first frame
/// has lost grains already, the one before, which is nearer to how it began. Of one frame at least.
LayersBegin where_layers_begin(std::span<const StageAndCount> frames);

}  // namespace grit
