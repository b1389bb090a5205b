// Every state of series.h5 that a reader can find while it is being written: after each system call of the writer.
#include <gmock/gmock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <functional>
#include <future>

#include "folder.hpp"
#include "output/read_results.hpp"
#include "output/series.hpp"
#include "output/writing_mark.hpp"

namespace {
std::function<void()> after_each_write;
}

// HDF5 calls these instead of the system's.
extern "C" ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  const auto written = syscall(SYS_pwrite64, file, bytes, size, at);
  if (after_each_write) after_each_write();
  return written;
}

extern "C" int ftruncate(int file, off_t size) noexcept {
  const auto result = static_cast<int>(syscall(SYS_ftruncate, file, size));
  if (after_each_write) after_each_write();
  return result;
}

namespace grit::series_being_written_tests {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

const std::vector<ProbeGroup> probes{
    {"test", {{"stress_ratio", "1", "shear over normal stress", {}}, {"shear_displacement", "m", "of the frame", {}}}},
    {"profile", {{"velocity", "m/s", "by height", {3}}}}};

/// Sample s is s everywhere.
void append(Series& series, std::uint64_t sample) {
  const double s = static_cast<double>(sample), ratio[] = {s}, shear[] = {s}, velocity[] = {s, s, s};
  const std::span<const double> test[] = {ratio, shear}, profile[] = {velocity};
  series.append(0, s, sample, test);
  series.append(1, s, sample, profile);
}

/// Sets the file time an hour back: readers wait until a file has rested.
void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - 1h);
}

/// Why the file is not the result of a flush; empty if it is.
std::string torn(const std::filesystem::path& folder) {
  try {
    const SeriesFile series(folder);
    std::optional<std::size_t> samples;
    for (const auto& name : series.channels()) {
      const auto channel = series.channel(name);
      if (samples.value_or(channel.samples) != channel.samples) return "as many samples as a flush of another channel";
      samples = channel.samples;
      const auto width = channel.values.size() / std::max<std::size_t>(1, channel.samples);
      for (std::size_t i = 0; i < channel.values.size(); ++i)
        if (channel.values[i] != static_cast<double>(i / width)) return "numbers that were never written";
    }
    return samples ? "" : "no channel";
  } catch (const FileError& error) {
    return error.what();
  }
}

/// The bytes of a file with so many samples.
std::string series_of(const Folder& folder, std::uint64_t samples) {
  const auto path = folder / "whole.h5";
  Series series(path, probes);
  for (std::uint64_t i = 0; i < samples; ++i) append(series, i);
  series.close();
  return text_of(path);
}

TEST(SeriesBeingWritten, IsMarkedWheneverItIsInconsistent) {
  const Folder folder;
  const auto path = folder / "series.h5";
  struct State {
    std::string bytes;
    bool marked;
  };
  std::vector<State> states;
  const auto look = [&] { states.push_back({text_of(path), is_being_written(path)}); };
  after_each_write = look;
  constexpr std::uint64_t chunk = 2048;
  {
    Series series(path, probes, Flushing{.numbers = 1 << 30, .interval = 24h});
    look();
    // Within the first chunk, past it, and past that of the vectors.
    for (std::uint64_t sample = 0; sample < chunk + 300; ++sample) {
      append(series, sample);
      if (sample % 500 == 499) series.flush(), look();
    }
  }  // not closed
  const std::vector<std::uint64_t> kept(2, 1500);
  Series again(path, probes, kept);
  look();
  append(again, 1500);
  again.close();
  look();
  after_each_write = nullptr;

  std::vector<std::string> faults;
  std::size_t rests = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto copy = folder / std::to_string(i);
    write_file(copy / "series.h5", states[i].bytes);
    const std::string fault = torn(copy);
    EXPECT_TRUE(fault.empty() || states[i].marked) << "state " << i << " of " << states.size() << ": " << fault;
    if (!fault.empty()) faults.push_back(fault);
    if (!states[i].marked) ++rests;
  }
  EXPECT_EQ(rests, 7u) << "number of flushes";
  // As readers used to meet them.
  EXPECT_THAT(faults, AllOf(Contains(HasSubstr("truncated file")), Contains(HasSubstr("bad object header")),
                            Contains("numbers that were never written"),
                            Contains("as many samples as a flush of another channel")));
}

TEST(SeriesBeingWritten, IsWaitedFor) {
  const Folder folder;
  const std::string whole = series_of(folder, 10);
  const auto path = folder / "series.h5";
  write_file(path, whole.substr(0, whole.size() / 2));
  std::future<SampledChannel> read;
  {
    const WritingMark mark(path, WritingMark::Absent::leave);
    EXPECT_THAT(error_of<BeingWritten>([&] { SeriesFile(folder.path(), 0ms); }),
                HasSubstr("series.h5: has been written to for 0 s; try again"));
    read = std::async(std::launch::async, [&] { return SeriesFile(folder.path(), 10min).channel("test/time"); });
    write_file(path, whole);
  }
  EXPECT_EQ(read.get().samples, 10u);
}

TEST(SeriesBeingWritten, IsReportedAsTruncatedWithoutAWriter) {
  const Folder folder;
  const std::string whole = series_of(folder, 3000);
  const auto path = folder / "series.h5";
  constexpr std::size_t places = 150;
  for (std::size_t i = 0; i < places; ++i) {
    const std::size_t length = i < places / 3 ? 30 * i : whole.size() * i / places;
    write_file(path, whole.substr(0, length));
    EXPECT_THAT(error_of<FileError>([&] { SeriesFile(folder.path(), 10min); }), HasSubstr("series.h5: cannot read: "))
        << "cut off at " << length;
  }
  write_file(path, whole);
  EXPECT_EQ(torn(folder.path()), "");
}

TEST(WritingMark, EndsWithItsWriter) {
  const Folder folder;
  const auto path = folder / "file";
  EXPECT_FALSE(is_being_written(path));
  {
    const WritingMark none(path, WritingMark::Absent::leave);
    EXPECT_FALSE(std::filesystem::exists(path));
    const WritingMark mark(path, WritingMark::Absent::make);
    EXPECT_TRUE(is_being_written(path));
    mark.clear();
    EXPECT_FALSE(is_being_written(path));
    mark.set();
    text_of(path);  // closing another descriptor does not end it
    EXPECT_TRUE(is_being_written(path));
  }
  EXPECT_FALSE(is_being_written(path));
}

}  // namespace
}  // namespace grit::series_being_written_tests
