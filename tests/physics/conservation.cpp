// Conservation of momentum and angular momentum in an isolated cloud.
#include <gtest/gtest.h>

#include "support/packing.hpp"
#include "support/verified.hpp"

namespace grit::test::conservation_tests {
namespace {

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  ///< about the origin
  double linear_size = 0, angular_size = 0;            ///< sums of absolute values
};
Momenta momenta(const World& world) {
  Momenta sum;
  for (std::size_t i = 0; i < world.positions().size(); ++i) {
    const Row &v = world.velocities()[i], &w = world.spins()[i];
    const Vec3 p = xyz(v) / v.w, orbit = xyz(world.positions()[i]).cross(p), own = xyz(w) / w.w;
    sum.linear += p, sum.angular += orbit + own;
    sum.linear_size += p.norm(), sum.angular_size += xyz(world.positions()[i]).norm() * p.norm() + own.norm();
  }
  return sum;
}

TEST(Conservation, CloudKeepsMomentumAndAngularMomentum) {
  auto grains = jumble({6, 6, 6}, 1e-3, 0.5, 21, Vec3::Constant(-3e-3));
  Random random(1);
  for (Grain& g : grains) {
    g.radius *= 0.7 + 0.3 * random.uniform();
    g.velocity -= 1000 * g.position;  // they move towards each other, and apart again
  }
  Description d = description("linear-rolling",
                              {{"contact_modulus", 1e7}, {"twisting_stiffness", 0.5}, {"twisting_limit", 0.2}}, grains);
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.5}, {"energy", 1}};
  Trial t(d);
  const Momenta before = momenta(t.world());
  std::size_t most = 0;
  for (int i = 0; i < 1500; ++i) t.step(), most = std::max(most, t.kernel().state().pairs.touching_count());
  const Momenta after = momenta(t.world());
  EXPECT_GT(most, 150u);
  // Forces and moments of each pair cancel; sums over 1500 steps leave only round-off. Positions at full steps and
  // velocities at half steps can be combined here: a body moves along its velocity.
  verify("momentum of a cloud after 1500 steps, change over the sum of its bodies'",
         (after.linear - before.linear).norm() / before.linear_size, 0, 2e-15, 1);
  verify("angular momentum of a cloud after 1500 steps, change over the sum of its bodies'",
         (after.angular - before.angular).norm() / before.angular_size, 0, 3e-14, 1);
}

}  // namespace
}  // namespace grit::test::conservation_tests
