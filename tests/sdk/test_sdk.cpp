// The law that was built outside the tree is loaded, and computes the force of its spring.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/contact/contact_law.hpp"
#include "plugins/registry.hpp"

namespace grit {
namespace {

TEST(Sdk, LoadsAPluginFromOutside) {
  const Registry registry({OUTSIDE_PLUGINS, INSTALLED_PLUGINS});
  EXPECT_THAT(registry.names("contact"), testing::IsSupersetOf({"adhesive", "linear-rolling"}));
  const auto law = registry.make<ContactLaw>("adhesive");
  Parameters parameters;
  law->declare_material("sand", parameters);
  ASSERT_EQ(parameters.entries().front().name(), "contact_modulus");
  *std::get<double*>(parameters.entries().front().target()) = 1500;
  *std::get<double*>(parameters.entries()[2].target()) = 0;  // the angle of friction
  const std::string sand[] = {"sand"};
  law->mix(sand, 1);
  EXPECT_TRUE(law->state().empty());
  EXPECT_DOUBLE_EQ(law->stiffness({1, 1, 1, 1, 0}, 0, 0).normal, 1500);

  // A 3-4-5 triangle between the centres; the other lanes of the block lie far apart.
  Row position[] = {{0, 0, 0, 3}, {3, 4, 0, 2.25}, {100, 0, 0, 1}}, zero[3];
  const std::uint32_t a[block_size] = {0, 2, 2, 2, 2, 2, 2, 2}, b[block_size] = {1, 0, 0, 0, 0, 0, 0, 0};
  std::uint8_t touching = 0;
  ContactRow row[block_size];
  BodySum sum[3];
  PairBatch batch{};
  batch.position = position, batch.velocity = zero, batch.spin = zero;
  batch.a = a, batch.b = b, batch.last_block = 1, batch.dt = 1e-3;
  batch.touching = &touching, batch.row = row, batch.sum = sum;
  law->evaluate_pairs(batch);
  EXPECT_EQ(touching, 1);
  const double force = 2 * 4500.0 * 3375 / (4500 + 3375) * 0.25;
  EXPECT_NEAR(row[0].force.w, force, 1e-9);
  EXPECT_NEAR(row[0].force.x, 0.6 * force, 1e-9);
  EXPECT_NEAR(row[0].force.y, 0.8 * force, 1e-9);
  EXPECT_NEAR(sum[0].force.x, -0.6 * force, 1e-9);
}

TEST(Sdk, LoadsAnInstalledPlugin) {
  EXPECT_EQ(Registry({INSTALLED_PLUGINS}).make<ContactLaw>("linear-rolling")->loop().precision, "double");
}

}  // namespace
}  // namespace grit
