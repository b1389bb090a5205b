// Runs programs, several at once.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace grit {

struct BatchJob {
  std::vector<std::string> words;  ///< first the program's path, or its name, which PATH is searched for
  std::filesystem::path log;       ///< takes what it says, on both outputs
};

struct BatchEvents {
  /// A program ended: its index, and its exit status, or minus the signal that killed it. Returns whether to go on
  /// with those that have not been started.
  std::function<bool(std::size_t, int)> ended;
  /// Called several times a second: how many are at work.
  std::function<void(std::size_t)> waiting;
};

/// Starts programs in their order, `at_once` at a time, and waits for all that were started. Once `interrupted` is set
/// those at work are asked to stop (SIGTERM) and no more are started. Throws FileError if one cannot be started.
void run_batch(std::span<const BatchJob> jobs, std::size_t at_once, const std::atomic<bool>& interrupted,
               const BatchEvents& events);

}  // namespace grit
