#include "output/series.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>

#include "folder.hpp"
#include "grit/error.hpp"
#include "output/read_results.hpp"
#include "storage/seal.hpp"
#include "storage/trial.hpp"

namespace grit::series_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<ProbeGroup> probes{
    {"test", {{"stress_ratio", "1", "shear over normal stress", {}}, {"shear_displacement", "m", "of the frame", {}}}},
    {"profile", {{"velocity", "m/s", "by height", {3}}, {"stress", "Pa", "compression positive", {2, 2}}}}};

void append(Series& series, std::uint64_t step) {
  const double s = static_cast<double>(step);
  const double ratio[] = {s}, shear[] = {-s}, velocity[] = {s, s + 1, s + 2}, stress[] = {s, s, s, 2 * s};
  const std::span<const double> test[] = {ratio, shear}, profile[] = {velocity, stress};
  series.append(0, 0.5 * s, step, test);
  if (step % 2 == 0) series.append(1, 0.5 * s, step, profile);
}

TEST(Series, HasAGroupPerProbeAndADatasetPerChannel) {
  const Folder folder;
  Series series(folder / "series.h5", probes);
  for (std::uint64_t step = 0; step < 5; ++step) append(series, step);
  series.close();

  const hdf5::File file(folder / "series.h5", hdf5::Mode::read);
  EXPECT_THAT(file.names(), ElementsAre("profile", "test"));
  const auto test = file.group("test");
  EXPECT_THAT(test.names(), ElementsAre("shear_displacement", "step", "stress_ratio", "time"));
  EXPECT_THAT(test.dataset("time").read<double>(), ElementsAre(0, 0.5, 1, 1.5, 2));
  EXPECT_THAT(test.dataset("step").read<std::uint64_t>(), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(test.dataset("shear_displacement").read<double>(), ElementsAre(0, -1, -2, -3, -4));
  EXPECT_EQ(test.dataset("shear_displacement").text("units"), "m");
  EXPECT_EQ(test.dataset("shear_displacement").text("long_name"), "of the frame");
  EXPECT_EQ(test.dataset("time").text("units"), "s");
  const auto profile = file.group("profile");
  EXPECT_THAT(profile.dataset("step").read<std::uint64_t>(), ElementsAre(0, 2, 4));
  EXPECT_THAT(profile.dataset("velocity").shape(), ElementsAre(3, 3));
  EXPECT_THAT(profile.dataset("stress").shape(), ElementsAre(3, 2, 2));
  EXPECT_THAT(profile.dataset("velocity").read<double>(1, 2), ElementsAre(2, 3, 4, 4, 5, 6));
}

// The reader is a separate process, started before the file is opened: else the library would return the open file.
TEST(Series, CanBeReadWhileItIsWritten) {
  const Folder folder;
  int written[2];
  ASSERT_EQ(pipe(written), 0);
  const pid_t reader = fork();
  if (reader == 0) {
    char word;
    if (::read(written[0], &word, 1) != 1) _exit(2);
    const hdf5::File file(folder / "series.h5", hdf5::Mode::read);
    const auto steps = file.group("test").dataset("step").read<std::uint64_t>();
    _exit(steps == std::vector<std::uint64_t>{7} ? 0 : 1);
  }
  Series series(folder / "series.h5", probes, Flushing{.numbers = 1});
  append(series, 7);
  ASSERT_EQ(::write(written[1], "!", 1), 1);
  int status = 0;
  waitpid(reader, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(Series, ContinuesFromACheckpoint) {
  const Folder folder;
  {
    Series series(folder / "series.h5", probes);
    for (std::uint64_t step = 0; step < 10; ++step) append(series, step);
    series.close();
  }
  const std::vector<std::uint64_t> kept{6, 3};
  {
    Series series(folder / "series.h5", probes, kept);
    EXPECT_EQ(series.samples(), kept);
    for (std::uint64_t step = 6; step < 8; ++step) append(series, 100 * step);
    EXPECT_THAT(series.samples(), ElementsAre(8, 5));
    series.close();
  }
  {
    const hdf5::File file(folder / "series.h5", hdf5::Mode::read);
    EXPECT_THAT(file.group("test").dataset("step").read<std::uint64_t>(), ElementsAre(0, 1, 2, 3, 4, 5, 600, 700));
    EXPECT_THAT(file.group("profile").dataset("step").read<std::uint64_t>(), ElementsAre(0, 2, 4, 600, 700));
  }
  const std::vector<std::uint64_t> too_many{9, 3}, too_few{6};
  EXPECT_THAT(error_of<FileError>([&] { Series(folder / "series.h5", probes, too_many); }),
              testing::AllOf(HasSubstr("series.h5/test/time: has 8 of the 9 samples at the checkpoint"),
                             HasSubstr("--overwrite")));
  EXPECT_THAT(error_of<FileError>([&] { Series(folder / "series.h5", probes, too_few); }),
              HasSubstr("is of a run with 1 probes, but the description has 2"));
  auto other = probes;
  other[1].channels[0].shape = {4};
  EXPECT_THAT(error_of<FileError>([&] { Series(folder / "series.h5", other, kept); }),
              testing::AllOf(HasSubstr("series.h5/profile/velocity"), HasSubstr("another shape")));
}

TEST(Series, ReportsThatItWasRemovedOrReplaced) {
  const Folder folder;
  Series removed(folder / "removed.h5", probes), replaced(folder / "replaced.h5", probes);
  append(removed, 1), append(replaced, 1);
  removed.flush();
  std::filesystem::remove(folder / "removed.h5");
  const auto flush = [&] { removed.flush(); };
  EXPECT_THAT(error_of<FileError>(flush), HasSubstr("removed.h5: was removed or replaced during the run"));
  std::ofstream(folder / "another.h5") << "another";
  std::filesystem::rename(folder / "another.h5", folder / "replaced.h5");
  EXPECT_THAT(error_of<FileError>([&] { replaced.close(); }), HasSubstr("replaced.h5: was removed or replaced"));
  EXPECT_EQ(text_of(folder / "replaced.h5"), "another");
}

TEST(Series, ThatIsCompleteIsRefusedWithAnyFlippedByte) {
  const Folder folder;
  const auto path = folder / "series.h5";
  {
    Series series(path, probes);
    for (std::uint64_t step = 0; step < 5; ++step) append(series, step);
    series.close();
  }
  const auto length = std::filesystem::file_size(path);
  const auto flip = [&](std::uint64_t at) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const char byte = static_cast<char>(file.get() ^ 1 << at % 8);
    file.seekp(static_cast<std::streamoff>(at));
    file.put(byte);
    file.close();
    std::filesystem::last_write_time(path, {});  // it has rested
  };
  for (std::uint64_t at = 0; at + 60 < length; at += at < 500 ? 1 : 997) {
    flip(at);
    EXPECT_THAT(error_of<FileError>([&] { SeriesFile(folder.path()); }), HasSubstr("series.h5: is damaged")) << at;
    flip(at);
  }
  EXPECT_EQ(SeriesFile(folder.path()).channel("test/time").samples, 5u);
  // A run that goes on removes the seal before it writes, and writes another.
  {
    const std::vector<std::uint64_t> kept{5, 3};
    Series series(path, probes, kept);
    EXPECT_FALSE(is_sealed(path));
    append(series, 5);
    series.close();
  }
  EXPECT_TRUE(is_sealed(path));
  EXPECT_EQ(read_channel(folder.path(), "test/time").samples, 6u);
}

TEST(Series, OfARunThatIsDoneHasItsSeal) {
  const Folder folder;
  const auto path = folder / "series.h5";
  {
    Series series(path, probes);
    append(series, 0);
    series.close();
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  std::filesystem::last_write_time(path, {});
  for (const char* status : {"running", "interrupted", "failed"}) {
    std::ofstream(folder / "run.json") << R"({"status": ")" << status << "\"}";
    EXPECT_EQ(SeriesFile(folder.path()).channel("test/time").samples, 1u) << status;
  }
  std::ofstream(folder / "run.json") << R"({"status": "done"})";
  EXPECT_THAT(error_of<FileError>([&] { SeriesFile(folder.path()); }),
              HasSubstr("series.h5: is damaged: its run is done, and the checksum at its end is missing"));
}

TEST(Series, IsNotReadFromANamedPipe) {
  const Folder folder;
  ASSERT_EQ(::mkfifo((folder / "series.h5").c_str(), 0600), 0);
  EXPECT_THAT(error_of<FileError>([&] { read_channel(folder.path(), "test/time"); }),
              HasSubstr("series.h5: is not a file"));
}

// What libhdf5 did at damaged files: a crash, an abort, an endless loop.
TEST(Trial, OfAReaderThatCrashesIsAnError) {
  const auto error = [](const std::function<void()>& read) {
    return error_of<FileError>([&] { try_in_child("series.h5", 1, read); });
  };
  const char* words = "series.h5: is damaged: the HDF5 library crashes at it, or does not finish";
  EXPECT_EQ(error([] { ::raise(SIGSEGV); }), words);
  EXPECT_EQ(error([] { std::abort(); }), words);
  EXPECT_EQ(error([] {
              for (volatile bool on = true; on;) {
              }
            }),
            words);
  bool here = false;
  EXPECT_NO_THROW(try_in_child("series.h5", 1, [&] { here = true; }));
  EXPECT_FALSE(here) << "in another process";
  EXPECT_NO_THROW(try_in_child("series.h5", 1, [] { throw FileError("which the reader meets again"); }));
}

// A child process writes and reports the number of samples after each flush; it is killed in between.
TEST(Series, SurvivesSigkill) {
  const Folder folder;
  for (int attempt = 0; attempt < 30; ++attempt) {
    const auto path = folder / (std::to_string(attempt) + ".h5");
    int flushed[2];
    ASSERT_EQ(pipe(flushed), 0);
    const pid_t writer = fork();
    if (writer == 0) {
      Series series(path, probes, Flushing{.numbers = 1 << 30, .interval = std::chrono::hours(1)});
      for (std::uint64_t step = 0;; ++step) {
        append(series, step);
        if (step % 100 < 99) continue;
        series.flush();
        const std::uint64_t samples = step + 1;
        if (::write(flushed[1], &samples, sizeof samples) < 0) _exit(1);
      }
    }
    close(flushed[1]);
    std::uint64_t samples = 0;
    for (int reports = 0; reports < 3 + 2 * attempt; ++reports)
      ASSERT_EQ(read(flushed[0], &samples, sizeof samples), static_cast<ssize_t>(sizeof samples));
    kill(writer, SIGKILL);
    while (read(flushed[0], &samples, sizeof samples) > 0) {
    }
    close(flushed[0]);
    waitpid(writer, nullptr, 0);

    const hdf5::File file(path, hdf5::Mode::read);
    const auto ratio = file.group("test").dataset("stress_ratio");
    ASSERT_GE(ratio.rows(), samples);
    const auto values = ratio.read<double>(0, samples);
    for (std::uint64_t i = 0; i < samples; ++i) ASSERT_EQ(values[i], static_cast<double>(i)) << "of " << samples;
    ASSERT_GE(file.group("profile").dataset("velocity").rows(), samples / 2);
  }
}

}  // namespace
}  // namespace grit::series_tests
