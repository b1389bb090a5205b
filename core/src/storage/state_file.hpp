// The state of a run in a file.
#pragma once

#include <filesystem>

#include "grit/checkpoint.hpp"
#include "grit/description.hpp"

namespace grit {

/// A state, and facts of the run that wrote it: the keys "grit", "plugins" and "description" of a JSON object.
struct StateFile {
  Description facts;
  Checkpoint checkpoint;
};

/// Writes a temporary file and renames it once it is on disk, so that a complete file always exists. `previous`: the
/// name under which the file that is replaced is kept; empty: none. `temporary`: of the temporary file; empty: see
/// temporary_path(). Attributes: format, stage, time [s] and step.
/// Datasets: "facts" and "state". The file is sealed. Throws FileError.
void write_state(const std::filesystem::path& path, const StateFile& file, const std::filesystem::path& previous = {},
                 const std::filesystem::path& temporary = {});

/// Throws FileError for an incomplete or damaged file, or one of another format. The checksum of all bytes comes first,
/// as HDF5 may crash when it reads damaged ones.
StateFile read_state(const std::filesystem::path& path);

}  // namespace grit
