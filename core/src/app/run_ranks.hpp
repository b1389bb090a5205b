// The processes that mpirun or srun has started for one run.
#pragma once

#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/exit_status.hpp"
#include "app/options.hpp"
#include "ranks/ranks.hpp"

namespace grit {

/// What ranks must have alike.
struct RankFact {
  std::string what, text;
};

/// Ranks as `grit run` needs them. The first one writes results and messages; the others write only why they fail
/// alone.
class RunRanks {
 public:
  /// Opens the component for MPI if the process is one of several. Throws Error if this build has none.
  RunRanks();
  ~RunRanks();
  RunRanks(const RunRanks&) = delete;

  bool several() const { return ranks_.several(); }
  bool is_first() const { return ranks_.rank() == 0; }
  unsigned count() const { return ranks_.count(); }
  /// For the simulation; null with one rank.
  Communicator* communicator() const { return all_; }

  /// Compares the ranks before they begin. `failure`: of this rank, if any. Returns what the first rank gives; nothing
  /// if any rank has failed or differs, which the first one reports.
  std::optional<std::vector<std::byte>> agree(const std::vector<RankFact>& facts, const std::string& failure,
                                              std::vector<std::byte> given);
  /// From now on all ranks will call agree().
  void expect_agreement() { awaited_ = true; }
  /// Whether others wait for this rank to call it.
  bool is_awaited() const { return awaited_; }
  /// The messages of this rank since the last call, if it is not the first.
  std::string messages();
  /// Threads of this process: those of --threads, or its share of the machine.
  unsigned threads(const Options& options) const;
  /// Ends the process with the others. A rank that fails alone ends them.
  ExitStatus end(ExitStatus status);

 private:
  Communicator* all_ = nullptr;
  Ranks ranks_;
  bool awaited_ = false;
  std::ostringstream silent_;
  std::streambuf *out_ = nullptr, *errors_ = nullptr;
};

}  // namespace grit
