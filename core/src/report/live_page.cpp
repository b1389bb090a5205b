#include "report/live_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <thread>

#include "grit/error.hpp"
#include "output/read_frames.hpp"

namespace grit {
namespace {

using std::filesystem::path;

std::string stamp_of_file(const path& file) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  const auto changed = std::filesystem::last_write_time(file, none);
  return fmt::format("{} {} ", size, changed.time_since_epoch().count());
}

/// Another one, if something was written in between.
std::string stamp_of(const path& folder) {
  return stamp_of_file(folder / "run.json") + stamp_of_file(folder / "series.h5") + stamp_of_file(folder / "frames");
}

/// Whether nobody has written to a file for a while.
bool rests(const path& file) {
  using namespace std::chrono_literals;
  std::error_code none;
  const auto changed = std::filesystem::last_write_time(file, none);
  return none || std::filesystem::file_time_type::clock::now() - changed > 20ms;
}

using Clock = std::chrono::steady_clock;

// A flush of the series takes some milliseconds, in which their file fits together for nobody: what was read counts if
// the file rested before and is the same after. Where it never rests so long, what is there has to do, until next time.
constexpr auto patience = std::chrono::seconds(1);
constexpr auto between_attempts = std::chrono::milliseconds(25);

}  // namespace

LivePage::LivePage(path folder, std::string run, const GrainLimits& limits)
    : folder_(std::move(folder)),
      run_(std::move(run)),
      limits_(limits),
      content_(empty_content(folder_.filename().string(), "The run is being prepared.")) {
  content_.json["live"] = {{"since", since()}, {"run", run_}};
}

bool LivePage::refresh() {
  if (stamp_of(folder_) == stamp_ || !std::filesystem::exists(folder_ / "run.json")) return false;
  const path series = folder_ / "series.h5";
  const auto until = Clock::now() + patience;
  for (bool first = true; first || Clock::now() < until; first = false) {
    if (!first) std::this_thread::sleep_for(between_attempts);
    while (!rests(series) && Clock::now() < until) std::this_thread::sleep_for(between_attempts);
    const std::string before = stamp_of(folder_), series_before = stamp_of_file(series);
    DataElements data = data_.next();
    try {
      ReportContent content = report_content(std::span(&folder_, 1), limits_, data);
      if (stamp_of_file(series) != series_before && Clock::now() < until) continue;
      content_ = std::move(content);
    } catch (const std::exception&) {  // of files that are being replaced
      continue;
    }
    stamp_ = before;
    data_ = std::move(data);
    content_.json["live"] = {{"since", since()}, {"run", run_}};
    return true;
  }
  return false;
}

std::string LivePage::html() const { return report_html(content_, data_, Reach::server); }

Description LivePage::news(std::size_t since) const {
  Description news = {{"run", run_}};
  if (since == data_.end()) return news;
  news["since"] = data_.end();
  news["head"] = content_.head;
  news["report"] = content_.json;
  news["elements"] = Description::object(), news["used"] = Description::array();
  for (const auto& [number, text] : data_.texts()) {
    if (number >= since) news["elements"][std::to_string(number)] = *text;
    news["used"].push_back(number);
  }
  return news;
}

}  // namespace grit
