// series.journal: the samples of a run that is not complete, from which its series are restored.
#pragma once

#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "grit/archive.hpp"
#include "run/recorder.hpp"

namespace grit {

/// The samples of all probes in the order in which they were taken. The file only grows, so that what was brought to
/// disk once stays whole. HDF5 changes series.h5 in place instead, which may be torn if the run is killed, the disk is
/// full or the machine stops. A sample is the index of its probe, time, step and values, 8 bytes each. All functions
/// throw FileError.
class SeriesJournal {
 public:
  /// A part of the file from its beginning.
  struct Extent {
    std::uint64_t bytes = 0;
    std::uint32_t checksum = 0;  ///< CRC-32 of these bytes
    void serialize(Archive& archive) { archive(bytes, checksum); }
  };
  using Take = std::function<void(std::size_t probe, double time, std::uint64_t step,
                                  std::span<const std::span<const double>> values)>;

  /// An empty one, which replaces the file.
  explicit SeriesJournal(const std::filesystem::path& path);
  /// Opens one to continue from an extent of it. Nothing is changed before cut().
  SeriesJournal(const std::filesystem::path& path, const Extent& kept);
  ~SeriesJournal();
  SeriesJournal(const SeriesJournal&) = delete;
  SeriesJournal& operator=(const SeriesJournal&) = delete;

  /// Reads the samples that are kept.
  void replay(std::span<const ProbeGroup> probes, const Take& take);
  /// Removes what follows them. Call it after replay().
  void cut();

  /// Appends a sample of the probe with this index; one span per channel.
  void append(std::size_t probe, double time, std::uint64_t step, std::span<const std::span<const double>> values);
  void flush();
  /// Flushes, and returns when all samples are on disk.
  void sync();
  Extent extent() const { return {bytes_, sum_.checksum()}; }

 private:
  void put(const void* bytes, std::size_t size);
  [[noreturn]] void fail(const std::string& what, int error) const;

  std::filesystem::path path_;
  int file_;
  Extent kept_;
  std::uint64_t bytes_ = 0;
  boost::crc_32_type sum_;
  std::vector<std::byte> waiting_;
};

/// Writes a file of the samples that a journal keeps, `samples` of each probe, and brings it to disk. On failure there
/// is no such file.
void restore_series(SeriesJournal& journal, std::span<const ProbeGroup> probes, std::span<const std::uint64_t> samples,
                    const std::filesystem::path& series);

}  // namespace grit
