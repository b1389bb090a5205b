// Numbers of bodies from the fields of probes.
#include "output/body_values.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "fake_world.hpp"

namespace grit::body_values_tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::NanSensitiveDoubleEq;
using testing::SizeIs;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Of the bodies 7 and 2, in this order.
FieldGroup table() {
  return {"moved",
          {{"id", "1", "id of each body", 1, {7, 2}},
           {"centre", "m", "", 3, {0, 0, 0, 1, 1, 1}},
           {"size", "m", "", 3, {1, 1, 1, 1, 1, 1}},
           {"work", "J", "done on it", 1, {0.5, 0.25}},
           {"mean_stress", "Pa", "positive in compression", 1, {10, 20}},
           {"way", "m", "of the centre", 3, {3, 4, 0, 0, 0, -2}},
           {"of_contacts", "N", "another number of rows", 1, {1, 2, 3}}}};
}

TEST(BodyValues, AreThoseOfTablesWithIds) {
  const std::int64_t ids[] = {2, 5, 7};
  const auto all = values_of_bodies(table(), ids);
  std::vector<std::string> names, labels;
  std::vector<bool> signs;
  for (const BodyValues& one : all)
    names.push_back(one.name), labels.push_back(one.label), signs.push_back(one.is_signed);
  EXPECT_THAT(names,
              ElementsAre("moved/work", "moved/mean_stress", "moved/way", "moved/way/x", "moved/way/y", "moved/way/z"));
  EXPECT_THAT(labels, ElementsAre("work", "mean stress", "way", "way x", "way y", "way z"));
  EXPECT_THAT(signs, ElementsAre(false, false, false, true, true, true));
  EXPECT_EQ(all[0].unit, "J");
  EXPECT_EQ(all[0].doc, "done on it");
  const auto is = [](double value) { return NanSensitiveDoubleEq(value); };
  EXPECT_THAT(all[0].of_bodies, ElementsAre(is(0.25), is(nan), is(0.5))) << "by id; not of the body 5";
  EXPECT_THAT(all[2].of_bodies, ElementsAre(is(2), is(nan), is(5))) << "magnitudes";
  EXPECT_THAT(all[5].of_bodies, ElementsAre(is(-2), is(nan), is(0)));
}

TEST(BodyValues, AreNoneOfOtherTables) {
  FieldGroup contacts = table();
  contacts.fields.erase(contacts.fields.begin());
  EXPECT_THAT(values_of_bodies(contacts, {}), IsEmpty());
  EXPECT_THAT(values_of_bodies(table(), {}), SizeIs(6)) << "names, without a body";
}

TEST(BodyValues, AreFoundByName) {
  NumberedWorld world;
  world.add(7, {0, 0, 0}, 1), world.add(2, {3, 0, 0}, 1);
  const FieldGroup tables[] = {{"moved-on", {}}, table()};
  EXPECT_THAT(values_of_bodies(tables, world, "moved/way").of_bodies, ElementsAre(5, 2));
  EXPECT_EQ(values_of_bodies(tables, world, "moved/way").name, "moved/way");
  EXPECT_EQ(values_of_bodies(tables, world, "moved/nothing").name, "");
}

}  // namespace
}  // namespace grit::body_values_tests
