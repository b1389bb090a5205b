// run.json: what ran, on what, how far it came and how fast.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/plugin.hpp"
#include "run/recorder.hpp"

namespace grit {

/// A plugin that takes part in a run.
struct PluginUsed {
  std::string kind, name, version;
  std::filesystem::path file;  ///< empty for a built-in component
  BuildTag tag;
};

/// What is known before a run begins.
struct RunFacts {
  Description description;  ///< resolved: everything inherited, set, and by default
  std::vector<PluginUsed> plugins;
  std::int64_t seed = 0;
  unsigned threads = 1;
};

/// Each function rewrites the whole file atomically; all throw FileError.
class RunJson {
 public:
  RunJson(std::filesystem::path path, const RunFacts& facts);
  /// status "running". Stages that a resumed run has left behind are taken over from the file that is there.
  void begin(const World& world, bool resumed);
  void stage_ended(const World& world, const std::string& what);
  void finish(const World& world, const RunSummary& summary);

 private:
  void progress(const World& world);
  void write() const;

  std::filesystem::path path_;
  Description json_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace grit
