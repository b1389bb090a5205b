#include <gmock/gmock.h>

#include "grit/toolkit/stl_file.hpp"
#include "support/own_folder.hpp"
#include "support/stl_file.hpp"

namespace grit {
namespace {

using test::StlFile;
using testing::HasSubstr;

const std::vector<Vec3> two_facets{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {0.5, -0.25, 2}};

Stl read(std::string_view bytes) { return read_stl(StlFile(bytes).path()); }

void expect_two_facets(const Stl& stl) {
  ASSERT_TRUE(stl.defects.empty()) << stl.defects.front().found;
  ASSERT_EQ(stl.facets.size(), 2u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(stl.facets[i / 3].corners[i % 3], two_facets[i]);
}

/// What was found, by the only defect.
std::string refused(std::string_view bytes) {
  const Stl stl = read(bytes);
  if (stl.defects.size() != 1) return std::to_string(stl.defects.size()) + " defects";
  EXPECT_FALSE(stl.defects[0].allowed.empty());
  return stl.defects[0].found;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

/// A sparse file, which takes no disk.
TEST(Stl, IsNotReadIfTheMemoryCannotHoldIt) {
  const OwnFolder folder;
  const auto path = folder.write("huge.stl", "solid");
  std::error_code error;
  std::filesystem::resize_file(path, std::uintmax_t{1} << 42, error);
  if (error) GTEST_SKIP() << "no files of 4 TB here";
  const Stl stl = read_stl(path);
  ASSERT_EQ(stl.defects.size(), 1u);
  EXPECT_THAT(stl.defects[0].found, HasSubstr("huge.stl, which cannot be read: it has 4.4 TB, and "));
}

TEST(Stl, ReadsText) {
  const Stl stl = read(test::stl_text(two_facets));
  expect_two_facets(stl);
  EXPECT_EQ(stl.facets[0].normal, Vec3::UnitZ());
}

TEST(Stl, ReadsTextOfOtherPrograms) {
  expect_two_facets(
      read("SOLID a name of facet words\r\n FACET NORMAL 0 0 1 OUTER LOOP\r\n"
           "\tVERTEX 0 0 0\r\n\tVERTEX +1 0.0E0 0\r\n VERTEX 0 10e-1 0 ENDLOOP ENDFACET\r\nENDSOLID\r\n"
           "solid the second\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0 vertex 0 1 0\nvertex .5 -2.5e-1 2\n"
           "endloop\nendfacet\nendsolid the second"));
}

TEST(Stl, ReadsTextWhateverItsLineEndsAndByteOrderMark) {
  const std::string text = test::stl_text(two_facets);
  for (const std::string end : {"\n", "\r\n", "\r"})
    for (const std::string mark : {"", "\xef\xbb\xbf"}) {
      std::string other = mark;
      for (const char c : text) other += c == '\n' ? end : std::string(1, c);
      expect_two_facets(read(other));
      EXPECT_EQ(refused(replaced(other, "vertex 1 ", "vertex one ")),
                "\"one\" in line 5, after 0 complete facets: not a number");
    }
}

TEST(Stl, ReadsNumbersThatAreTooSmallAsZero) {
  expect_two_facets(read(replaced(test::stl_text(two_facets), "vertex 0 0 0", "vertex 1e-400 -1e-400 +0")));
}

TEST(Stl, ReadsANameFilledUpWithNul) {
  expect_two_facets(read(replaced(test::stl_text(two_facets), "made", "made" + std::string(70, '\0'))));
}

TEST(Stl, ReadsBinaryWithAnyHeader) {
  expect_two_facets(read(test::stl_binary(two_facets)));
  expect_two_facets(read(test::stl_binary(two_facets, "solid facet normal")));
  expect_two_facets(read(test::stl_binary(two_facets, "\xff\xfe")));
  expect_two_facets(read(test::stl_binary(two_facets, "\r\r\n")));
  EXPECT_EQ(read(test::stl_binary(two_facets)).facets[1].normal, Vec3::Zero());
}

TEST(Stl, RefusesIncompleteFiles) {
  const std::string text = test::stl_text(two_facets), binary = test::stl_binary(two_facets);
  EXPECT_EQ(refused(""), "an empty file");
  EXPECT_EQ(refused("solid nothing\nendsolid nothing\n"), "a file without facets");
  EXPECT_EQ(refused(test::stl_binary({})), "a file without facets");
  EXPECT_EQ(refused(text.substr(0, text.find("endsolid"))),
            "the end of the file in line 16, after 2 complete facets, where facet should be");
  EXPECT_EQ(refused(text.substr(0, text.rfind("vertex"))),
            "the end of the file in line 13, after 1 complete facets, where vertex should be");
  EXPECT_EQ(refused(binary.substr(0, 183)),
            "a binary file of 183 bytes whose header gives 2 facets, that is 184 bytes");
  EXPECT_EQ(refused(binary + 'x'), "a binary file of 185 bytes whose header gives 2 facets, that is 184 bytes");
  EXPECT_EQ(refused(test::stl_binary(two_facets, "solid").substr(0, 150)),
            "a binary file of 150 bytes whose header gives 2 facets, that is 184 bytes");
  EXPECT_EQ(refused("v 0 0 0\nv 1 0 0\n" + std::string(90, '#')), "a text that begins with \"v\" instead of \"solid\"");
  EXPECT_EQ(refused("{\"a\": 1}"), "8 bytes, neither \"solid\" at their beginning nor a binary header");
}

TEST(Stl, RefusesInvalidFacets) {
  const std::string text = test::stl_text(two_facets);
  EXPECT_EQ(refused(replaced(text, "vertex 1 ", "vertex one ")),
            "\"one\" in line 5, after 0 complete facets: not a number");
  EXPECT_EQ(refused(replaced(text, "vertex 1 ", "vertex 1e400 ")),
            "\"1e400\" in line 5, after 0 complete facets: beyond the largest number, 1.8e308");
  EXPECT_EQ(refused(replaced(text, "vertex 1 ", "vertex 1,0 ")),
            "\"1,0\" in line 5, after 0 complete facets: numbers use a point, not a comma");
  EXPECT_EQ(refused(text.substr(0, text.rfind("vertex") + 6)),
            "the end of the file in line 13, after 1 complete facets, where a number should be");
  EXPECT_EQ(refused(replaced(text, " endloop", "  vertex 3 3 3\n endloop")),
            "\"vertex\" in line 7, after 0 complete facets, where endloop should be");
  EXPECT_EQ(refused(replaced(text, "endsolid", "garbage")),
            "\"garbage\" in line 16, after 2 complete facets, where facet should be");
}

TEST(Stl, ShowsBytesThatAreNoText) {
  const std::string text = test::stl_text(two_facets);
  const std::string nul = std::string(100, '\0');
  std::string shown;
  for (int i = 0; i < 40; ++i) shown += "\\x00";
  EXPECT_EQ(refused(text + nul),
            '"' + shown + "…\" in line 17, after 2 complete facets, where solid or the end of the file should be");
  EXPECT_EQ(refused(replaced(text, " endloop", nul + " endloop")),
            '"' + shown + "…\" in line 7, after 0 complete facets, where endloop should be");
  EXPECT_EQ(refused(replaced(text, "vertex 1 ", "vertex 1\xa0 ")),
            "\"1\\xa0\" in line 5, after 0 complete facets: text follows the number");
  EXPECT_EQ(refused("OFF\xa0" + std::string(90, ' ')), "a text that begins with \"OFF\\xa0\" instead of \"solid\"");
}

TEST(Stl, RefusesUtf16) {
  for (const std::string mark : {"\xff\xfe", "\xfe\xff"})
    EXPECT_EQ(refused(mark + test::stl_text(two_facets)), "UTF-16 text");
}

TEST(Stl, RefusesNumbersThatAreNotFinite) {
  std::vector<Vec3> corners(two_facets);
  corners[4].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused(test::stl_binary(corners)), "corners that are not finite, of facet 2");
  EXPECT_EQ(refused(replaced(test::stl_text(two_facets), "vertex 1 ", "vertex inf ")),
            "corners that are not finite, of facet 1");
}

TEST(Stl, ReportsWhyAFileCannotBeRead) {
  const Stl gone = read_stl("/nowhere/at all.stl");
  ASSERT_EQ(gone.defects.size(), 1u);
  EXPECT_EQ(gone.defects[0].found, "/nowhere/at all.stl, which cannot be read: No such file or directory");
  EXPECT_THAT(read_stl("/tmp").defects.at(0).found, HasSubstr("cannot be read: Is a directory"));
}

TEST(Stl, ListsAFewFacetsAndCountsTheRest) {
  EXPECT_EQ(facet_numbers({0, 6}), "1, 7");
  EXPECT_EQ(facet_numbers({0, 1, 2, 3, 4, 5, 6}), "1, 2, 3, 4, 5 and 2 more");
}

}  // namespace
}  // namespace grit
