// Facets joined to a surface: which corners and edges they share, what is wrong with that, and where they are.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "facet_index.hpp"
#include "grit/geometry.hpp"
#include "stl.hpp"

namespace grit {

/// How facets are joined, and what is legitimate.
struct SurfaceOptions {
  double scale = 1;  ///< m for 1 in the file
  Vec3 position = Vec3::Zero();
  double merge = 0;        ///< m; corners no farther apart are one
  double crease = 0;       ///< rad; facets that meet at less are of one curved surface
  bool open = false;       ///< edges with one facet are meant
  bool two_sided = false;  ///< so are facets that face different ways, and edges with three and more
  bool inside = false;     ///< bodies are on the side that facets face away from
  bool skip_degenerate = false, ignore_normals = false;
};

/// Facets keep the file's numbers. A feature's number is 7 × that of the first of the facets that share it, plus 0 for
/// the facet itself, 1 … 3 for its edges, 4 … 6 for its corners.
class Surface {
 public:
  /// A point of the surface that is closer to a centre than all points around it.
  struct Nearest {
    Vec3 away;        ///< unit, from there towards the centre, or, if that is behind, towards the front
    double distance;  ///< m; below 0 behind
    bool behind;
    std::uint32_t feature;
    std::int32_t region;  ///< of its facets; −1 if they are of several
  };

  Surface(const Stl& stl, const SurfaceOptions& options);

  const std::vector<Defect>& defects() const { return defects_; }
  const Bounds& bounds() const { return bounds_; }
  /// Sum of the facets' area vectors [m²], towards the bodies; zero if the surface is closed, or has no one front.
  const Vec3& area_vector() const { return area_vector_; }
  /// Three corners each, counter-clockwise as the bodies see them; those of facets left out are all the same point.
  std::vector<Vec3> triangles() const;

  /// Where a sphere touches: from in front, each closest point of its surroundings once; from behind, the closest
  /// of all. `facets` is scratch.
  void nearest(const Vec3& centre, double radius, std::vector<std::uint32_t>& facets,
               std::vector<Nearest>& found) const;
  /// Whether some facet is within `reach`.
  bool near(const Vec3& centre, double reach) const;
  /// Facets whose boxes meet the cube about a centre, half of whose side is `reach`, in their order.
  void facets_near(const Vec3& centre, double reach, std::vector<std::uint32_t>& facets) const {
    index_->meeting({centre - Vec3::Constant(reach), centre + Vec3::Constant(reach)}, facets);
  }

 private:
  struct Facet {
    std::array<std::uint32_t, 3> corners, edges;  // edge i is from corner i to the next
    Vec3 normal;
    std::array<Vec3, 3> inward;  // unit, in the plane, from each edge
    bool left_out;
  };
  struct Side {
    std::uint32_t facet, edge;  // which of the facet's three
  };
  struct Edge {
    std::uint32_t from, to;
    std::uint32_t first_side, end_side;
    Vec3 along, normal = Vec3::Zero();  // the latter of its facets
    double length = 0;
    std::int32_t region = -1;
    bool rim = false, turns = false;  // from one facet alone; between facets that face different ways
  };
  struct Vertex {
    Vec3 place, normal = Vec3::Zero();  // the latter of its facets, weighted by angle
    std::uint32_t first_edge = 0, end_edge = 0, owner = ~0u;
    std::int32_t region = -2;
    bool rim = false;
  };

  void merge_corners(const Stl& stl, const SurfaceOptions& options);
  void span_facets(const Stl& stl, const SurfaceOptions& options);
  void join_edges(const SurfaceOptions& options);
  void check_volumes(bool inside);
  void find_regions();
  void gather_corners();
  struct Seam {
    std::uint32_t facet, other;
    Vec3 from, to;
    double gap;      // m
    bool mergeable;  // whether corners as far apart as the gap are all that is between them
  };
  void check_seams();
  std::optional<Seam> seam(const Side& side, std::uint32_t other, double gap) const;
  template <class Joins>
  std::vector<std::uint32_t> groups(Joins joins) const;
  std::vector<std::size_t> inverted() const;
  const Vec3& corner(const Facet& facet, std::size_t i) const { return vertices_[facet.corners[i]].place; }
  double inside_edge(const Side& side, const Vec3& centre) const;
  double height(const Facet& facet, const Vec3& centre) const { return facet.normal.dot(centre - corner(facet, 0)); }
  double distance(std::uint32_t facet, const Vec3& centre) const;
  void closest_of(std::uint32_t number, const Vec3& centre, double radius, std::vector<Nearest>& found) const;
  bool touches_edge(const Edge& edge, const Vec3& centre, double slack) const;
  bool touches_vertex(const Vertex& vertex, const Vec3& centre, double slack) const;
  void leave_out_doubles(const Vec3& centre, double radius, std::vector<Nearest>& found) const;
  void leave_out_of_one_curve(std::vector<Nearest>& found) const;

  static constexpr std::uint32_t features_a_facet = 7;
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
  double size_ = 0, like_ = 1;  // largest coordinate [m]; cosine of the crease
  bool two_sided_ = false, closed_ = true, oriented_ = true;
};

}  // namespace grit
