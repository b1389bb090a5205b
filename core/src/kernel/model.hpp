// What a kernel reports of itself: what it computes, and the time it takes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace grit {

/// Computing time of one phase of the step.
struct PhaseTime {
  std::string name;
  double seconds = 0;
};

/// What is stored and computed. Everything else is left out, because no component asked for it.
struct Model {
  std::size_t lanes = 1;                   ///< pairs that the contact law's loop takes at once
  std::string precision;                   ///< of its arithmetic
  std::vector<std::string> law_parts;      ///< of the contact law, compiled into that loop
  std::vector<std::string> contact_state;  ///< what each contact remembers
  std::vector<std::string> body_state;     ///< of bodies, beyond position, velocity and spin
  std::vector<std::string> materials;      ///< in the order of their numbers
  bool one_material = true, periodic = false, walls = false, gravity = false, local_damping = false;
  std::size_t bytes = 0;  ///< held by bodies and contacts
};

}  // namespace grit
