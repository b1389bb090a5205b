// The page of a run in progress: first complete, then updates.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "report/report_page.hpp"

namespace grit {

/// The present content of the folder of a run. Only reads it.
class LivePage {
 public:
  /// `run` identifies a run among those served one after the other at the same address.
  LivePage(std::filesystem::path folder, std::string run, const GrainLimits& limits = {.bytes = 24u << 20},
           std::chrono::milliseconds patience = std::chrono::seconds(1));

  /// Reads the folder if its files have changed. Returns whether the page changed. Files that were being written, or
  /// were unreadable while the folder changed, leave the page unchanged until the next call; if the latter persists,
  /// the page reports it.
  bool refresh();
  /// The complete page; it requests updates from `new?since=…`, relative to its address.
  std::string html() const;
  /// The update of a page that has the data elements below `since`:
  ///   run                identifies the run
  ///   since, head, report, elements, used    only if there are changes: the next `since`; HTML; JSON as
  ///                      in the page; {number: text}; numbers of all elements of this JSON
  Description news(std::size_t since) const;
  /// `since` of a page that is up to date.
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
