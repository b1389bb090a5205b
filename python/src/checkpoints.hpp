// Checkpoints in files, as those of `grit run`.
#pragma once

#include <filesystem>

#include "grit/simulation.hpp"

namespace grit::python {

/// Throws FileError.
void write(const std::filesystem::path& path, Simulation& simulation, const Checkpoint& checkpoint);
/// Throws FileError; PluginError or Error for a checkpoint of other plugins or of another description.
Checkpoint read(const std::filesystem::path& path, Simulation& simulation);

}  // namespace grit::python
