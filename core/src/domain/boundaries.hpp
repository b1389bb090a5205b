// Bodies at the sides of the domain: they re-enter at a periodic side, or leave through an open side.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bodies/bodies.hpp"
#include "domain/deforming_cell.hpp"
#include "grit/engine.hpp"
#include "grit/world.hpp"
#include "threads/team.hpp"

namespace grit {

/// A body outside a closed side.
struct Escape {
  std::size_t body;
  int axis;
  bool high;
};
struct Wrapped {
  std::vector<bool> leaves;       ///< by body: whether it has left through an open side
  std::vector<double> gained;     ///< kinetic energies, from the mean flow where bodies re-enter, in order [J]
  std::optional<Escape> escaped;  ///< the first one
};

/// Moves bodies that have left the periodic cell back into it: those of the chunks `first` … `last` − 1, and all
/// clumps. `velocities` of its images [m/s] are in columns, by axis; `open_sides` has entries such as "-x".
Wrapped wrap(Bodies& bodies, std::size_t first, std::size_t last, const Cell& cell, const Mat3& velocities,
             const std::vector<std::string>& open_sides, Team& team);

/// Expresses the shifts of spheres relative to their clumps in new periods; see DeformingCell::reduce_tilt().
void change_periods(Bodies& bodies, const Eigen::Matrix3i& of_old);

/// A body that leaves, and its energy [J].
struct Leaving {
  Departure departure;
  double kinetic;    ///< of translation and rotation
  double potential;  ///< relative to the origin
};
/// In order of ids; a clump leaves as a whole, with the id of its first sphere.
std::vector<Leaving> leaving(const Bodies& bodies, const std::vector<bool>& leaves, double time,
                             const std::function<const MotionSettings&(std::size_t body)>& motion_of);

}  // namespace grit
