// Information on a kernel: what it stores and computes, and the computing time of its phases.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace grit {

/// Computing time of one phase of the step.
struct PhaseTime {
  std::string name;
  double seconds = 0;
  double parallel = 0;  ///< part of it that several threads can share, whether or not there are several [s]
};

/// Stored and computed quantities. All others are omitted, because no component requested them.
struct Model {
  std::size_t lanes = 1;                   ///< pairs that the loop of the contact law evaluates at once
  std::string precision;                   ///< of its arithmetic
  std::vector<std::string> law_parts;      ///< active features of the contact law
  std::vector<std::string> contact_state;  ///< fields of the contact history
  std::vector<std::string> body_state;     ///< of bodies, in addition to position, velocity and spin
  std::vector<std::string> materials;      ///< by index
  bool one_material = true, periodic = false, walls = false, gravity = false, local_damping = false;
  std::size_t bytes = 0;  ///< memory of bodies and contacts
};

}  // namespace grit
