// Conditions that a stage would wait for until its limit.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "description/description.hpp"
#include "grit/geometry.hpp"

namespace grit {

/// A part of a description, and what is wrong with it.
struct Complaint {
  std::string pointer, message;
};

/// What a stage's condition is judged by.
struct StageStates {
  const StageDescription& stage;
  DomainDescription domain;  ///< as the stage begins
  /// As the stage begins, and as each of its ramps begins and ends; never empty.
  std::vector<std::map<std::string, WallDescription>> walls;
  std::map<std::string, std::shared_ptr<const Geometry>> geometries;  ///< as the stage begins
};

/// Why the condition of a stage cannot come true: one complaint for each part that prevents it, with pointers from the
/// root of the description; none if it may.
std::vector<Complaint> unreachable_conditions(const StageStates& states, std::size_t stage);

}  // namespace grit
