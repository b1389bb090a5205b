// checkpoint.h5: the state from which an interrupted run is resumed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "grit/checkpoint.hpp"
#include "grit/error.hpp"
#include "output/run_facts.hpp"
#include "storage/state_file.hpp"

namespace grit {

/// The last checkpoint in a folder of results, and the one before it, in case the last is damaged.
inline std::filesystem::path checkpoint_path(const std::filesystem::path& folder) { return folder / "checkpoint.h5"; }
inline std::filesystem::path previous_checkpoint_path(const std::filesystem::path& folder) {
  return folder / "checkpoint-previous.h5";
}
/// Whether there is one of them.
bool has_checkpoint(const std::filesystem::path& folder);

/// A checkpoint that is incomplete, damaged, or of another format.
class DamagedCheckpoint : public FileError {
 public:
  DamagedCheckpoint(const std::string& cause, const std::string& advice) : FileError(cause + advice), cause_(cause) {}
  /// what() without advice.
  const std::string& cause() const { return cause_; }

 private:
  std::string cause_;
};

/// Writes a checkpoint with the facts of its run: grit, plugins and description. `previous`: as for write_state().
/// Throws FileError.
void write_checkpoint(const std::filesystem::path& path, const RunFacts& facts, const StateToSave& state,
                      const std::filesystem::path& previous = {});

/// Who reads a checkpoint, and so what is advised if it does not fit.
enum class ResumedBy { command_line, python };

/// What a checkpoint is compared by, as its file has it: grit, plugins and description.
Description checkpoint_facts(const RunFacts& facts);
/// Whether a run with the facts `now` can go on from a checkpoint with those of `then`; `checkpoint`: its name. Throws
/// FileError for one of another build of grit; PluginError for other builds of plugins; Error if the description cannot
/// be resumed from it.
void check_facts(const std::string& checkpoint, const Description& then, const Description& now, ResumedBy by);

/// Throws DamagedCheckpoint, and as check_facts() does.
Checkpoint read_checkpoint(const std::filesystem::path& path, const RunFacts& facts);

struct LastCheckpoint {
  Checkpoint checkpoint;
  /// Why it is not that of checkpoint_path() but the one before it; empty if it is.
  std::string note = {};
};

/// The last checkpoint of a folder that is whole; nothing if there is none. Throws as read_checkpoint() does.
std::optional<LastCheckpoint> last_checkpoint(const std::filesystem::path& folder, const RunFacts& facts);

/// Lines with the pointers at which two descriptions differ, each with the found and the allowed value; stages are
/// compared by name. Empty if the descriptions are of the same run. /output/checkpoint_every may differ.
std::string differences(const Description& now, const Description& then);
/// The same, but empty if a run of one can resume from a checkpoint of the other: /guards may differ too, as they only
/// decide where a run stops, unless a travel guard above its default sets the time step.
std::string differences_on_the_way(const Description& now, const Description& then);
/// Whether a run goes on with another limit of a guard, "overlap", "travel" or "energy", as differences_on_the_way()
/// has it. Not if a stage sets that guard.
bool can_go_on_with(const Description& description, const std::string& guard, double limit);
/// What to do if stages were added, removed or moved: a line to append to differences(); empty if they were not.
std::string advice_on_stages(const Description& now, const Description& then, ResumedBy by = ResumedBy::command_line);

}  // namespace grit
