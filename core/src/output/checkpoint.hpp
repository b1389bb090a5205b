// checkpoint.h5: from where a run that was stopped goes on.
#pragma once

#include <filesystem>
#include <string>

#include "output/run_facts.hpp"
#include "run/recorder.hpp"

namespace grit {

/// Written beside and renamed once it is on disk: there is always a whole one, however the writer ends. Attributes say
/// format, stage, time [s] and step; datasets, all with checksums, "facts" (JSON: grit, plugins and description) and
/// "memory". Throws FileError.
void write_checkpoint(const std::filesystem::path& path, const RunFacts& facts, const Checkpoint& checkpoint);

/// Throws FileError for a file that is not a whole checkpoint, or one of another build of grit; PluginError where
/// plugins were built otherwise; Error where a run of the description would not go on from it.
Checkpoint read_checkpoint(const std::filesystem::path& path, const RunFacts& facts);

/// Pointers at which two descriptions differ, each with what was found and what is allowed; empty if they are of the
/// same run. /output/checkpoint_every may differ.
std::string differences(const Description& now, const Description& then);
/// The same, empty if a run of the one can go on from where a run of the other was: /guards/travel and /guards/energy
/// may differ too, which change nothing but where a run ends. /guards/overlap also sets the step of springs that
/// stiffen.
std::string differences_on_the_way(const Description& now, const Description& then);

}  // namespace grit
