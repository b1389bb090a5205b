// Kinds of bodies: volume and inertia as functions of size.
#pragma once

#include <vector>

#include "grit/parameters.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Estimated errors of a shape's numerical integration; 0 where a closed form is known.
struct ShapeErrors {
  double mass = 0;     ///< relative to the mass
  double centre = 0;   ///< of the centre of mass, over the radius of the enclosing sphere
  double inertia = 0;  ///< largest relative error of the principal moments
};

/// Spheres that are fixed to each other and move as one rigid body. The unit of length is the radius of the smallest
/// enclosing sphere. The origin is the centre of mass of their union at uniform density; the axes are its principal
/// axes.
struct ClumpShape {
  std::vector<Row> spheres;              ///< centre, w: radius
  std::vector<double> volume_fractions;  ///< fraction of each sphere's volume that counts; overlaps are divided equally
  Vec3 middle = Vec3::Zero();            ///< centre of the enclosing sphere
  Mat3 axes = Mat3::Identity();          ///< columns: the principal axes in the frame in which the spheres were given
  double volume = 0;                     ///< of the union
  Vec3 inertia = Vec3::Zero();           ///< principal moments of inertia for a mass of 1
  ShapeErrors errors = {};               ///< of volume, centre of mass and inertia
  double given_radius = 0;  ///< of the enclosing sphere as the shape was given [m]; 0: only its proportions
};

/// Base class of plugins of kind "body".
class BodyKind {
 public:
  virtual ~BodyKind() = default;
  virtual void declare(Parameters& parameters) = 0;
  /// Called once after the parameters were set. Throws ParameterError for values that are not possible.
  virtual void prepare() {}
  /// The spheres of a clump; null for a single sphere. Radii are then those of the enclosing sphere.
  virtual const ClumpShape* clump() const { return nullptr; }
  virtual double volume(double radius) const = 0;                ///< m³
  virtual double inertia(double radius, double mass) const = 0;  ///< kg m², about any axis through the centre
};

}  // namespace grit
