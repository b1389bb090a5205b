// series.h5: what the probes said, sample after sample.
#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <vector>

#include "output/hdf5.hpp"
#include "output/writing_mark.hpp"
#include "run/recorder.hpp"

namespace grit {

/// When samples go from memory to the file: after so many numbers, or when a sample comes this long after the last
/// time.
struct Flushing {
  std::size_t numbers = 1 << 16;
  std::chrono::steady_clock::duration interval = std::chrono::seconds(1);
};

/// One group a probe with `time` [s], `step` and one dataset a channel: first dimension the samples, then the channel's
/// shape; attributes `units` (UDUNITS) and `long_name`. While the file is being written, and fits together for nobody,
/// it bears a WritingMark. What was flushed stays readable if the process is killed. If that happens within a flush
/// that opens a new chunk (2048 numbers), the samples of this chunk may be counted but not readable: 7 of 600 writers
/// killed while they did nothing but flush left such a tail. Going on mends it. All functions throw FileError.
class Series {
 public:
  Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes, Flushing flushing = {});
  /// Goes on with a file: of each probe so many samples are kept, later ones are forgotten.
  Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes, std::span<const std::uint64_t> kept,
         Flushing flushing = {});
  /// Closes a file that was not closed, whatever comes of it.
  ~Series();

  /// One sample of the probe with this place in the list; one span a channel.
  void append(std::size_t probe, double time, std::uint64_t step, std::span<const std::span<const double>> values);
  void flush();
  void close();
  /// Of each probe, how many.
  std::vector<std::uint64_t> samples() const;

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

  WritingMark mark_;  ///< before the file, which is opened and closed under it
  hdf5::File file_;
  std::vector<Table> tables_;
  Flushing flushing_;
  std::size_t waiting_ = 0;
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
};

}  // namespace grit
