// Scenarios: components that write a complete description from a few parameters.
#pragma once

#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// Base class of plugins of kind "scenario".
class Scenario {
 public:
  virtual ~Scenario() = default;
  virtual void declare(Parameters& parameters) = 0;
  /// The description, numbers in SI; depends on the parameters only. Throws ParameterError for impossible values; its
  /// keys are those of the parameters.
  virtual Description expand() const = 0;
};

}  // namespace grit
