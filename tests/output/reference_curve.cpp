#include "output/reference_curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/own_folder.hpp"

namespace grit::test::reference_curve_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string error_of(const ReferenceCurve& curve) {
  try {
    read_reference(curve);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(ReferenceCurves, AreTwoColumnsOfATable) {
  const OwnFolder folder;
  const auto path = folder.write("laboratory.csv", "strain, ratio,\"stress\"\n# source\n0,1,0.5\n1,2,0.75\n").string();
  const ReferencePoints curve = read_reference({path, "strain", "stress"});
  EXPECT_THAT(curve.x, ElementsAre(0, 1));
  EXPECT_THAT(curve.y, ElementsAre(0.5, 0.75));
  EXPECT_THAT(error_of({path, "strain", "tau"}), HasSubstr(":1: there is no column \"tau\""));
  const auto elsewhere = folder.write("elsewhere.csv", "\xef\xbb\xbfx, y\r\n0, 1\r\n\r\n1, 2\r\n").string();
  EXPECT_THAT(read_reference({elsewhere, "x", "y"}).y, ElementsAre(1, 2)) << "as other systems write it";
  const auto bad = folder.write("bad.csv", "x,y\n0,1\n1,much\n").string();
  EXPECT_THAT(error_of({bad, "x", "y"}), HasSubstr("bad.csv:3: column \"y\" is \"much\": not a number"));
}

TEST(ReferenceCurves, AreReadWhateverTheirLineEnds) {
  const OwnFolder folder;
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const auto file = folder
                          .write("a.csv", "\xef\xbb\xbfx,y" + end + "# source" + end + "0,+1" + end + ",," + end +
                                              "\"1\", 1e-400 ," + end)
                          .string();
    const ReferencePoints curve = read_reference({file, "x", "y"});
    EXPECT_THAT(curve.x, ElementsAre(0, 1));
    EXPECT_THAT(curve.y, ElementsAre(1, 0));
    const auto bad = folder.write("bad.csv", "x,y" + end + end + "0" + end).string();
    EXPECT_EQ(error_of({bad, "x", "y"}), bad + ":3: column \"y\" is \"\": empty");
  }
}

TEST(ReferenceCurves, RefuseCommasInNumbers) {
  const OwnFolder folder;
  const auto told = [&](const std::string& line) {
    const auto file = folder.write("a.csv", "x,y\n0,1\n" + line + '\n').string();
    const std::string error = error_of({file, "x", "y"});
    EXPECT_THAT(error, testing::StartsWith(file + ":3: "));
    return error.substr(std::min(error.size(), file.size() + 4));
  };
  EXPECT_EQ(told("0,5,1,5"), "found 4 cells in \"0,5,1,5\"; line 1 names 2 columns; numbers use a point, not a comma");
  EXPECT_EQ(told("\"0,5\",\"1,5\""), "column \"x\" is \"0,5\": numbers use a point, not a comma");
  EXPECT_EQ(told("1,2 mm"), "column \"y\" is \"2 mm\": text follows the number");
  EXPECT_EQ(told("1,1e400"), "column \"y\" is \"1e400\": beyond the largest number, 1.8e308");
  const auto utf16 = folder.write("b.csv", "\xfe\xff").string();
  EXPECT_EQ(error_of({utf16, "x", "y"}), utf16 + ": the file is UTF-16 text; save it as UTF-8");
}

TEST(ReferenceCurves, NeedTwoPointsWithRisingAbscissa) {
  const OwnFolder folder;
  const auto falls = folder.write("falls.csv", "x,y\n1,1\n0,2\n").string();
  EXPECT_EQ(error_of({falls, "x", "y"}), falls + ": fewer than two points with rising x");
  const auto noisy = folder.write("noisy.csv", "x,y\n0,1\n2,3\n1,2\nnan,7\n3,4\n").string();
  EXPECT_THAT(read_reference({noisy, "x", "y"}).x, ElementsAre(0, 2, 3));
  const auto mistyped = folder.write("mistyped.csv", "x,y\n0,1\n1,2\n30,3\n3,4\n4,5\n").string();
  EXPECT_EQ(error_of({mistyped, "x", "y"}),
            mistyped +
                ": 2 of 5 points do not exceed all earlier ones in x, the first in row 4; sort the rows, or give one "
                "branch of a loop");
}

}  // namespace
}  // namespace grit::test::reference_curve_tests
