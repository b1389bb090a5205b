#include "report/live_page.hpp"

#include <spdlog/fmt/fmt.h>

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

/// Differs if something was written in between. Includes the number of frames, as two may be written within the clock
/// resolution.
std::string stamp_of(const path& folder) {
  return stamp_of_file(folder / "run.json") + stamp_of_file(folder / "series.h5") + stamp_of_file(folder / "frames") +
         std::to_string(frame_files(folder).size());
}

// Maximum number of consecutive unreported read errors in a folder that changed during reading.
constexpr int most_slips = 3;

}  // namespace

LivePage::LivePage(path folder, std::string run, const GrainLimits& limits, std::chrono::milliseconds patience)
    : folder_(std::move(folder)),
      run_(std::move(run)),
      limits_(limits),
      patience_(patience),
      content_(empty_content(folder_.filename().string(), "The run is being prepared.")) {
  content_.json["live"] = {{"since", since()}, {"run", run_}};
}

bool LivePage::refresh() {
  const std::string before = stamp_of(folder_);
  const auto has = [&](const char* file) { return std::filesystem::exists(folder_ / file); };
  if (before == stamp_ || !has("run.json") || !has("series.h5")) return false;  // a run that is being prepared
  DataElements data = data_.next();
  ReportContent content;
  try {
    content = report_content(std::span(&folder_, 1), limits_, data, patience_);
  } catch (const std::exception&) {  // files are being replaced
    return false;
  }
  if (content.unsettled) return false;
  if (content.problems.empty()) slips_ = 0;
  else if (stamp_of(folder_) != before && ++slips_ <= most_slips) return false;
  stamp_ = before;
  content_ = std::move(content);
  data_ = std::move(data);
  content_.json["live"] = {{"since", since()}, {"run", run_}};
  return true;
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
