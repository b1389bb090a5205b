// What contacts remember, whatever the order of the bodies.
#pragma once

#include <map>

#include "support/scene.hpp"

namespace grit::test {

/// Memories by the ids of the two, as seen from the lower id; walls count from 1000.
using Memories = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<double>>;
inline Memories memories(const Trial& t, std::size_t* swapped = nullptr) {
  const State& state_now = t.kernel().state();
  const auto fields = t.law().state();
  const auto ids = t.world().ids();
  Memories all;
  for (std::size_t c = 0; c < state_now.pairs.candidates(); ++c) {
    if (!state_now.pairs.contacts(c)) continue;
    const std::uint32_t a = ids[state_now.pairs.a(c)], b = ids[state_now.pairs.b(c)];
    auto state = state_now.pairs.state(c);
    for (std::size_t f = 0; f < fields.size() && a > b; ++f) state[f] *= fields[f].swap;
    if (swapped != nullptr) *swapped += a > b;
    all[std::minmax(a, b)] = std::move(state);
  }
  state_now.wall_contacts.each([&](const WallContacts::Touching& contact) {
    all[{ids[contact.contact->body], 1000 + contact.contact->wall}].assign(contact.state.begin(), contact.state.end());
  });
  return all;
}

}  // namespace grit::test
