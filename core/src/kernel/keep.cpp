// Arrays whose memory outlives the instant.
#include <memory>

#include "kernel/kernel.hpp"
#include "kernel/world_view.hpp"

namespace grit {
namespace {

/// The memory of an array, with its present values. The array continues in a copy.
template <class Array>
std::shared_ptr<const void> kept(Array& array) {
  const auto memory = std::make_shared<Array>(array);
  memory->swap(array);
  return memory;
}

}  // namespace

std::shared_ptr<const void> Kernel::keep(WorldArray array) {
  Bodies& bodies = state_.bodies;
  switch (array) {
    case WorldArray::ids:
      return kept(bodies.id);
    case WorldArray::positions:
      return kept(bodies.position);
    case WorldArray::velocities:
      return kept(bodies.velocity);
    case WorldArray::spins:
      return kept(bodies.spin);
    case WorldArray::materials:
      return kept(bodies.material);
    case WorldArray::rotations:
      return kept(bodies.rotation);
    case WorldArray::departures:
      return kept(state_.departures);
    default:
      return view_.keep(array);
  }
}

std::shared_ptr<const void> WorldView::keep(WorldArray array) {
  switch (array) {
    case WorldArray::displacements:
      return kept(displacements_);
    case WorldArray::clump_of:
      return kept(clump_of_);
    case WorldArray::clumps:
      return kept(clumps_);
    case WorldArray::forces:
      return kept(net_force_);
    case WorldArray::moments:
      return kept(net_moment_);
    case WorldArray::contacts:
      return kept(contacts_);
    default:
      return nullptr;
  }
}

}  // namespace grit
