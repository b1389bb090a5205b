// run.json: what ran, on what, how far it came and how fast.
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
  /// status "running". A run that goes on counts on from the file that is there how often it has been resumed.
  void begin(const World& world, bool resumed);
  void stage_ended(const World& world, const std::string& what);
  void finish(const World& world, const RunSummary& summary);
  /// When the run started, stages that it has left behind, and the seconds that it took.
  void remember(Memory& memory);

 private:
  void progress(const World& world);
  double wall_s() const;
  double cpu_s() const;
  void write() const;

  std::filesystem::path path_;
  Description json_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  double wall_before_ = 0, cpu_before_ = 0;  // s, up to the checkpoint from which the run goes on
};

}  // namespace grit
