// run.json: what ran, on which machine, how far and how fast.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "grit/description.hpp"
#include "output/run_facts.hpp"
#include "run/recorder.hpp"

namespace grit {

/// Each function rewrites the whole file atomically; all throw FileError.
class RunJson {
 public:
  RunJson(std::filesystem::path path, const RunFacts& facts);
  /// The facts of a run that is being prepared, with the status "running".
  void announce() const { write(); }
  /// Sets the status "running". A resumed run increments the count of resumptions in the existing file.
  void begin(const World& world, bool resumed);
  void stage_ended(const World& world, const std::string& what);
  void finish(const World& world, const RunSummary& summary);
  /// Start of the run, completed stages, and elapsed wall and CPU time.
  void serialize(Archive& archive);

 private:
  void progress(const World& world);
  double wall_s() const;
  double cpu_s() const;
  void write() const;

  std::filesystem::path path_;
  Description json_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  double wall_before_ = 0, cpu_before_ = 0;  // s, up to the checkpoint from which the run was resumed
};

}  // namespace grit
