// Checkpoints in memory and in files, as those of `grit run`.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "grit/description.hpp"
#include "grit/simulation.hpp"

namespace grit::python {

/// A checkpoint, and what has to be the same in a simulation that resumes from it.
struct SavedState {
  Checkpoint checkpoint;
  std::shared_ptr<const Description> facts;  ///< those of checkpoint_facts()
  std::string name = "this checkpoint";      ///< in messages
};

Description facts_of(Simulation& simulation);
/// Throws FileError, PluginError or Error if a simulation of these facts cannot resume from it.
void check_fits(const SavedState& saved, const Description& facts);
/// Throws FileError.
void write_saved(const std::filesystem::path& path, const SavedState& saved);
/// Throws FileError.
SavedState read_saved(const std::filesystem::path& path);

}  // namespace grit::python
