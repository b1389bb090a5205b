// Properties of fields in maps and as colours, from their names, units and docs.
#include "output/shown_fields.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

namespace grit::shown_fields_tests {
namespace {

Field field(const std::string& name, const std::string& unit, const std::string& doc, std::size_t width = 1,
            const std::vector<std::string>& components = {}) {
  return {name, unit, doc, width, {}, components};
}

std::vector<bool> signs(const Field& field) {
  std::vector<bool> all;
  for (std::size_t k = 0; k < field.width; ++k) all.push_back(is_signed(field, k));
  return all;
}

TEST(MapFields, HaveALargestVoidRatio) {
  EXPECT_EQ(largest_shown(field("void_ratio", "1", "infinite without solids")), 3);
  EXPECT_EQ(largest_shown(field("coordination_number", "1", "mean")), std::numeric_limits<double>::infinity());
}

TEST(MapFields, AreSignedByKind) {
  using testing::Each;
  using testing::ElementsAre;
  EXPECT_THAT(signs(field("velocity", "m s-1", "mean", 3)), Each(true));
  EXPECT_THAT(signs(field("strain", "1", "Green-Lagrange", 3, {"xx", "zz", "xz"})), Each(true));
  EXPECT_THAT(signs(field("stress", "Pa", "positive in compression", 9)),
              ElementsAre(false, true, true, true, false, true, true, true, false));
  EXPECT_THAT(signs(field("couple_stress", "N m-1", "of the cell", 9)), Each(true));
  EXPECT_FALSE(is_signed(field("void_ratio", "1", "infinite without solids"), 0));
  EXPECT_FALSE(is_signed(field("mean_stress", "Pa", "a third of the trace, positive in compression"), 0));
  EXPECT_TRUE(is_signed(field("rotation", "rad", "mean of the grains, positive clockwise"), 0));
}

TEST(MapFields, AreOfferedTheMostInformativeFirst) {
  std::vector<Field> all{field("correlation", "1", ""), field("coordination_number", "1", ""), field("my_own", "1", ""),
                         field("stress", "Pa", "", 9), field("void_ratio", "1", "")};
  std::ranges::stable_sort(all, {}, field_rank);
  std::vector<std::string> names;
  for (const Field& one : all) names.push_back(one.name);
  EXPECT_THAT(names, testing::ElementsAre("void_ratio", "stress", "coordination_number", "my_own", "correlation"));
}

TEST(MapFields, OmitCounters) {
  for (const char* name : {"id", "bodies", "start_position"}) EXPECT_TRUE(is_bookkeeping(field(name, "1", ""))) << name;
  for (const char* name : {"void_ratio", "coordination_number", "my_own"})
    EXPECT_FALSE(is_bookkeeping(field(name, "1", ""))) << name;
}

}  // namespace
}  // namespace grit::shown_fields_tests
