// A kind of body: what its size says about its volume and inertia.
#pragma once

#include <vector>

#include "grit/parameters.hpp"
#include "grit/vec.hpp"

namespace grit {

/// How far off what was integrated of a shape may be; 0 where it is known in closed form.
struct ShapeErrors {
  double mass = 0;     ///< over the mass
  double centre = 0;   ///< distance over the radius of the enclosing sphere
  double inertia = 0;  ///< the largest of a principal moment over itself
};

/// Spheres that are fixed to each other and move as one, in units of the radius of the smallest sphere that encloses
/// them. The origin is the centre of mass of their union, of uniform density, and the axes are its principal ones.
struct ClumpShape {
  std::vector<Row> spheres;      ///< centre, w: radius
  std::vector<double> shares;    ///< of each sphere's volume: what of it counts, where spheres that overlap share alike
  Vec3 middle = Vec3::Zero();    ///< of the enclosing sphere
  Mat3 axes = Mat3::Identity();  ///< columns: these axes, as seen in the frame in which the spheres were given
  double volume = 0;             ///< of the union
  Vec3 inertia = Vec3::Zero();   ///< principal moments for a mass of 1
  ShapeErrors errors = {};       ///< of volume, centre of mass and inertia
};

class BodyKind {
 public:
  virtual ~BodyKind() = default;
  virtual void declare(Parameters& parameters) = 0;
  /// Once, after the parameters were set. Throws ParameterError for values that it cannot work with.
  virtual void prepare() {}
  /// What it is made of, if it is not a sphere; then radii are those of the enclosing sphere.
  virtual const ClumpShape* clump() const { return nullptr; }
  virtual double volume(double radius) const = 0;                ///< m³
  virtual double inertia(double radius, double mass) const = 0;  ///< kg m², about any axis through the centre
};

}  // namespace grit
