#include "run/unclosed_balance.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "format/number.hpp"

namespace grit {

LargestTerm largest_term(const Energies& balance) {
  const double works = balance.walls + balance.cell + balance.engines + balance.settings,
               initial = balance.kinetic + balance.elastic() + balance.gravitational + balance.dissipated() - works -
                         balance.closure_error;
  LargestTerm largest;
  for (const LargestTerm& term :
       {LargestTerm{initial, "initial energy"}, LargestTerm{balance.kinetic, "kinetic energy"},
        LargestTerm{balance.elastic(), "elastic energy"}, LargestTerm{balance.gravitational, "potential energy"},
        LargestTerm{balance.walls, "work of walls"}, LargestTerm{balance.cell, "work of the cell"},
        LargestTerm{balance.engines, "work of engines"},
        LargestTerm{balance.settings, "energy added by changes of the description"},
        LargestTerm{balance.dissipated(), "dissipated energy"}})
    if (std::abs(term.energy) > largest.energy) largest = {std::abs(term.energy), term.name};
  return largest;
}

std::string unclosed_balance(const Energies& balance, const std::string& law) {
  const LargestTerm most = largest_term(balance);
  const double error = balance.closure_error;
  if (std::abs(error) <= allowed_closure_error * most.energy) return "";
  return fmt::format(
      "the energy balance does not close: {} J {}, {} of the energy turned over ({} J, {}); allowed is {}; try a "
      "smaller step (/time_step/safety); if the error stays, the losses() of the contact law \"{}\" may be wrong: its "
      "contract tests them",
      number(std::abs(error)), error > 0 ? "are more than there were and were put in" : "have gone nowhere",
      percent(std::abs(error) / most.energy), number(most.energy), most.name, percent(allowed_closure_error), law);
}

}  // namespace grit
