// series.h5: the samples of all probes.
#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <vector>

#include "output/writing_mark.hpp"
#include "run/recorder.hpp"
#include "storage/hdf5.hpp"

namespace grit {

/// When samples are flushed to the file: after so many values, or with the first sample after this interval.
struct Flushing {
  std::size_t numbers = 1 << 16;
  std::chrono::steady_clock::duration interval = std::chrono::seconds(1);
};

/// Columns that each probe has before its channels.
inline const Channel time_column{"time", "s", "simulated time since the start of the run", {}},
    step_column{"step", "1", "steps since the start of the run", {}};

/// One group per probe with `time` [s], `step` and one dataset per channel: first dimension the samples, then the
/// channel's shape; attributes `units` (UDUNITS) and `long_name`. During a flush, when the file is temporarily
/// inconsistent, it has a WritingMark. Flushed samples stay readable if the process is killed. If it is killed during a
/// flush that opens a new chunk (2048 values), the samples of this chunk may be counted but unreadable: 7 of 600
/// writers that were killed while flushing continuously left such a tail. Resuming the run restores the file from its
/// SeriesJournal. All functions throw FileError, also if the file was removed or replaced meanwhile.
class Series {
 public:
  Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes, Flushing flushing = {});
  /// Continues a file: keeps so many samples of each probe and removes later ones.
  Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes, std::span<const std::uint64_t> kept,
         Flushing flushing = {});
  /// Closes the file if close() was not called, ignoring errors.
  ~Series();

  /// Appends a sample of the probe with this index; one span per channel.
  void append(std::size_t probe, double time, std::uint64_t step, std::span<const std::span<const double>> values);
  void flush();
  /// Writes what remains, and seals the file: then any damaged byte is found when it is read.
  void close();
  /// Number of samples of each probe.
  std::vector<std::uint64_t> samples() const;
  /// Throws FileError if it is not the file at its path any more: samples would be lost without a word.
  void expect_own_file() const;

 private:
  struct Column {
    hdf5::Dataset dataset;
    std::vector<double> waiting;
  };
  struct Table {
    hdf5::Dataset time, step;
    std::vector<double> waiting_times;
    std::vector<std::uint64_t> waiting_steps;
    std::vector<Column> columns;
    std::uint64_t samples = 0;
  };

  Table create(const ProbeGroup& probe);
  Table reopen(const ProbeGroup& probe, std::uint64_t samples);
  void write();

  std::filesystem::path path_;
  WritingMark mark_;  ///< outlives the file, which is opened and closed while marked
  hdf5::File file_;
  std::vector<Table> tables_;
  Flushing flushing_;
  std::size_t waiting_ = 0;
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
};

}  // namespace grit
