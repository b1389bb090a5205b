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

/// The content of a page, without its data elements.
struct ReportContent {
  std::string title;
  std::string head;                   ///< HTML: run, reliability, unreadable files
  Description json;                   ///< of curves and grains; its numbers of data elements refer to `data`
  std::vector<std::string> problems;  ///< unreadable files; also on the page
  bool unsettled = false;             ///< a run was writing to some of them at each attempt to read
  std::vector<std::string> unread;    ///< folders without a run, and why; also on the page
  std::filesystem::path first;        ///< first folder with a run
};

/// Head, curves, grains. Throws FileError if no folder holds a run.
ReportContent report_content(std::span<const std::filesystem::path> folders, const GrainLimits& limits,
                             DataElements& data, std::chrono::milliseconds patience = reader_patience);

/// Of a run without results yet.
ReportContent empty_content(const std::string& title, const std::string& words);

enum class Reach {
  closed,  ///< fetches nothing: no request leaves the reader's machine
  server,  ///< requests updates from its server
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
