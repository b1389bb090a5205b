#include "simulation/recorded_run.hpp"

#include <exception>
#include <new>

#include "grit/error.hpp"
#include "simulation/parts.hpp"

namespace grit {
namespace {

/// To be called while an exception is handled that ends a run: records it, unless the run can go on from a checkpoint.
void record_failure(Simulation::Parts& parts) {
  RunSummary summary;
  summary.status = "failed";
  try {
    throw;
  } catch (const FileError&) {
    return;
  } catch (const std::bad_alloc&) {
    return;
  } catch (const DescriptionError& error) {
    summary.message = error.problems().front().message;
  } catch (const std::exception& error) {
    summary.message = error.what();
  } catch (...) {
    summary.message = "something that is not a std::exception";
  }
  try {
    const auto alone = parts.kernel.alone();  // other ranks need not have failed
    parts.runner.fill(summary);
    parts.recorder.finish(parts.kernel.world(), summary);
  } catch (const std::exception&) {
    // The first one is reported.
  }
}

}  // namespace

RunSummary run_recorded(Simulation& simulation) {
  Simulation::Parts& parts = simulation.parts();
  parts.start();  // a fault found here leaves nothing recorded
  RunSummary summary;
  try {
    summary.status = simulation.run() ? "done" : "interrupted";
    if (summary.status == "done" && parts.checkpoints.keeps()) parts.checkpoints.save(parts.runner.to_save());
  } catch (const RefusedRecord&) {
    // Other ranks do not know of it.
    if (parts.checkpoints.keeps() && parts.kernel.ranks() == 1) parts.checkpoints.save(parts.runner.to_save());
    throw;
  } catch (const NumericsError& error) {
    summary.status = "failed", summary.message = error.what(), summary.guard = error.guard();
  } catch (...) {
    record_failure(parts);
    throw;
  }
  try {
    parts.runner.finish(summary);
  } catch (...) {
    record_failure(parts);
    throw;
  }
  return summary;
}

}  // namespace grit
