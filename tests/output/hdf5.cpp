#include "storage/hdf5.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <new>

#include "folder.hpp"
#include "grit/error.hpp"

namespace grit::hdf5_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Hdf5, ReadsBackWhatItWrote) {
  const Folder folder;
  {
    hdf5::File file(folder / "a.h5", hdf5::Mode::replace);
    file.set_attribute("stage", "shear");
    file.set_attribute("step", std::uint64_t{1} << 60);
    file.set_attribute("stage", "dense sand: φ");  // replaces
    file.set_attribute("nothing", "");
    auto group = file.create_group("g");
    const std::vector<double> numbers{1, 2, 3, 4, 5, 6};
    group.write("table", {2, 3}, std::span(numbers)).set_attribute("factor", 0.1);
    const std::vector<std::int64_t> ids{-1, std::int64_t{1} << 40};
    group.write("ids", {2}, std::span(ids));
    group.write("empty", {0, 3}, std::span<const double>());
    file.close();
  }
  const hdf5::File file(folder / "a.h5", hdf5::Mode::read);
  EXPECT_EQ(file.text("stage"), "dense sand: φ");
  EXPECT_EQ(file.text("nothing"), "");
  EXPECT_EQ(file.number<std::uint64_t>("step"), std::uint64_t{1} << 60);
  const auto group = file.group("g");
  EXPECT_THAT(group.names(), ElementsAre("empty", "ids", "table"));
  EXPECT_THAT(group.dataset("table").shape(), ElementsAre(2, 3));
  EXPECT_THAT(group.dataset("table").read<double>(), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(group.dataset("table").read<std::int32_t>(1, 1), ElementsAre(4, 5, 6));
  EXPECT_EQ(group.dataset("table").number<double>("factor"), 0.1);
  EXPECT_THAT(group.dataset("ids").read<std::int64_t>(), ElementsAre(-1, std::int64_t{1} << 40));
  EXPECT_THAT(group.dataset("empty").shape(), ElementsAre(0, 3));
  EXPECT_FALSE(file.has("h"));
}

TEST(Hdf5, GrowsAndShortens) {
  const Folder folder;
  hdf5::File file(folder / "a.h5", hdf5::Mode::replace);
  auto rows = file.create_growing<double>("rows", {2}, 3);
  for (int i = 0; i < 10; ++i) {
    const double row[] = {i + 0.0, i + 0.5};
    rows.append(std::span<const double>(row));
  }
  EXPECT_THAT(rows.shape(), ElementsAre(10, 2));
  rows.truncate(4);
  const double row[] = {40, 41};
  rows.append(std::span<const double>(row));
  EXPECT_THAT(rows.read<double>(), ElementsAre(0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 40, 41));
}

TEST(Hdf5, ReportsFaultsOfAFile) {
  const Folder folder;
  EXPECT_THAT(error_of<FileError>([&] { hdf5::File(folder / "none.h5", hdf5::Mode::read); }),
              testing::AllOf(HasSubstr("none.h5: cannot read: "), HasSubstr("No such file or directory")));
  EXPECT_THAT(error_of<FileError>([&] { hdf5::File(folder / "no/folder.h5", hdf5::Mode::replace); }),
              testing::AllOf(HasSubstr("no/folder.h5: cannot create: "), HasSubstr("No such file or directory")));
  std::ofstream(folder / "text.h5") << "not HDF5";
  EXPECT_THAT(error_of<FileError>([&] { hdf5::File(folder / "text.h5", hdf5::Mode::read); }),
              HasSubstr("file signature not found"));
  hdf5::File file(folder / "a.h5", hdf5::Mode::replace);
  EXPECT_THAT(error_of<FileError>([&] { file.dataset("x"); }), HasSubstr("a.h5/x: cannot open: "));
  file.create_group("g");
  EXPECT_THAT(error_of<FileError>([&] { file.create_group("g"); }), HasSubstr("name already exists"));
  const double three[] = {1, 2, 3};
  EXPECT_THAT(error_of<FileError>([&] {
                file.write("w", {2, 2}, std::span<const double>(three));
              }),
              HasSubstr("cannot write 3 numbers into a shape of 4"));
  auto rows = file.create_growing<double>("rows", {2}, 3);
  EXPECT_THAT(error_of<FileError>([&] { rows.append(std::span<const double>(three)); }), HasSubstr("a row has 2"));
}

TEST(Hdf5, RefusesWhatItDoesNotWrite) {
  const Folder folder;
  hdf5::File file(folder / "a.h5", hdf5::Mode::write_whole);
  const double three[] = {1, 2, 3};
  auto list = file.write("list", {3}, std::span<const double>(three));
  list.set_attribute("text", "m");
  list.set_attribute("number", 0.1);
  EXPECT_THAT(error_of<FileError>([&] { list.text("number"); }),
              HasSubstr("a.h5/list: attribute 'number' is not a text"));
  EXPECT_THAT(error_of<FileError>([&] { list.number<double>("text"); }),
              HasSubstr("a.h5/list: attribute 'text' is not a number"));
  EXPECT_THAT(error_of<FileError>([&] { list.read<double>(2, 2); }), HasSubstr("has 3 rows, but rows up to 4"));
  list.set_attribute("text", "\xff");
  EXPECT_THAT(error_of<FileError>([&] { list.text("text"); }), HasSubstr("attribute 'text' is not UTF-8"));
  auto rows = file.create_growing<double>("rows", {2}, 3);
  rows.truncate(std::size_t{1} << 50);  // without any chunk
  EXPECT_THAT(error_of<FileError>([&] { rows.read<double>(); }),
              HasSubstr("a.h5/rows: has more numbers than a file of "));
  std::filesystem::create_directory(folder / "folder.h5");
  EXPECT_THAT(error_of<FileError>([&] { hdf5::File(folder / "folder.h5", hdf5::Mode::read); }),
              HasSubstr("folder.h5: is not a file"));
}

TEST(Hdf5, FindsDamagedNumbers) {
  const Folder folder;
  const auto path = folder / "a.h5";
  {
    hdf5::File file(path, hdf5::Mode::write_whole);
    const std::vector<double> many(5000, 1.5);
    file.write("many", {1000, 5}, std::span(many));
    file.close();
  }
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(path) / 2));
  file.put('!');
  file.close();
  EXPECT_THAT(error_of<FileError>([&] { hdf5::File(path, hdf5::Mode::read_whole).dataset("many").read<double>(); }),
              HasSubstr("a.h5/many: cannot read: "));
}

