// The state of a run in a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "grit/archive.hpp"
#include "grit/checkpoint.hpp"
#include "grit/description.hpp"

namespace grit {

/// A state, and facts of the run that wrote it: the keys "grit", "plugins" and "description" of a JSON object.
struct StateFile {
  Description facts;
  Checkpoint checkpoint;
};

/// A state that is saved when it is written, so that there is no second one in memory.
struct StateToSave {
  StateToSave(std::string of_stage, double at_time, std::uint64_t at_step, std::function<void(Archive&)> saves)
      : stage(std::move(of_stage)), time(at_time), step(at_step), save(std::move(saves)) {}
  /// One that was saved before, and lives as long as this.
  StateToSave(const Checkpoint& saved)
      : StateToSave(saved.stage, saved.time, saved.step, [&saved](Archive& to) { to.append(saved.state); }) {}

  std::string stage;   ///< name of the stage that was running
  double time;         ///< simulated [s]
  std::uint64_t step;  ///< since the start of the run
  std::function<void(Archive&)> save;
};
Checkpoint saved(const StateToSave& state);

/// Writes a temporary file and renames it once it is on disk, so that a complete file always exists. `previous`: the
/// name under which the file that is replaced is kept; empty: none. `temporary`: of the temporary file; empty: see
/// temporary_path(). `facts`: as in StateFile. Attributes: format, stage, time [s] and step.
/// Datasets: "facts" and "state". The file is sealed. Throws FileError.
void write_state(const std::filesystem::path& path, const Description& facts, const StateToSave& state,
                 const std::filesystem::path& previous = {}, const std::filesystem::path& temporary = {});

/// Throws FileError for an incomplete or damaged file, or one of another format. The checksum of all bytes comes first,
/// as HDF5 may crash when it reads damaged ones.
StateFile read_state(const std::filesystem::path& path);

}  // namespace grit
