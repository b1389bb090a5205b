// How far a run is, on one line of a terminal, or a line now and then in a log.
#pragma once

#include <chrono>
#include <string>

#include "run/driver.hpp"

namespace grit {

class ProgressBar {
 public:
  /// `terminal`: whether standard error is one.
  explicit ProgressBar(bool terminal) : terminal_(terminal) {}
  void show(const Progress& progress);
  /// Ends the line, so that others may print.
  void end();

 private:
  bool terminal_;
  bool open_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point last_{};
};

/// "42 s", "3 min 10 s", "2 h 05 min".
std::string duration_text(double seconds);

/// One line without its end, e.g. "2/4 shear  [#####-----]  48 %, 12 s left, 8.1 M particle-steps/s".
std::string progress_text(const Progress& progress);

}  // namespace grit
