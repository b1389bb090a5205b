// Invalid clumps: messages with line, value found and allowed values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grit/error.hpp"
#include "support/program.hpp"
#include "support/scene.hpp"

namespace grit::test::description_tests {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class ClumpDescription : public testing::Test {
 protected:
  /// The problems of a shape in line 5.
  std::string problems_of(const std::string& shape) const {
    const auto file = folder.write("clumps.json", R"({
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600}},
  "bodies": {"grains": {"type": "clump", "material": "sand", "source": {"type": "list", "bodies": [{"position": [0, 0, 0], "radius": 1}]},
    "shape": )" + shape + R"(
  }},
  "stages": [{"name": "only", "until": {"type": "steps", "value": 1}, "limit": 1}]
})");
    try {
      LiveScene(load_scene(file, {}, installed()));
    } catch (const DescriptionError& error) {
      return error.what();
    }
    return "";
  }
  std::string in_line_5(const std::string& pointer) const {
    return (folder / "clumps.json").string() + ":5: /bodies/grains/shape" + pointer + ": ";
  }
  OwnFolder folder;
};

TEST_F(ClumpDescription, OfAListNamesTheSphereAtFault) {
  const auto list = [&](const std::string& spheres) {
    return problems_of(R"({"type": "list", "spheres": [)" + spheres + "]}");
  };
  const std::string unit = R"({"position": [0, 0, 0], "radius": 1})";
  EXPECT_EQ(list(unit + R"(, {"position": [1, 0, 0], "radius": 1})"), "");
  EXPECT_EQ(list(""), in_line_5("/spheres") + "found 0 entries; allowed are 1 or more");
  EXPECT_EQ(list(R"({"position": [0, 0, 0], "radius": 0})"),
            in_line_5("/spheres/0/radius") + "found 0 m; allowed is above 0 m");
  EXPECT_EQ(list(unit + R"(, {"position": [0.1, 0, 0], "radius": 0.2})"),
            in_line_5("/spheres/1") +
                "found sphere 2, which is inside sphere 1; allowed is a sphere that is not inside "
                "another; remove it");
  EXPECT_EQ(list(unit + R"(, {"position": [3, 0, 0], "radius": 1})"),
            in_line_5("/spheres/1") +
                "found sphere 2, which is not connected with sphere 1; allowed is spheres that "
                "overlap, so that all are connected");
  // Centre on the surface, a millionth of the size: half of it protrudes.
  EXPECT_EQ(list(unit + R"(, {"position": [1, 0, 0], "radius": 1e-6})"), "");
}

TEST_F(ClumpDescription, ReportsAllSpheresAtFaultUpToTen) {
  const auto list = [&](int apart, int within, int flat) {
    std::string spheres = R"({"position": [0, 0, 0], "radius": 1}, {"position": [1, 0, 0], "radius": 1})";
    const auto add = [&](double x, const std::string& radius) {
      spheres += R"(, {"position": [)" + std::to_string(x) + R"(, 0, 0], "radius": )" + radius + "}";
    };
    for (int k = 0; k < apart; ++k) add(10 + 5 * k, "1");
    for (int k = 0; k < within; ++k) add(0.1 * k, "0.01");
    for (int k = 0; k < flat; ++k) add(0, "0");
    return problems_of(R"({"type": "list", "spheres": [)" + spheres + "]}");
  };
  const auto at = [&](int k) {
    return in_line_5("/spheres/" + std::to_string(k)) + "found sphere " + std::to_string(k + 1);
  };
  const std::string
      apart = ", which is not connected with sphere 1; allowed is spheres that overlap, so that all are connected",
      within = ", which is inside sphere 1; allowed is a sphere that is not inside another; remove it";
  EXPECT_EQ(list(2, 1, 0), at(2) + apart + '\n' + at(3) + apart + '\n' + at(4) + within);
  const std::string many = list(9, 4, 0);
  EXPECT_THAT(many, HasSubstr(at(10) + apart + '\n' + at(11) + within + '\n' + in_line_5("/spheres") +
                              "found 3 more spheres that are inside another or not connected; allowed is spheres "
                              "that are connected, and of which none is inside another"));
  EXPECT_THAT(many, testing::Not(HasSubstr("sphere 13,")));
  EXPECT_EQ(list(0, 0, 2), in_line_5("/spheres/2/radius") + "found 0 m; allowed is above 0 m\n" +
                               in_line_5("/spheres/3/radius") + "found 0 m; allowed is above 0 m");
}

TEST_F(ClumpDescription, OfARodWhoseSpheresAreAllButOneNamesTheSpacing) {
  EXPECT_THAT(problems_of(R"({"type": "rod", "spacing": 1e-12})"),
              testing::AllOf(StartsWith(in_line_5("/spacing") + "found sphere 2, which is inside sphere 1;"),
                             testing::Not(HasSubstr("\n"))));
  EXPECT_THAT(problems_of(R"({"type": "rod", "count": 20, "spacing": 1e-12})"), testing::Not(HasSubstr("\n")));
}

TEST_F(ClumpDescription, OfAFileNamesFileAndLine) {
  const auto file = [&](const std::string& lines) {
    folder.write("spheres.txt", lines);
    return problems_of(R"({"type": "file", "path": "spheres.txt"})");
  };
  const std::string path = (folder / "spheres.txt").string(), place = in_line_5("/path") + "found ";
  EXPECT_EQ(file("0 0 0 1\n1 0 0 1\n"), "");
  EXPECT_EQ(file("\xef\xbb\xbf+0 0 0 1\r1 0 0 1\r"), "");
  EXPECT_EQ(file("0 0 0 1\r1,5 0 0 1\r"), place + path +
                                              ":2: x is \"1,5\": numbers use a point, not a comma; allowed is a file "
                                              "with one line per sphere: x y z radius");
  EXPECT_EQ(file("# x y z radius\n0 0 0 1\n1 0 0\n1 0 x 1\n0 0 0 -1\n"),
            place + path +
                ":3: found 3 columns; expected 4: x y z radius; allowed is a file with one line "
                "per sphere: x y z radius\n" +
                place + path +
                ":4: z is \"x\": not a number; allowed is a file with one line per sphere: x y z radius\n" + place +
                path +
                ":5: radius is -1 m; it must be above 0; allowed is a file with one line per sphere: "
                "x y z radius");
  EXPECT_THAT(file("# nothing\n"), StartsWith(place + path + ": contains no grains"));
  EXPECT_THAT(file("0 0 0 1\n3 0 0 1\n"), StartsWith(place + path + ": sphere 2, which is not connected"));
  EXPECT_THAT(problems_of(R"({"type": "file", "path": "missing.txt"})"),
              testing::AllOf(StartsWith(place), HasSubstr("missing.txt: cannot be read: No such file"),
                             EndsWith("allowed is a file with one line per sphere: x y z radius")));
}

}  // namespace
}  // namespace grit::test::description_tests
