// Contacts of a sphere with one curved surface of facets. See README.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// A facet that overlaps the sphere.
struct CurveFacet {
  Vec3 away;       ///< unit, from its closest point to the centre
  double overlap;  ///< m, > 0
  bool minimum;    ///< whether its closest point is a local minimum of distance on the surface
};

/// Some path along the surface between two facets overlaps the sphere by at least `overlap`.
struct CurveLink {
  std::uint32_t a, b;
  double overlap;  ///< m, > 0
};

/// A contact that counts.
struct CurveContact {
  Vec3 away;
  double overlap;
  std::uint32_t facet;  ///< one on its side, different for each contact
};

/// Share of a contact's overlap by which it relieves another one if the normals of a surface span little.
double least_relief(const Vec3& away, const Vec3& other);

/// The deepest contact of each patch, and one on the far side for what it does not relieve. Links form trees, whose
/// paths are those with the largest overlap. Facets whose normals differ by less than acos(smooth_cosine) are on one
/// side.
std::vector<CurveContact> contacts_that_count(std::span<const CurveFacet> facets, std::span<const CurveLink> links,
                                              double smooth_cosine);

}  // namespace grit
