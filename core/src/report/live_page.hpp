// The page of a run that goes on: first whole, then what is new again and again.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "report/report_page.hpp"

namespace grit {

/// What the folder of a run shows now. Only reads; the run need not know of it.
class LivePage {
 public:
  /// `run` tells runs apart that are shown one after the other at one place.
  LivePage(std::filesystem::path folder, std::string run, const GrainLimits& limits = {.bytes = 24u << 20},
           std::chrono::milliseconds patience = std::chrono::seconds(1));

  /// Reads the folder if its files have changed. Returns whether there is news. What was being written all the time, or
  /// could not be read in a folder that changed meanwhile, leaves the page as it is until the next time; if the latter
  /// lasts, it is told.
  bool refresh();
  /// The whole page; it asks `new?since=…` beside it for more.
  std::string html() const;
  /// For a page of which data elements below `since` are known:
  ///   run                whether it is still the same
  ///   since, head, report, elements, used    only where there is news: what to ask for next; HTML; JSON as in the
  ///   page;
  ///                      {number: text}; numbers of all elements of this JSON
  Description news(std::size_t since) const;
  /// What a page that has everything asks for.
  std::size_t since() const { return data_.end(); }

 private:
  std::filesystem::path folder_;
  std::string run_, stamp_;
  GrainLimits limits_;
  std::chrono::milliseconds patience_;
  int slips_ = 0;
  DataElements data_;
  ReportContent content_;
};

}  // namespace grit
