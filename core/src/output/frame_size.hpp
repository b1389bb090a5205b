// Size of the files of a frame, for estimates.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "grit/world.hpp"
#include "run/recorder.hpp"

namespace grit {

struct FrameContent {
  double bodies = 0, contacts = 0;  ///< contacts of pairs and with walls
  std::size_t triangles = 0;        ///< of all walls
};

/// Bytes of a frame, in HDF5 and in `formats`: of this content, with the columns of the world and the fields of probes.
double frame_bytes(const World& world, const FrameContent& content, std::span<const FieldGroup> fields,
                   std::span<const std::string> formats);

/// A lower bound: bytes of a frame of bodies with this state, in HDF5 alone, without contacts, walls and fields.
double least_frame_bytes(double bodies, StateRequest state);

}  // namespace grit
