// Frames as VTK XML files, for ParaView and other programs that use VTK.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "output/wall_shape.hpp"

namespace grit {

/// PolyData (.vtp): a point with a vertex for each body in the order of ids, with the columns of put_body_columns().
std::string vtk_grains(const World& world, std::span<const WallShape> shapes);

/// PolyData (.vtp): the triangles of all walls, with the index of the wall of each.
std::string vtk_walls(const World& world, std::span<const WallShape> shapes);

struct TimedFile {
  double time;       ///< s
  std::string path;  ///< relative to the collection
};
/// A collection (.pvd) of files at different times.
std::string vtk_collection(std::span<const TimedFile> files);

}  // namespace grit
