// Shapes of walls.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "grit/parameters.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Translation and rotation of a wall since the start: x ↦ about + turn · (x − about) + shift. `about` is the wall's
/// reference point in the coordinates of the description: motion/about if given, else the centre of bounds(), with 0
/// for a side that is infinite. A geometry only applies the pose; it need not know the reference point.
struct Pose {
  Vec3 about = Vec3::Zero();     ///< m
  Vec3 shift = Vec3::Zero();     ///< m
  Mat3 turn = Mat3::Identity();  ///< rotation matrix

  Vec3 to_world(const Vec3& local) const { return about + turn * (local - about) + shift; }
  Vec3 to_local(const Vec3& world) const { return about + turn.transpose() * (world - shift - about); }
  bool turned() const { return !turn.isIdentity(0.0); }
};

/// A sphere that may touch a wall.
struct Sphere {
  Vec3 centre;         ///< m
  double radius;       ///< m
  std::uint32_t body;  ///< copied to SurfaceContact::body
};

/// One contact of a sphere with a shape.
struct SurfaceContact {
  Vec3 normal;            ///< unit, from the sphere's centre into the shape
  double overlap;         ///< m, > 0
  std::uint32_t body;     ///< Sphere::body
  std::uint32_t feature;  ///< id of the face, edge or corner in contact; constant while the sphere slides along it
};

/// A box [m]; its sides may be infinite.
struct Bounds {
  Vec3 low, high;
};

/// Base class of plugins of kind "geometry": a surface at its initial position, as in the description. A Pose gives the
/// present position. Shapes do not change after prepare(); all const functions may be called from several threads.
class Geometry {
 public:
  virtual ~Geometry() = default;
  virtual void declare(Parameters& parameters) = 0;
  /// Called once after the parameters were set. Throws ParameterError for values that are not possible.
  virtual void prepare() {}
  /// Of the shape at its initial position.
  virtual Bounds bounds() const = 0;
  /// Whether bodies are inside bounds(), as in a container. The specimen then ends at the inner faces.
  virtual bool hollow() const { return false; }
  /// Area over which pressure is defined [m²]; 0 if it is undefined.
  virtual double area() const = 0;
  /// Mean unit normal, towards the bodies; zero if it is undefined.
  virtual Vec3 normal() const = 0;
  /// Whether the shape consists of plane faces much wider than a body: no grooves, curvature or facets of the size of a
  /// body.
  virtual bool flat() const { return false; }
  /// Appends the contacts of each sphere, in the order of the spheres and, for one sphere, in ascending order of
  /// features. A convex edge or corner gives one contact, with the normal from the sphere's centre to the closest
  /// point. In a concave edge each face nearer than one radius gives its own contact: two in an edge, three in a
  /// corner. Forces are then continuous as the sphere moves in. Normal and overlap must also be continuous as the
  /// sphere moves from a face over a convex edge.
  virtual void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                             std::vector<SurfaceContact>& contacts) const = 0;
  /// Whether a sphere of radius `reach` [m] may touch the shape; used by the neighbour search. It may return true for a
  /// sphere that does not touch. It must return true for every sphere that touches, and for every sphere that contains
  /// one for which it returns true.
  virtual bool near(const Pose& pose, const Vec3& centre, double reach) const = 0;
  /// Triangles for pictures and files, three corners each [m], at the initial position.
  virtual std::vector<Vec3> triangles() const = 0;
  /// Index of the triangle of triangles() on which a feature lies, for a surface that consists of them; none for other
  /// shapes, of which they are pictures.
  virtual std::optional<std::uint32_t> triangle_of(std::uint32_t /*feature*/) const { return {}; }
  /// Whether the surface consists of its triangles, as that of a mesh: triangle_of() then names one for each feature.
  bool is_triangulated() const { return triangle_of(0).has_value(); }
};

}  // namespace grit
