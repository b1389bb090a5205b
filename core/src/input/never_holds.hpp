// Conditions for which a stage would wait until its limit.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "input/scene.hpp"

namespace grit {

/// A part of a description, and what is wrong with it.
struct Complaint {
  std::string pointer, message;
};

/// Why the condition of a stage cannot come true, by what the scene is then: one for each part that keeps it from it;
/// none if it may.
std::vector<Complaint> never_holds(const StagePlan& plan, std::size_t stage);

}  // namespace grit
