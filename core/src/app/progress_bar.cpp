#include "app/progress_bar.hpp"

#include <cmath>
#include <cstdio>
#include <iostream>

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

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::min(seconds, 1e9)));
  if (whole < 60) return format("%ld s", whole);
  if (whole < 3600) return format("%ld min %02ld s", whole / 60, whole % 60);
  return format("%ld h %02ld min", whole / 3600, whole / 60 % 60);
}

std::string progress_text(const Progress& now) {
  std::string text = format("%zu/%zu %-14s ", now.stage_number, now.stages, now.stage.c_str());
  if (now.fraction) {
    const int full = static_cast<int>(*now.fraction * bar_width);
    text += '[' + std::string(static_cast<std::size_t>(full), '#') +
            std::string(static_cast<std::size_t>(bar_width - full), '-') + format("] %3.0f %%", 100 * *now.fraction);
    if (now.seconds_left) text += ", " + duration_text(*now.seconds_left) + " left";
  } else {
    text += format("t = %.4g s, until its condition holds", now.time);
  }
  return text + format(", %.2f M particle-steps/s", 1e-6 * now.particle_steps_per_second);
}

void ProgressBar::show(const Progress& now) {
  const auto time = std::chrono::steady_clock::now();
  const bool new_stage = now.stage != stage_;
  if (!terminal_ && !new_stage && time - last_ < log_interval) return;
  if (new_stage) end();
  stage_ = now.stage, last_ = time;
  if (terminal_) std::cerr << '\r' << progress_text(now) << "\033[K" << std::flush;
  else std::cerr << progress_text(now) << std::endl;
  open_ = terminal_;
}

void ProgressBar::end() {
  if (open_) std::cerr << std::endl;
  open_ = false;
}

}  // namespace grit
