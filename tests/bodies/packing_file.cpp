#include "bodies/packing_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "bodies/random.hpp"
#include "grit/error.hpp"

namespace grit::packing_file_tests {
namespace {

class PackingFile : public testing::Test {
 protected:
  PackingFile()
      : folder_(
            std::filesystem::path(testing::TempDir()) /
            ("packing-" + std::to_string(getpid()) + testing::UnitTest::GetInstance()->current_test_info()->name())),
        path_(folder_ / "grains.txt") {
    std::filesystem::create_directories(folder_);
  }
  ~PackingFile() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  std::vector<Problem> problems(const std::string& text) const {
    write(text);
    try {
      read_packing(path_);
    } catch (const DescriptionError& error) {
      return error.problems();
    }
    return {};
  }

  std::filesystem::path folder_, path_;
};

TEST_F(PackingFile, ReadsLinesCommentsAndBlanks) {
  write("# L 1.089894405e-02\n\n  1e-3 2e-3\t-3e-3 0.5e-3   # the first\r\n \t\n4 5 6 7");
  const auto grains = read_packing(path_);
  ASSERT_EQ(grains.size(), 2u);
  EXPECT_EQ(xyz(grains[0]), Vec3(1e-3, 2e-3, -3e-3));
  EXPECT_EQ(grains[0].w, 0.5e-3);
  EXPECT_EQ(xyz(grains[1]), Vec3(4, 5, 6));
  EXPECT_EQ(grains[1].w, 7);
}

TEST_F(PackingFile, IsReadWhateverItsLineEndsAndByteOrderMark) {
  for (const std::string end : {"\n", "\r\n", "\r"})
    for (const std::string mark : {"", "\xef\xbb\xbf"}) {
      write(mark + "+0.01 0 0 0.005" + end + "# the second" + end + "-0.01 +1e-400 -0 +5e-3" + end);
      const auto grains = read_packing(path_);
      ASSERT_EQ(grains.size(), 2u);
      EXPECT_EQ(xyz(grains[0]), Vec3(0.01, 0, 0));
      EXPECT_EQ(xyz(grains[1]), Vec3(-0.01, 0, 0));
      EXPECT_EQ(grains[1].w, 0.005);
      const auto found = problems(mark + "1 2 3 4" + end + end + "1 2 3" + end);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_EQ(found[0].line, 3);
    }
}

TEST_F(PackingFile, IsReadBackIdentically) {
  Random random(1);
  std::vector<Row> grains;
  const auto number = [&] {  // random bits of a finite number
    for (;;)
      if (const auto x = std::bit_cast<double>(random.bits()); std::isfinite(x)) return x;
  };
  for (int i = 0; i < 20'000; ++i) grains.push_back({number(), number(), number(), std::abs(number())});
  grains.push_back({-0.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max(),
                    std::numeric_limits<double>::min()});
  write_packing(path_, grains, "made by hand\nin two lines");
  const auto read = read_packing(path_);
  ASSERT_EQ(read.size(), grains.size());
  const auto same = [](double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  };
  for (std::size_t i = 0; i < grains.size(); ++i)
    ASSERT_TRUE(same(read[i].x, grains[i].x) && same(read[i].y, grains[i].y) && same(read[i].z, grains[i].z) &&
                same(read[i].w, grains[i].w))
        << i;
}

TEST_F(PackingFile, WritesSeventeenDigitsAndItsComment) {
  const Row grain{0.1, -2, 0, 1e-3};
  write_packing(path_, {&grain, 1}, "of a test");
  std::ifstream file(path_);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(text,
            "# of a test\n# x y z radius, m\n"
            "1.0000000000000001e-01 -2.0000000000000000e+00 0.0000000000000000e+00 1.0000000000000000e-03\n");
  EXPECT_FALSE(std::filesystem::exists(path_.string() + ".part"));
}

TEST_F(PackingFile, HasNoLineOfItsCommentAsABody) {
  const Row grain{1, 2, 3, 4};
  write_packing(path_, {&grain, 1}, "a title\r9 9 9 9\nand\n9 9 9 9");
  EXPECT_EQ(read_packing(path_).size(), 1u);
}

TEST_F(PackingFile, NamesFileAndLineOfEachFault) {
  using namespace std::string_literals;
  const std::string text =
      "# head\n1 2 3 4\n1 2 3\n1 2 x3 4\n1 2 3 4 5\n1 nan 3 4\n1 2 3 inf\n1 2 3 0\n1 2 3 -1e-7\n1e400 2 3 4\n0,01 2 3 "
      "4\n"
      "0.01, 2 3 4\n1 2 3 1mm\n1\0\xff 2 3 4\n1 2 3 1e-400\n"s;
  std::vector<Problem> found = problems(text.substr(0, text.find("0.01,")));
  // More than ten problems are not listed.
  for (const auto& one : problems(std::string(11, '\n') + text.substr(text.find("0.01,")))) found.push_back(one);
  const std::pair<int, const char*> wanted[] = {
      {3, "found 3 columns; expected 4: x y z radius"},
      {4, "z is \"x3\": not a number"},
      {5, "found 5 columns; expected 4: x y z radius"},
      {6, "y is \"nan\": not finite"},
      {7, "radius is \"inf\": not finite"},
      {8, "radius is 0 m; it must be above 0"},
      {9, "radius is -1e-07 m; it must be above 0"},
      {10, "x is \"1e400\": beyond the largest number, 1.8e308"},
      {11, "x is \"0,01\": numbers use a point, not a comma"},
      {12, "x is \"0.01,\": a comma follows the number; separate numbers by blanks"},
      {13, "radius is \"1mm\": text follows the number"},
      {14, "x is \"1\\x00\\xff\": text follows the number"},
      {15, "radius is 0 m; it must be above 0"},
  };
  ASSERT_EQ(found.size(), std::size(wanted));
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].file, path_.string());
    EXPECT_EQ(found[i].line, wanted[i].first);
    EXPECT_EQ(found[i].message, wanted[i].second);
  }
  EXPECT_THAT(DescriptionError(found).what(), testing::StartsWith(path_.string() + ":3: found 3 columns"));
}

