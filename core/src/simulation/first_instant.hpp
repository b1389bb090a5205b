// Faults of a description that are found with the forces of the first instant.
#pragma once

#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"

namespace grit {

/// Runs `work`, which ends before the first step. A guard that stops it, or an error of a component, becomes a
/// DescriptionError with file, line and pointer: overlapping bodies, a wall that faces away from them, a time step
/// above the critical one.
template <class Work>
auto at_first_instant(const Document& document, const Work& work) {
  return at_its_place(document, [&] {
    try {
      return work();
    } catch (const NumericsError& error) {
      if (error.keys().empty()) throw;
      PlacedError placed(error.keys(), error.cause());
      placed.begun(1);
      throw placed;
    }
  });
}

}  // namespace grit
