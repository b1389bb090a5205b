#include "grit/toolkit/text_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <clocale>
#include <cmath>
#include <filesystem>
#include <limits>

#include "grit/error.hpp"
#include "support/own_folder.hpp"

namespace grit::text_file_tests {
namespace {

using namespace std::literals;
using testing::ThrowsMessage;

std::string plain(const std::string& bytes) { return plain_text(bytes, "test"); }

TEST(TextFile, HasTheSameLinesWhateverTheirEnds) {
  EXPECT_EQ(plain("a\nb\n\nc\n"), "a\nb\n\nc\n");
  EXPECT_EQ(plain("a\r\nb\r\n\r\nc\r\n"), "a\nb\n\nc\n");
  EXPECT_EQ(plain("a\rb\r\rc\r"), "a\nb\n\nc\n");
  EXPECT_EQ(plain("a\r\nb\rc\n\rd\r\r\ne"), "a\nb\nc\n\nd\n\ne");
  EXPECT_EQ(plain(""), "");
  EXPECT_EQ(plain("\r"), "\n");
  EXPECT_EQ(plain("a\0\r\nb"s), "a\0\nb"s);
}

TEST(TextFile, HasNoByteOrderMark) {
  EXPECT_EQ(plain("\xef\xbb\xbf"
                  "a\r\n"),
            "a\n");
  EXPECT_EQ(plain("\xef\xbb\xbf"), "");
  EXPECT_EQ(plain("\xef\xbb"), "\xef\xbb");
  EXPECT_EQ(plain("a\xef\xbb\xbf"), "a\xef\xbb\xbf") << "only at the beginning";
}

TEST(TextFile, RefusesUtf16) {
  for (const std::string& bytes : {"\xff\xfe"
                                   "1\0\n\0"s,
                                   "\xfe\xff\0001\0\n"s}) {
    EXPECT_TRUE(is_utf16(bytes));
    EXPECT_THAT([&] { plain_text(bytes, "grains.txt"); },
                ThrowsMessage<FileError>("grains.txt: the file is UTF-16 text; save it as UTF-8"));
  }
  EXPECT_FALSE(is_utf16("\xff"));
  EXPECT_FALSE(is_utf16(""));
}

TEST(TextFile, IsReadAsAWhole) {
  const OwnFolder folder;
  std::string text(3'000'000, 'x');
  text += "\r\nend\0"s;
  EXPECT_EQ(read_text(folder.write("large.txt", text)), std::string(3'000'000, 'x') + "\nend\0"s);
  std::string fault = "another";
  EXPECT_EQ(read_bytes(folder.write("small.txt", "\xef\xbb\xbf\r\n"), fault), "\xef\xbb\xbf\r\n") << "as they are";
  EXPECT_EQ(fault, "");
}

TEST(TextFile, ThatCannotBeReadIsReportedWithTheReason) {
  const OwnFolder folder;
  const std::string missing = folder / "nowhere.txt", path = folder.path();
  EXPECT_THAT([&] { read_text(missing); },
              ThrowsMessage<FileError>(missing + ": cannot be read: No such file or directory"));
  EXPECT_THAT([&] { read_text(path); }, ThrowsMessage<FileError>(path + ": cannot be read: Is a directory"));
  std::string fault;
  EXPECT_EQ(read_bytes(missing, fault), "");
  EXPECT_EQ(fault, "No such file or directory");
}

/// None of them may stop the program or fill its memory.
TEST(TextFile, IsNoDeviceAndNoNamedPipe) {
  const OwnFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const auto& [path, is] :
       {std::pair(pipe, "named pipe"), std::pair("/dev/zero"s, "device"), std::pair("/dev/tty0"s, "device")}) {
    if (!std::filesystem::exists(path)) continue;
    std::string fault;
    EXPECT_EQ(read_bytes(path, fault), "") << path;
    if (path != "/dev/tty0") EXPECT_EQ(fault, "it is a "s + is + "; allowed are regular files");
    EXPECT_NE(fault, "") << path;
  }
}

TEST(TextFile, MayBePiped) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], "a\r\nb", 4), 4);
  ::close(ends[1]);
  EXPECT_EQ(read_text("/dev/fd/" + std::to_string(ends[0])), "a\nb");
  ::close(ends[0]);
}

/// A sparse file, which takes no disk.
TEST(TextFile, IsNotLargerThanTheMemoryThatIsAvailable) {
  const OwnFolder folder;
  const auto path = folder.write("huge.txt", "1");
  std::error_code error;
  std::filesystem::resize_file(path, std::uintmax_t{1} << 42, error);
  if (error) GTEST_SKIP() << "no files of 4 TB here";
  std::string fault;
  EXPECT_EQ(read_bytes(path, fault), "");
  EXPECT_THAT(fault, testing::MatchesRegex("it has 4.4 TB, and .* [kMGT]?B of memory are available"));
}

double value_of(std::string_view word) {
  const auto [value, fault] = parse_number(word);
  EXPECT_EQ(fault, "") << word;
  return value;
}

