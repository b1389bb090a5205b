// Facets from an STL file, ASCII or binary.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// Why a mesh is refused, worded as a parameter error.
struct Defect {
  std::string found, allowed;
};

/// What an STL file holds.
struct Stl {
  /// One triangle.
  struct Facet {
    std::array<Vec3, 3> corners;  ///< in the file's unit; counter-clockwise as seen from the front
    Vec3 normal;                  ///< as in the file, of any length
  };
  std::vector<Facet> facets;    ///< in the file's order
  std::vector<Defect> defects;  ///< if any, facets are undefined
};

/// Reads the file; all solids of an ASCII file are joined. A binary file that begins with "solid" is recognised by its
/// size. Faults of the file are reported as defects, not thrown.
Stl read_stl(const std::filesystem::path& path);

/// "3, 8, 11 and 5 more": numbers of facets, from 1, for their indices.
std::string facet_numbers(const std::vector<std::size_t>& facets);

}  // namespace grit
