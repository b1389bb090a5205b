#include "kernel/completion.hpp"

namespace grit {

void complete_bodies(State& state, Passes& passes) {
  if (state.complete.bodies) return;
  Bodies& bodies = state.bodies;
  const auto complete = [&](auto&... arrays) { (passes.ranks().complete_bodies(arrays, bodies.count()), ...); };
  complete(bodies.position, bodies.velocity, bodies.spin);
  if (!bodies.rotation.empty()) complete(bodies.rotation);
  state.complete.bodies = true;
}

void complete_sums(State& state, Passes& passes) {
  if (!state.complete.sums) passes.ranks().complete_bodies(state.sum, state.bodies.count());
  state.complete.sums = true;
}

}  // namespace grit