TEST(NumberInText, IsRead) {
  EXPECT_EQ(value_of("0.01"), 0.01);
  EXPECT_EQ(value_of("+0.01"), 0.01);
  EXPECT_EQ(value_of("-2.5E-3"), -2.5e-3);
  EXPECT_EQ(value_of("+.5e+1"), 5);
  EXPECT_EQ(value_of("7."), 7);
  EXPECT_EQ(value_of("007"), 7);
  EXPECT_EQ(value_of("1.7976931348623157e308"), std::numeric_limits<double>::max());
  EXPECT_EQ(value_of("-inf"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(value_of("nan")));
}

TEST(NumberInText, ThatIsTooSmallIsRounded) {
  EXPECT_EQ(value_of("5e-324"), std::numeric_limits<double>::denorm_min());
  for (const std::string& tiny : {"1e-400"s, "+1e-400"s, "123.5e-400"s, "0." + std::string(400, '0') + "1"s,
                                  "0." + std::string(800, '0') + "1e400"s, "1e-99999999999999999999"s}) {
    EXPECT_EQ(value_of(tiny), 0) << tiny;
    EXPECT_FALSE(std::signbit(value_of(tiny))) << tiny;
  }
  EXPECT_TRUE(std::signbit(value_of("-1e-400")));
  EXPECT_EQ(value_of("0e400"), 0);
  EXPECT_EQ(value_of("0e99999999999999999999"), 0);
}

TEST(NumberInText, ThatIsTooLargeIsRefused) {
  for (const std::string& huge : {"1e400"s, "-1e400"s, "+1E+400"s, "1.8e308"s, std::string(400, '9'),
                                  std::string(800, '9') + "e-400"s, "1e99999999999999999999"s})
    EXPECT_EQ(parse_number(huge).fault, "beyond the largest number, 1.8e308") << huge;
}

TEST(NumberInText, IsRefusedWithTheReason) {
  EXPECT_EQ(parse_number("").fault, "empty");
  for (const char* word : {"x3", "-", "+", "++1", "+-1", "-+1", ".", "e5", ",", "1,e"})
    EXPECT_NE(parse_number(word).fault, "") << word;
  for (const char* word : {"x3", "-", "++1", "+-1", ".", "−1"}) EXPECT_EQ(parse_number(word).fault, "not a number");
  for (const char* word : {"0,01", "-0,01", "+0,01", "1,5e-3", ",5"})
    EXPECT_EQ(parse_number(word).fault, "numbers use a point, not a comma") << word;
  for (const char* word : {"0.01,", "1,2,3,4", "1.5,2", "1,x"})
    EXPECT_EQ(parse_number(word).fault, "a comma follows the number; separate numbers by blanks") << word;
  for (const char* word : {"1mm", "1.2.3", "1e", "1 ", "0x10", "1d5"})
    EXPECT_EQ(parse_number(word).fault, "text follows the number") << word;
  EXPECT_EQ(parse_number("1\0"sv).fault, "text follows the number");
}

TEST(NumberInText, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"})  // those that are installed
    if (std::setlocale(LC_ALL, locale) != nullptr) {
      EXPECT_EQ(value_of("0.5"), 0.5) << locale;
      EXPECT_NE(parse_number("0,5").fault, "") << locale;
    }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(VisibleText, ShowsEveryByte) {
  EXPECT_EQ(visible_text("0.01 m, d₅₀, 粒"), "0.01 m, d₅₀, 粒");
  EXPECT_EQ(visible_text("a\0b\t\x1b[1m\r\n\x7f"sv), "a\\x00b\\x09\\x1b[1m\\x0d\\x0a\\x7f");
  EXPECT_EQ(visible_text("\xef\xbb\xbf"
                         "0.01"),
            "\\xef\\xbb\\xbf0.01");
  EXPECT_EQ(visible_text("1\u00a02"), "1\\xc2\\xa02") << "a no-break space separates no words";
  EXPECT_EQ(visible_text("gr\xf6\xdf"
                         "e"),
            "gr\\xf6\\xdfe")
      << "Latin-1";
  EXPECT_EQ(visible_text("\xc0\xaf \xed\xa0\x80 \xe2\x82"), "\\xc0\\xaf \\xed\\xa0\\x80 \\xe2\\x82")
      << "overlong, surrogate, cut";
}

TEST(VisibleText, IsCutBetweenCharacters) {
  EXPECT_EQ(visible_text("d₅₀ = 2", 3), "d₅₀…");
  EXPECT_EQ(visible_text("d₅₀", 3), "d₅₀");
  EXPECT_EQ(quoted_excerpt("0.01"), "\"0.01\"");
  EXPECT_EQ(quoted_excerpt(std::string(40, 'x')), '"' + std::string(40, 'x') + '"');
  EXPECT_EQ(quoted_excerpt(std::string(41, 'x')), '"' + std::string(40, 'x') + "…\"");
  EXPECT_EQ(quoted_excerpt(std::string(1000, '\0'), 2), "\"\\x00\\x00…\"");
}

}  // namespace
}  // namespace grit::text_file_tests
