// Facets out of a file in STL, ASCII or binary.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// Why a mesh is refused, in the words of a complaint.
struct Defect {
  std::string found, allowed;
};

struct Stl {
  struct Facet {
    std::array<Vec3, 3> corners;  ///< in the file's unit; counter-clockwise as seen from in front
    Vec3 normal;                  ///< as the file says it, of any length
  };
  std::vector<Facet> facets;    ///< in the file's order
  std::vector<Defect> defects;  ///< if there are any, nothing is sure of the facets
};

/// What the file holds: all solids of an ASCII file as one. Files that say "solid" and are binary all the same are
/// known by their size. Throws nothing for what is wrong with the file: that is a defect.
Stl read_stl(const std::filesystem::path& path);

/// "3, 8, 11 and 5 more": numbers of facets, from 1, out of their indices.
std::string facet_numbers(const std::vector<std::size_t>& facets);

}  // namespace grit
