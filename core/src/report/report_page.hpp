// A run, or several side by side, as one page.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "output/read_results.hpp"
#include "report/grain_frames.hpp"

namespace grit {

/// What a page shows, its data elements apart.
struct ReportContent {
  std::string title;
  std::string head;  ///< HTML: what ran, how far to trust it, what could not be read
  Description json;  ///< what curves and grains are drawn from; its numbers of data elements are those of `data`
  std::vector<std::string> problems;  ///< what could not be read; the page says so too
  bool unsettled = false;             ///< some of it because a run was writing to it whenever it was looked at
  std::vector<std::string> unread;    ///< why folders hold nothing of a run; the page says so too
  std::filesystem::path first;        ///< folder that does
};

/// Head, curves over each other, grains. Throws FileError where no folder holds anything of a run.
ReportContent report_content(std::span<const std::filesystem::path> folders, const GrainLimits& limits,
                             DataElements& data, std::chrono::milliseconds patience = reader_patience);

/// Of a run that has left nothing yet.
ReportContent empty_content(const std::string& title, const std::string& words);

enum class Reach {
  closed,  ///< fetches nothing, and so can tell nobody that it was opened
  server,  ///< asks where it came from for what is new
};

std::string report_html(const ReportContent& content, const DataElements& data, Reach reach);

struct ReportPage {
  std::string html;
  std::vector<std::string> problems, unread;  ///< as in ReportContent
  std::filesystem::path first;
};

/// The content of the folders as one page that opens from disk. Throws as report_content() does.
ReportPage report_page(std::span<const std::filesystem::path> folders, const GrainLimits& limits = {});

}  // namespace grit
