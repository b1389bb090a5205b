// The frame at which layers of grains are defined.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace grit {

/// Stage and number of bodies of a frame.
struct StageAndCount {
  std::string stage;
  std::size_t bodies;
};

struct LayersBegin {
  std::size_t frame;  ///< whose heights define the layers
  std::string stage;  ///< that begins there
};

/// The first frame of the stage in which grains begin to leave, or else of the last stage; if that frame has already
/// lost grains, the frame before. Needs at least one frame.
LayersBegin where_layers_begin(std::span<const StageAndCount> frames);

}  // namespace grit
