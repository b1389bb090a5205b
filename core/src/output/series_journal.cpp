#include "output/series_journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "grit/error.hpp"
#include "output/series.hpp"
#include "storage/atomic_file.hpp"

namespace grit {
namespace {

constexpr std::size_t largest_buffer = std::size_t{1} << 20;

int opened(const std::filesystem::path& path, int flags) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | flags, 0666);
  if (file < 0) {
    const int error = errno;
    throw FileError(path.string() + ": cannot open it for writing: " + std::strerror(error) +
                    (error == ENOENT ? "; without it the series cannot be restored to the checkpoint: start again "
                                       "(--overwrite)"
                                     : "; remove the cause, then try again"));
  }
  return file;
}

}  // namespace

SeriesJournal::SeriesJournal(const std::filesystem::path& path) : path_(path), file_(opened(path, O_CREAT | O_TRUNC)) {}

SeriesJournal::SeriesJournal(const std::filesystem::path& path, const Extent& kept)
    : path_(path), file_(opened(path, 0)), kept_(kept) {}

SeriesJournal::~SeriesJournal() { ::close(file_); }

void SeriesJournal::replay(std::span<const ProbeGroup> probes, const Take& take) {
  const auto damaged = [&](const std::string& how) {
    throw FileError(path_.string() + ": " + how +
                    ", so that the series cannot be restored to the checkpoint: the file was replaced or is damaged; "
                    "start again (--overwrite)");
  };
  std::ifstream file(path_, std::ios::binary);
  const auto read = [&](void* target, std::size_t size) {
    if (size > kept_.bytes - bytes_) damaged("ends within a sample");
    if (!file.read(static_cast<char*>(target), static_cast<std::streamsize>(size)))
      damaged("has fewer than the " + std::to_string(kept_.bytes) + " bytes at the checkpoint");
    sum_.process_bytes(target, size);
    bytes_ += size;
  };
  std::vector<double> numbers;
  std::vector<std::span<const double>> values;
  while (bytes_ < kept_.bytes) {
    std::uint64_t head[3];  // probe, time, step
    read(head, sizeof head);
    if (head[0] >= probes.size()) damaged("has a sample of an unknown probe");
    std::size_t width = 0;
    for (const Channel& channel : probes[head[0]].channels) width += hdf5::product(channel.shape);
    numbers.resize(width);
    read(numbers.data(), width * sizeof(double));
    values.clear();
    std::size_t first = 0;
    for (const Channel& channel : probes[head[0]].channels) {
      const std::size_t count = hdf5::product(channel.shape);
      values.emplace_back(numbers.data() + first, count);
      first += count;
    }
    take(head[0], std::bit_cast<double>(head[1]), head[2], values);
  }
  if (sum_.checksum() != kept_.checksum) damaged("has another checksum than at the checkpoint");
}

void SeriesJournal::cut() {
  if (::ftruncate(file_, static_cast<off_t>(kept_.bytes)) != 0) fail("shorten", errno);
}

void SeriesJournal::append(std::size_t probe, double time, std::uint64_t step,
                           std::span<const std::span<const double>> values) {
  const std::uint64_t head[] = {probe, std::bit_cast<std::uint64_t>(time), step};
  put(head, sizeof head);
  for (const auto& numbers : values) put(numbers.data(), numbers.size_bytes());
  if (waiting_.size() >= largest_buffer) flush();
}

void SeriesJournal::put(const void* bytes, std::size_t size) {
  const auto* first = static_cast<const std::byte*>(bytes);
  waiting_.insert(waiting_.end(), first, first + size);
  sum_.process_bytes(bytes, size);
  bytes_ += size;
}

void SeriesJournal::flush() {
  if (!is_still_at(path_, file_))
    throw FileError(path_.string() + ": was removed or replaced during the run, which could not be resumed without it");
  for (std::size_t written = 0; written < waiting_.size();) {
    const ssize_t count = ::write(file_, waiting_.data() + written, waiting_.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("write", errno);
    written += static_cast<std::size_t>(count);
  }
  waiting_.clear();
}

void SeriesJournal::sync() {
  flush();
  if (::fsync(file_) != 0) fail("write", errno);
}

void SeriesJournal::fail(const std::string& what, int error) const {
  throw FileError(path_.string() + ": cannot " + what + ": " + std::strerror(error));
}

void restore_series(SeriesJournal& journal, std::span<const ProbeGroup> probes, std::span<const std::uint64_t> samples,
                    const std::filesystem::path& series) try {
  Series restored(series, probes);
  journal.replay(
      probes, [&](std::size_t probe, double time, std::uint64_t step, std::span<const std::span<const double>> values) {
        restored.append(probe, time, step, values);
      });
  if (!std::ranges::equal(restored.samples(), samples))
    throw FileError(series.string() +
                    ": the journal has other numbers of samples than the checkpoint; start again "
                    "(--overwrite)");
  restored.close();
} catch (...) {
  std::error_code ignored;
  std::filesystem::remove(series, ignored);
  throw;
}

}  // namespace grit
