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
  EXPECT_THAT(error_of({bad, "x", "y"}), HasSubstr("bad.csv:3: no number in column \"y\": "));
}

TEST(ReferenceCurves, NeedTwoPointsWithRisingAbscissa) {
  const OwnFolder folder;
  const auto falls = folder.write("falls.csv", "x,y\n1,1\n0,2\n").string();
  EXPECT_EQ(error_of({falls, "x", "y"}), falls + ": fewer than two points with rising x");
  const auto noisy = folder.write("noisy.csv", "x,y\n0,1\n2,3\n1,2\nnan,7\n3,4\n").string();
  EXPECT_THAT(read_reference({noisy, "x", "y"}).x, ElementsAre(0, 2, 3));
}

}  // namespace
}  // namespace grit::test::reference_curve_tests
