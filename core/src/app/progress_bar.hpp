// Progress of a run: one line that is rewritten on a terminal, or a line every ten seconds in a log.
#pragma once

#include <chrono>
#include <string>

#include "grit/simulation.hpp"

namespace grit {

/// The progress line on standard error.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine() { end(); }
  ProgressLine(const ProgressLine&) = delete;
  /// Whether a new line is due; always on a terminal.
  bool is_due() const;
  void show(const std::string& text);
  /// Ends the line, so that other output may follow.
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

/// One line without a line feed, e.g. "2/4 shear  [#####-----]  48 %, 12 s left, 8.1 M particle-steps/s".
std::string progress_text(const Progress& progress);

}  // namespace grit
