// Where the part of the world ends that averages are taken over.
#include <gtest/gtest.h>

#include "support/scene.hpp"

namespace grit::test {
namespace {

Region specimen_between(const Description& low, const Description& high) {
  Description d = description("linear-frictional", {{"density", 2600}}, {{{0.5, 0.5, 0.5}, 0.1}});
  d["walls"]["container"] = {
      {"type", "box"}, {"low", {0, 0, 0}}, {"high", {1, 2, 3}}, {"inside", true}, {"material", "grain"}};
  d["walls"]["block"] = {
      {"type", "box"}, {"low", {0, 0, 2}}, {"high", {1, 2, 2.5}}, {"inside", false}, {"material", "grain"}};
  d["specimen"] = {{"low", low}, {"high", high}};
  const Scene scene = scene_of(d);
  const Simulation world(*scene.description, make_bodies(*scene.description, {}), 1);
  return world.specimen();
}

TEST(Specimen, EndsAtTheInnerFacesOfAContainer) {
  const Region region =
      specimen_between({"container", "container", "container"}, {"container", "container", "container"});
  EXPECT_EQ(region.low, Vec3(0, 0, 0));
  EXPECT_EQ(region.high, Vec3(1, 2, 3));
}

TEST(Specimen, EndsAtTheNearFaceOfABlock) {
  const Region below = specimen_between({"container", "container", "container"}, {"container", "container", "block"});
  EXPECT_EQ(below.high, Vec3(1, 2, 2));
  const Region above = specimen_between({"container", "container", "block"}, {"container", "container", "container"});
  EXPECT_EQ(above.low, Vec3(0, 0, 2.5));
}

}  // namespace
}  // namespace grit::test
