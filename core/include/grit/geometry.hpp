// The shape of a wall.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grit/parameters.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Where a wall has moved to: x ↦ about + turn · (x − about) + shift. `about` is the wall's reference point, in the
/// coordinates of the description: motion/about if that is given, else the middle of bounds(), where a side that is
/// not finite counts as 0. A geometry applies the pose; it need not know the point.
struct Pose {
  Vec3 about = Vec3::Zero();
  Vec3 shift = Vec3::Zero();
  Mat3 turn = Mat3::Identity();

  Vec3 to_world(const Vec3& local) const { return about + turn * (local - about) + shift; }
  Vec3 to_local(const Vec3& world) const { return about + turn.transpose() * (world - shift - about); }
  bool turned() const { return !turn.isIdentity(0.0); }
};

/// A sphere that may touch.
struct Sphere {
  Vec3 centre;         ///< m
  double radius;       ///< m
  std::uint32_t body;  ///< handed through
};

/// One point where a sphere touches a shape.
struct Touch {
  Vec3 normal;            ///< unit, from the sphere's centre into the shape
  double overlap;         ///< m, > 0
  std::uint32_t body;     ///< of the sphere
  std::uint32_t feature;  ///< stable id of what is touched: it does not change while the sphere slides along it
};

/// A box; its sides may be infinite.
struct Bounds {
  Vec3 low, high;
};

/// A shape, at the place where the description puts it; a Pose says where it has moved to. Shapes do not change after
/// prepare(); all const functions may be called from several threads.
class Geometry {
 public:
  virtual ~Geometry() = default;
  virtual void declare(Parameters& parameters) = 0;
  /// Once, after the parameters were set. Throws ParameterError for values that it cannot work with.
  virtual void prepare() {}
  virtual Bounds bounds() const = 0;
  /// Whether bodies are inside of bounds(), as in a container, so that averages end at its near side.
  virtual bool hollow() const { return false; }
  /// Area that carries pressure [m²]; 0 if there is none to speak of.
  virtual double area() const = 0;
  /// Mean unit normal, towards the side of the bodies; zero if there is none to speak of.
  virtual Vec3 normal() const = 0;
  /// Whether it is made of plane faces that are wide: without grooves, curves or facets that a body could be as large
  /// as.
  virtual bool flat() const { return false; }
  /// Appends the contacts of each sphere, in the order of the spheres and, for one sphere, by feature. A convex edge or
  /// corner counts once, with the normal from the sphere's centre to the closest point. In a concave edge each face
  /// that is nearer than a radius counts by itself, two in an edge and three in a corner, so that no force jumps as the
  /// sphere comes in. Normal and overlap must not jump either as the sphere goes from a face over its convex edge.
  virtual void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const = 0;
  /// Whether a sphere is within `reach` of the shape: may say yes too often, never no when it touches, nor when it
  /// would say yes to a smaller sphere within it.
  virtual bool near(const Pose& pose, const Vec3& centre, double reach) const = 0;
  /// Triangles (three corners each) for pictures.
  virtual std::vector<Vec3> triangles() const = 0;
};

}  // namespace grit
