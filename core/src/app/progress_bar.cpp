#include "app/progress_bar.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>

#include "format/duration.hpp"

namespace grit {
namespace {

constexpr int bar_width = 24;
constexpr auto log_interval = std::chrono::seconds(10);

std::string format(const char* form, auto... values) {
  char text[160];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

}  // namespace

std::string progress_text(const Progress& now) {
  std::string text = format("%zu/%zu %-14s ", now.stage_number, now.stages, now.stage.c_str());
  if (now.fraction) {
    const int full = static_cast<int>(*now.fraction * bar_width);
    text += '[' + std::string(static_cast<std::size_t>(full), '#') +
            std::string(static_cast<std::size_t>(bar_width - full), '-') + format("] %3.0f %%", 100 * *now.fraction);
    if (now.seconds_left) text += ", " + duration_text(*now.seconds_left) + " left";
  } else {
    text += format("t = %.4g s, ends by its condition", now.time);
  }
  return text + format(", %.2f M particle-steps/s", 1e-6 * now.particle_steps_per_second);
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

bool ProgressLine::is_due() const { return terminal_ || std::chrono::steady_clock::now() - shown_ >= log_interval; }

void ProgressLine::show(const std::string& text) {
  shown_ = std::chrono::steady_clock::now();
  if (terminal_) std::cerr << '\r' << text << "\033[K" << std::flush;
  else std::cerr << text << std::endl;
  open_ = terminal_;
}

void ProgressLine::end() {
  if (open_) std::cerr << std::endl;
  open_ = false;
}

void ProgressBar::show(const Progress& now) {
  const bool new_stage = now.stage != stage_;
  if (!new_stage && !line_.is_due()) return;
  if (new_stage) end();
  stage_ = now.stage;
  line_.show(progress_text(now));
}

}  // namespace grit
