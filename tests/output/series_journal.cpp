// Series are restored from their journal, whatever state they are in.
#include "output/series_journal.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "folder.hpp"
#include "grit/error.hpp"
#include "output/series.hpp"

namespace grit::series_journal_tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::vector<ProbeGroup> probes{
    {"test", {{"stress_ratio", "1", "shear over normal stress", {}}}},
    {"profile", {{"velocity", "m/s", "by height", {3}}, {"stress", "Pa", "compression positive", {2, 2}}}}};

void append(SeriesJournal& journal, std::uint64_t step) {
  const double s = static_cast<double>(step);
  const double ratio[] = {s}, velocity[] = {s, s + 1, s + 2}, stress[] = {s, s, s, 2 * s};
  const std::span<const double> test[] = {ratio}, profile[] = {velocity, stress};
  journal.append(0, 0.5 * s, step, test);
  if (step % 2 == 0) journal.append(1, 0.5 * s, step, profile);
}

class Journal : public testing::Test {
 protected:
  /// A journal of five steps, and a later part that is cut off within a sample.
  Journal() {
    SeriesJournal journal(path);
    for (std::uint64_t step = 0; step < 5; ++step) append(journal, step);
    journal.sync();
    kept = journal.extent();
    for (std::uint64_t step = 5; step < 9; ++step) append(journal, step);
    journal.flush();
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 5);
  }
  void restore() const {
    SeriesJournal journal(path, kept);
    restore_series(journal, probes, samples, series);
  }
  std::string refusal() const {
    return error_of<FileError>([this] { restore(); });
  }
  std::vector<std::uint64_t> steps(const char* probe) const {
    return hdf5::File(series, hdf5::Mode::read).group(probe).dataset("step").read<std::uint64_t>();
  }

  const Folder folder;
  const std::filesystem::path path = folder / "series.journal", series = folder / "restored.h5";
  SeriesJournal::Extent kept;
  std::vector<std::uint64_t> samples{5, 3};
};

TEST_F(Journal, RestoresTheSamplesThatAreKept) {
  restore();
  EXPECT_THAT(steps("test"), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(steps("profile"), ElementsAre(0, 2, 4));
  const hdf5::File file(series, hdf5::Mode::read);
  EXPECT_THAT(file.group("profile").dataset("stress").read<double>(2, 1), ElementsAre(4, 4, 4, 8));
  EXPECT_THAT(file.group("profile").dataset("time").read<double>(), ElementsAre(0, 1, 2));
}

TEST_F(Journal, ContinuesBehindThem) {
  {
    SeriesJournal journal(path, kept);
    restore_series(journal, probes, samples, series);
    journal.cut();
    for (std::uint64_t step = 105; step < 107; ++step) append(journal, step);
    journal.sync();
    kept = journal.extent(), samples = {7, 4};
  }
  restore();
  EXPECT_THAT(steps("test"), ElementsAre(0, 1, 2, 3, 4, 105, 106));
  EXPECT_THAT(steps("profile"), ElementsAre(0, 2, 4, 106));
}

TEST_F(Journal, RefusesAnotherContentAndChangesNothing) {
  const std::string whole = text_of(path);
  const auto set = [&](const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; };
  for (std::size_t at = 0; at < kept.bytes; at += 7) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    set(changed);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("series.journal: "), HasSubstr("--overwrite"))) << at;
    EXPECT_EQ(text_of(path), changed);
    EXPECT_FALSE(std::filesystem::exists(series)) << at;
  }
  set(whole.substr(0, kept.bytes - 1));
  EXPECT_THAT(refusal(), HasSubstr("bytes at the checkpoint"));
  set(whole);
  samples = {5, 2};
  EXPECT_THAT(refusal(), HasSubstr("other numbers of samples"));
  std::filesystem::remove(path);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("series.journal: cannot open"), HasSubstr("start again (--overwrite)")));
}

// The samples are not lost: it may be on a disk that is read-only for now.
TEST_F(Journal, ThatCannotBeOpenedIsNoReasonToStartAgain) {
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("series.journal: cannot open it for writing: "),
                               HasSubstr("; remove the cause, then try again"), Not(HasSubstr("--overwrite"))));
}

TEST_F(Journal, ReportsThatItWasRemoved) {
  SeriesJournal journal(folder / "other");
  append(journal, 1);
  std::filesystem::remove(folder / "other");
  EXPECT_THAT(error_of<FileError>([&] { journal.flush(); }),
              HasSubstr("other: was removed or replaced during the run"));
}

}  // namespace
}  // namespace grit::series_journal_tests
