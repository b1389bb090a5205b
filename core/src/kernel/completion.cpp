#include "kernel/completion.hpp"

#include "kernel/body_groups.hpp"

namespace grit {

void take_halo(State& state, Passes& passes) {
  state.halo.finish(
      state.bodies, [&](std::size_t chunk) -> double& { return passes.chunks()[chunk].relative_speed; },
      passes.ranks());
  state.lists.advance_near(state.halo.chunks(), passes);
}

void complete_bodies(State& state, Passes& passes) {
  if (state.complete.bodies) return;
  if (state.device) {
    state.device->fetch(state.bodies);
    state.complete.bodies = true;
    return;
  }
  take_halo(state, passes);
  Bodies& bodies = state.bodies;
  const auto complete = [&](auto&... arrays) {
    ((arrays.empty() ? void() : passes.ranks().complete_bodies(arrays, bodies.count())), ...);
  };
  // Origins move with bodies that re-enter a periodic cell.
  complete(bodies.position, bodies.velocity, bodies.spin, bodies.rotation, bodies.origin);
  if (!state.complete.identities) {
    complete(bodies.id, bodies.material);
    find_groups(state);
  }
  state.complete.bodies = state.complete.identities = true;
}

void fetch_bodies(State& state, Passes& passes) {
  if (state.device) complete_bodies(state, passes);
}

void complete_sums(State& state, Passes& passes) {
  if (!state.complete.sums) passes.ranks().complete_bodies(state.sum, state.bodies.count());
  state.complete.sums = true;
}

}  // namespace grit
