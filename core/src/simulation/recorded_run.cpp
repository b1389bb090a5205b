#include "simulation/recorded_run.hpp"

#include "grit/error.hpp"
#include "simulation/parts.hpp"

namespace grit {

RunSummary run_recorded(Simulation& simulation) {
  Simulation::Parts& parts = simulation.parts();
  parts.start();  // a fault found here leaves nothing recorded
  RunSummary summary;
  try {
    summary.status = simulation.run() ? "done" : "interrupted";
    if (summary.status == "done" && parts.checkpoints.keeps())
      parts.checkpoints.save([&] { return parts.runner.save(); });
  } catch (const RefusedRecord&) {
    if (parts.checkpoints.keeps()) parts.checkpoints.save([&] { return parts.runner.save(); });
    throw;
  } catch (const NumericsError& error) {
    summary.status = "failed", summary.message = error.what(), summary.guard = error.guard();
  } catch (const DescriptionError& error) {
    summary.status = "failed", summary.message = error.problems().front().message;
    parts.runner.fill(summary);
    parts.recorder.finish(parts.kernel.world(), summary);
    throw;
  }
  parts.runner.finish(summary);
  return summary;
}

}  // namespace grit