TEST_F(PackingFile, ReportsTheFirstErrorsOnly) {
  std::string text;
  for (int i = 0; i < 50; ++i) text += "oops\n";
  const auto found = problems(text);
  ASSERT_EQ(found.size(), 11u);
  EXPECT_EQ(found.back().message, "40 more lines have errors");
}

TEST_F(PackingFile, RefusesAFileWithoutGrains) {
  for (const char* text : {"", "# L 1\n# nothing\n\n"}) {
    const auto found = problems(text);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].message, "contains no grains; write one line per grain: x y z radius, in m");
  }
}

TEST_F(PackingFile, ReportsWhyAFileCannotBeReadOrWritten) {
  const auto message = [](const auto& act) -> std::string {
    try {
      act();
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  };
  const auto missing = folder_ / "nowhere" / "grains.txt";
  EXPECT_EQ(message([&] { read_packing(missing); }), missing.string() + ": cannot be read: No such file or directory");
  EXPECT_EQ(message([&] { read_packing(folder_); }), folder_.string() + ": cannot be read: Is a directory");
  write("\xff\xfe");
  EXPECT_EQ(message([&] { read_packing(path_); }), path_.string() + ": the file is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(message([&] { write_packing(missing, {}); }),
            missing.string() + ".part: cannot write grains: No such file or directory");
  EXPECT_THAT(message([&] { write_packing(folder_, {}); }), testing::HasSubstr("cannot write grains: "));
}

TEST_F(PackingFile, ReportsAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  std::filesystem::create_symlink("/dev/full", path_.string() + ".part");
  const std::vector<Row> grains(1000, Row{1, 2, 3, 4});
  try {
    write_packing(path_, grains);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("No space left on device"));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace grit::packing_file_tests
