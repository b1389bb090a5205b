// Facets joined to a surface: shared corners and edges, defects, and spatial queries.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "curved_surface.hpp"
#include "facet_index.hpp"
#include "grit/geometry.hpp"
#include "grit/toolkit/stl_file.hpp"

namespace grit {

/// How facets are joined, and which irregularities are allowed.
struct SurfaceOptions {
  double scale = 1;              ///< m per file unit
  Vec3 stretch = Vec3::Ones();   ///< further factors along the axes of the file
  Mat3 turn = Mat3::Identity();  ///< after scaling, about the origin of the file
  Vec3 position = Vec3::Zero();  ///< of the origin of the file [m]
  double merge_distance = 0;     ///< m; closer corners are merged
  double feature_angle = 0;      ///< rad; facets that meet at less form one curved surface
  bool open = false;             ///< edges with one facet are allowed
  bool two_sided = false;        ///< also inconsistent orientation and edges with three facets or more
  bool inside = false;           ///< bodies are behind the facets as drawn
  bool skip_degenerate = false, ignore_normals = false;
};

/// Facets keep the file's numbers. A feature's number is 7 × the lowest number of the facets that share it, plus 0 for
/// the facet itself, 1 … 3 for its edges, 4 … 6 for its corners.
class Surface {
 public:
  /// A local minimum of distance from a centre.
  struct Nearest {
    Vec3 away;        ///< unit, from the point to the centre, or to the front if the centre is behind
    double distance;  ///< m; below 0 behind
    bool behind;
    std::uint32_t feature;
    std::int32_t region;  ///< curved surface or curve it belongs to; −1: none
  };

  Surface(const Stl& stl, const SurfaceOptions& options);

  const std::vector<Defect>& defects() const { return defects_; }
  const Bounds& bounds() const { return bounds_; }
  /// Sum of the facets' area vectors [m²], towards the bodies; zero if the surface is closed or inconsistently
  /// oriented.
  const Vec3& area_vector() const { return area_vector_; }
  /// Three corners each, counter-clockwise as seen by the bodies; skipped facets have three equal corners.
  std::vector<Vec3> triangles() const;

  static std::uint32_t facet_of(std::uint32_t feature) { return feature / features_per_facet; }

  /// Contacts of a sphere: in front, each local minimum of distance; behind, the closest point only. `facets` is
  /// scratch.
  void nearest(const Vec3& centre, double radius, std::vector<std::uint32_t>& facets,
               std::vector<Nearest>& found) const;
  /// Whether some facet is within `reach`.
  bool near(const Vec3& centre, double reach) const;
  /// Facets whose boxes intersect the cube about a centre, of half side `reach`, in ascending order.
  void facets_near(const Vec3& centre, double reach, std::vector<std::uint32_t>& facets) const {
    index_->intersecting({centre - Vec3::Constant(reach), centre + Vec3::Constant(reach)}, facets);
  }

 private:
  struct Facet {
    std::array<std::uint32_t, 3> corners, edges;  // edge i is from corner i to the next
    Vec3 normal;
    std::array<Vec3, 3> inward;  // unit, in the plane, normal to each edge
    bool skipped;
  };
  struct Side {
    std::uint32_t facet, edge;  // 0 … 2 within the facet
  };
  struct Edge {
    std::uint32_t from, to;
    std::uint32_t first_side, end_side;
    Vec3 along, normal = Vec3::Zero();  // normal: sum over its facets
    double length = 0;
    std::int32_t region = -1;
    bool rim = false, turns = false;  // rim: of one facet only; turns: between facets of opposite orientation
  };
  struct Vertex {
    Vec3 position, normal = Vec3::Zero();  // normal: sum over its facets, weighted by angle
    std::uint32_t first_edge = 0, end_edge = 0, owner = ~0u;
    std::int32_t region = -2;
    bool rim = false;
  };

  void merge_corners(const Stl& stl, const SurfaceOptions& options);
  void span_facets(const Stl& stl, const SurfaceOptions& options);
  void join_edges(const Stl& stl, const SurfaceOptions& options);
  std::string how_to_close(const Stl& stl, const SurfaceOptions& options) const;
  void check_volumes(bool inside);
  void find_regions();
  void gather_corners();
  struct Seam {
    std::uint32_t facet, other;
    Vec3 from, to;
    double gap;      // m
    bool mergeable;  // whether merging corners across the gap would close it
  };
  void check_seams();
  std::optional<Seam> seam(const Side& side, std::uint32_t other, double gap) const;
  template <class Joins>
  std::vector<std::uint32_t> groups(Joins joins) const;
  std::vector<std::size_t> inverted() const;
  const Vec3& corner(const Facet& facet, std::size_t i) const { return vertices_[facet.corners[i]].position; }
  /// Whether a region is one of facets; not a curve, nor none.
  bool is_surface(std::int32_t region) const {
    return region >= 0 && region < static_cast<std::int32_t>(facets_.size());
  }
  double inside_edge(const Side& side, const Vec3& centre) const;
  double height(const Facet& facet, const Vec3& centre) const { return facet.normal.dot(centre - corner(facet, 0)); }
  double distance(std::uint32_t facet, const Vec3& centre) const;
  struct OnRim {
    Vec3 from;  // to the centre
    std::int32_t region;
  };
  std::optional<OnRim> closest_on_rim(std::uint32_t facet, const Vec3& centre) const;
  void closest_of(std::uint32_t number, const Vec3& centre, double radius, std::vector<Nearest>& found) const;
  bool touches_edge(const Edge& edge, const Vec3& centre, double slack) const;
  bool touches_vertex(const Vertex& vertex, const Vec3& centre, double slack) const;
  void remove_duplicates(const Vec3& centre, double radius, std::vector<Nearest>& found) const;
  void keep_those_that_count(const Vec3& centre, double radius, const std::vector<std::uint32_t>& facets,
                             std::vector<Nearest>& found) const;
  bool closest_relieves_all(std::span<const Nearest> minima, double radius) const;
  void add_contacts_that_count(const Vec3& centre, double radius, const std::vector<std::uint32_t>& facets,
                               std::span<Nearest> minima, std::vector<Nearest>& found) const;
  std::vector<CurveLink> links(std::span<const CurveFacet> touching, const std::vector<std::uint32_t>& numbers) const;

  static constexpr std::uint32_t features_per_facet = 7;
  std::vector<Facet> facets_;
  std::vector<Side> sides_;  // by edge
  std::vector<Edge> edges_;
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> vertex_edges_;  // by vertex
  std::vector<std::int32_t> region_;         // by facet
  std::vector<Defect> defects_;
  std::optional<FacetIndex> index_;
  Bounds bounds_;
  Vec3 area_vector_ = Vec3::Zero();
  double size_ = 0, smooth_cosine_ = 1;  // largest coordinate [m]; cosine of the feature angle
  bool two_sided_ = false, closed_ = true, oriented_ = true;
};

}  // namespace grit
