// Probes whose fields may be too large for frames.
#pragma once

#include "grit/world.hpp"

namespace grit {

/// A second base class of a probe that leaves fields out of a frame if they would have too many rows.
class LimitedFields {
 public:
  virtual ~LimitedFields() = default;
  /// Called after prepare() if the fields are written to frames, and for each frame. Throws ParameterError if they
  /// would be left out: before a run it is an error, later a warning.
  virtual void check_fields(const World& world) const = 0;
};

}  // namespace grit