// A limit on file size replaces a full disk: write() fails in the same way.
TEST(Hdf5, ReportsAFullDisk) {
  const Folder folder;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1 << 16;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string text;
  {
    hdf5::File file(folder / "a.h5", hdf5::Mode::replace);
    const std::vector<double> many(1 << 16, 1.0);
    text = error_of<FileError>([&] {
      file.write("many", {many.size()}, std::span(many));
      file.close();
    });
    setrlimit(RLIMIT_FSIZE, &before);
  }
  signal(SIGXFSZ, handler);
  EXPECT_THAT(text, testing::AllOf(HasSubstr("a.h5"), HasSubstr("cannot write: "), HasSubstr("File too large")));
}

/// No work begins, and what is open can be closed: libhdf5 may crash where memory ends.
TEST(Hdf5, BeginsNothingWithoutMemory) {
  const Folder folder;
  const std::vector<double> many(1000, 1.0);
  hdf5::File(folder / "whole.h5", hdf5::Mode::replace).write("many", {many.size()}, std::span(many));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit small = before;
  small.rlim_cur = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + (std::size_t{1} << 20);
  {
    hdf5::File file(folder / "a.h5", hdf5::Mode::replace), whole(folder / "whole.h5", hdf5::Mode::read);
    auto growing = file.create_growing<double>("growing", {}, 100);
    const auto written = whole.dataset("many");
    ASSERT_EQ(setrlimit(RLIMIT_AS, &small), 0);
    EXPECT_THROW(file.write("many", {many.size()}, std::span(many)), std::bad_alloc);
    // The first failure left memory to close files; it is taken here.
    std::size_t now = 0;
    std::ifstream("/proc/self/statm") >> now;
    EXPECT_LT(now, pages);
    small.rlim_cur = now * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + (std::size_t{1} << 20);
    ASSERT_EQ(setrlimit(RLIMIT_AS, &small), 0);
    EXPECT_THROW(growing.append(std::span(many)), std::bad_alloc);
    EXPECT_THROW(written.read<double>(), std::bad_alloc);
    EXPECT_THROW(file.flush(), std::bad_alloc);
    EXPECT_THROW(file.close(), std::bad_alloc);
    EXPECT_THROW(hdf5::File(folder / "b.h5", hdf5::Mode::replace), std::bad_alloc);
    setrlimit(RLIMIT_AS, &before);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "b.h5"));
}

}  // namespace
}  // namespace grit::hdf5_tests
