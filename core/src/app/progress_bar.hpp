// How far a run is, on one line of a terminal, or a line now and then in a log.
#pragma once

#include <chrono>
#include <string>

#include "simulation/driver.hpp"

namespace grit {

/// What is shown on standard error.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine() { end(); }
  ProgressLine(const ProgressLine&) = delete;
  /// Whether it is time for a line; at a terminal it always is.
  bool is_due() const;
  void show(const std::string& text);
  /// Ends the line, so that others may print.
  void end();

 private:
  bool terminal_, open_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

class ProgressBar {
 public:
  void show(const Progress& progress);
  void end() { line_.end(); }

 private:
  ProgressLine line_;
  std::string stage_;
};

/// One line without its end, e.g. "2/4 shear  [#####-----]  48 %, 12 s left, 8.1 M particle-steps/s".
std::string progress_text(const Progress& progress);

}  // namespace grit
