// A scenario turns a few parameters into a plain description: a pure function.
#pragma once

#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

class Scenario {
 public:
  virtual ~Scenario() = default;
  virtual void declare(Parameters& parameters) = 0;
  /// The plain description, numbers in SI. Throws grit::Error for wishes that cannot be had, with the range that can;
  /// one that begins with "/scenario/KEY: " is told of where KEY was written.
  virtual Description expand() const = 0;
};

}  // namespace grit
