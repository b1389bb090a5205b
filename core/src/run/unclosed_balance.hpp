// Energy balances that do not close.
#pragma once

#include <string>

#include "grit/world.hpp"

namespace grit {

/// The largest closure error of a balance over the energy turned over that is not warned of.
inline constexpr double allowed_closure_error = 0.01;

/// The largest term of a balance [J], and its name.
struct LargestTerm {
  double energy = 0;
  const char* name = "";
};
/// The energy turned over: the magnitude of the largest of the initial, stored and dissipated energies and of all
/// works.
LargestTerm largest_term(const Energies& balance);

/// What is wrong with a balance, and what to do; empty if its error is allowed. `law`: name of the contact law.
std::string unclosed_balance(const Energies& balance, const std::string& law);

}  // namespace grit
