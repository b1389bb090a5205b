// Runs a simulation to its end, and returns how it ended.
#pragma once

#include "grit/simulation.hpp"
#include "run/recorder.hpp"

namespace grit {

/// Runs all remaining stages, and finishes the recorder of the simulation. Returns how the run ended: "done",
/// "interrupted" or "failed" (a guard, a stage that did not end, an expectation that was not met; the message says
/// which). In all three cases everything is recorded, including the last instant. Other errors are thrown: those of a
/// plugin, and faults of the description found after the start, are first recorded as failed, and a simulation whose
/// record was refused is saved. A file that cannot be written and want of memory leave the record of a killed run,
/// which can go on from its checkpoint.
RunSummary run_recorded(Simulation& simulation);

}  // namespace grit
