#include "bodies/sphere_body.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

namespace grit::sphere_body_tests {
namespace {

TEST(SphereBody, HasTheVolumeAndInertiaOfASphere) {
  const PluginInfo& info = sphere_body();
  EXPECT_STREQ(info.kind, "body");
  EXPECT_STREQ(info.name, "sphere");
  ASSERT_NE(info.make_body, nullptr);
  const std::unique_ptr<BodyKind> sphere(info.make_body());
  EXPECT_DOUBLE_EQ(sphere->volume(3), 36 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(sphere->inertia(3, 5), 18);
  Parameters none;
  sphere->declare(none);
  EXPECT_TRUE(none.entries().empty());
}

}  // namespace
}  // namespace grit::sphere_body_tests
