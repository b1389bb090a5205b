// Runs programs concurrently.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace grit {

struct BatchJob {
  std::vector<std::string> words;  ///< command line; first the program's path, or its name in PATH
  std::filesystem::path log;       ///< receives standard output and standard error
  std::string heading = {};        ///< first in the log
};

struct BatchEvents {
  /// Called when a program ends: its index, and its exit status, or minus the signal that killed it. Returns whether to
  /// start the remaining ones.
  std::function<bool(std::size_t, int)> ended;
  /// Called several times a second with the number of running programs.
  std::function<void(std::size_t)> waiting;
};

/// Starts programs in order, at most `at_once` at a time, and waits for all that were started. Once `interrupted` is
/// set the running ones get SIGTERM and no more are started; also if this process is killed. Throws FileError if one
/// cannot be started.
void run_batch(std::span<const BatchJob> jobs, std::size_t at_once, const std::atomic<bool>& interrupted,
               const BatchEvents& events);

}  // namespace grit
