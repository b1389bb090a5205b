// Conditions that cannot be met, so that a stage would run to its limit.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "description/description.hpp"
#include "grit/geometry.hpp"

namespace grit {

/// A part of a description and its fault.
struct Complaint {
  std::string pointer, message;
};

/// The states that decide whether the condition of a stage can be met.
struct StageStates {
  const StageDescription& stage;
  DomainDescription domain;  ///< at the start of the stage
  /// At the start of the stage, and at the start and end of each of its ramps; never empty.
  std::vector<std::map<std::string, WallDescription>> walls;
  std::map<std::string, std::shared_ptr<const Geometry>> geometries;  ///< at the start of the stage
};

/// Why the condition of a stage cannot be met: one complaint for each part that prevents it, with pointers from the
/// root of the description; none if it can.
std::vector<Complaint> unreachable_conditions(const StageStates& states, std::size_t stage);

}  // namespace grit
