// Frames in the formats of other programs.
#pragma once

#include <span>
#include <string>

#include "output/wall_shape.hpp"

namespace grit {

/// A file of each frame, frames/000123SUFFIX.
struct FrameExport {
  const char* format;  ///< in /output/frames/formats
  const char* suffix;
  const char* beginning;   ///< of the text
  const char* collection;  ///< name of the vtk_collection() of all of them in the folder of results; null: none
  std::string (*text)(const World& world, std::span<const WallShape> shapes);
};

/// The files of all formats.
std::span<const FrameExport> frame_exports();

}  // namespace grit
