// A run, or several side by side, as one page that opens from disk: nothing is fetched.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "report/grain_frames.hpp"

namespace grit {

struct ReportPage {
  std::string html;
  std::vector<std::string> problems;  ///< what could not be read; the page says so too
};

/// Head, curves over each other, grains. Throws FileError for a folder that holds nothing of a run.
ReportPage report_page(std::span<const std::filesystem::path> folders, const GrainLimits& limits = {});

}  // namespace grit
