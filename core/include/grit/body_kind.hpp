// A kind of body: what its size says about its volume and inertia.
#pragma once

#include "grit/parameters.hpp"

namespace grit {

class BodyKind {
 public:
  virtual ~BodyKind() = default;
  virtual void declare(Parameters& parameters) = 0;
  virtual double volume(double radius) const = 0;                ///< m³
  virtual double inertia(double radius, double mass) const = 0;  ///< kg m², about any axis through the centre
};

}  // namespace grit
