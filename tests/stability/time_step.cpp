// The largest stable step of systems whose fastest mode is known, found from both sides, compared with the critical
// step of grit.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "grit/contact/restitution.hpp"
#include "support/growth.hpp"
#include "support/mapped.hpp"
#include "support/packing.hpp"

namespace grit::test::time_step_tests {
namespace {

constexpr double radius = 1e-3, density = 2500, modulus = 1e8, stiffness = modulus * radius, shear_ratio = 0.3;
const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;
constexpr double squeeze = 1e-3, trembling = 1e-9;  // of the radius; of the squeeze

Description material(double restitution) {
  Description m{{"density", density}, {"contact_modulus", modulus}, {"friction_angle", "60 deg"}};
  m["shear_to_normal_stiffness"] = shear_ratio;
  if (restitution < 1) m["restitution"] = restitution;
  return m;
}

/// A sphere compressed by two fixed plates; it starts towards one of them.
Description pressed(double restitution, bool rough) {
  Description m = material(restitution);
  if (!rough) m["friction_angle"] = 0;
  const double speed = trembling * squeeze * radius * std::sqrt(2 * stiffness / mass);
  Description d = description("linear-frictional", m, {{Vec3::Zero(), radius, {0, 0, speed}}});
  d["walls"]["low"] = plane({0, 0, -(1 - squeeze) * radius}, Vec3::UnitZ());
  d["walls"]["high"] = plane({0, 0, (1 - squeeze) * radius}, -Vec3::UnitZ());
  return d;
}

/// The limit found, the prediction and the critical step of grit, over the critical step of the undamped spring.
void map_step(const std::string& name, double restitution, const Description& d, double predicted) {
  const auto& map = "longest stable step, over 2 √(m/k) of one spring|restitution";
  const double spring = 2 * std::sqrt(mass / stiffness);
  map_point(map, name, restitution, found_limit(d, predicted) / spring);
  map_point(map, "predicted, " + name, restitution, predicted / spring);
  map_point(map, "critical step, " + name, restitution, critical(d) / spring);
}

TEST(TimeStep, SphereBetweenPlatesStartsToGrowWhereItIsSaidTo) {
  for (const double e : {1.0, 0.8, 0.5, 0.2, 0.05}) {
    SCOPED_TRACE("restitution " + std::to_string(e));
    // Both contacts act along one line: twice the stiffness and twice the damping.
    const double dashpot = 2 * damping_of_restitution(e) * std::sqrt(stiffness * mass);
    const double limit = limit_of(2 * stiffness / mass, 2 * dashpot / mass);
    expect_limit(pressed(e, false), limit);
    EXPECT_NEAR(critical(pressed(e, false)) / limit, 1, 1e-12);
    map_step("a sphere between plates", e, pressed(e, false), limit);
    EXPECT_LE(critical(pressed(e, true)), limit);
  }
}

/// Spheres on a simple cubic lattice, each moving against all of its neighbours along x.
Description lattice(const std::string& law, double restitution) {
  constexpr int sides = 4;
  constexpr double spacing = 2 * radius * (1 - squeeze);
  const double speed = trembling * squeeze * radius * std::sqrt(stiffness / mass);
  std::vector<Grain> grains;
  for (int x = 0; x < sides; ++x)
    for (int y = 0; y < sides; ++y)
      for (int z = 0; z < sides; ++z)
        grains.push_back(
            {spacing * Vec3(x + 0.5, y + 0.5, z + 0.5), radius, {(x + y + z) % 2 == 0 ? speed : -speed, 0, 0}});
  Description d = description(law, material(restitution), grains);
  d["domain"] = {
      {"low", {0, 0, 0}}, {"high", vector(Vec3::Constant(sides * spacing))}, {"periodic", {true, true, true}}};
  return d;
}

TEST(TimeStep, LatticeStartsToGrowAboveTheStepThatIsSaidToBeSafe) {
  for (const std::string law : {"linear-rolling", "linear-frictional"})
    for (const double e : {1.0, 0.5, 0.1}) {
      if (law == "linear-rolling" && e < 1) continue;  // has no dashpots
      SCOPED_TRACE(law + ", restitution " + std::to_string(e));
      // Relative displacements are twice those to a fixed point: two contacts are compressed, four sheared.
      const double dashpot = 2 * damping_of_restitution(e) * std::sqrt(stiffness * mass / 2);
      const double limit = limit_of((4 + 8 * shear_ratio) * stiffness / mass, 4 * dashpot / mass);
      const Description d = lattice(law, e);
      expect_limit(d, limit);
      map_step("lattice, " + law, e, d, limit);
      EXPECT_LE(critical(d), (1 + 1e-12) * limit);
      // Springs in rolling, which this mode does not load, count too.
      EXPECT_GE(critical(d), (law == "linear-rolling" ? 0.75 : 0.99) * limit) << "not much shorter than necessary";
    }
}

TEST(TimeStep, LatticeDampedInShearStartsToGrowAboveTheStepThatIsSaidToBeSafe) {
  for (const double e : {0.8, 0.5, 0.1}) {
    SCOPED_TRACE("restitution " + std::to_string(e));
    Description d = lattice("linear-frictional", e);
    d["contacts"]["shear_damping"] = true;
    const double ratio = damping_of_restitution(e), shear = shear_ratio * stiffness;
    const double along = 2 * ratio * std::sqrt(stiffness * mass / 2), across = 2 * ratio * std::sqrt(shear * mass / 7);
    const double limit = limit_of((4 + 8 * shear_ratio) * stiffness / mass, (4 * along + 8 * across) / mass);
    expect_limit(d, limit);
    map_step("lattice, damped in shear", e, d, limit);
    EXPECT_LE(critical(d), (1 + 1e-12) * limit);
    EXPECT_GE(critical(d), 0.9 * limit) << "not much shorter than necessary";
  }
}

TEST(TimeStep, BallThatResistsRollingStartsToGrowWhereItsRockingSays) {
  const auto& map = "longest stable step of a ball between plates, over 2 √(m/k) of one spring|rolling stiffness";
  for (const double rolling : {1.0, 3.0, 10.0}) {
    SCOPED_TRACE(rolling);
    Description m = material(1);
    m["rolling_stiffness"] = rolling, m["rolling_limit"] = 100;
    const double turning = trembling * squeeze * std::sqrt(stiffness / mass);
    Description d = description("linear-rolling", m, {{Vec3::Zero(), radius, Vec3::Zero(), {0, turning, 0}}});
    d["walls"]["low"] = plane({0, 0, -(1 - squeeze) * radius}, Vec3::UnitZ());
    d["walls"]["high"] = plane({0, 0, (1 - squeeze) * radius}, -Vec3::UnitZ());
    // About its centre: two shear springs with the radius as arm, two rolling springs K_r = β K_s r².
    const double limit = 2 / std::sqrt(5 * shear_ratio * (1 + rolling) * stiffness / mass);
    expect_limit(d, limit);
    EXPECT_LE(critical(d), limit);
    EXPECT_GE(critical(d), 0.9 * limit) << "not much shorter than necessary";
    const double spring = 2 * std::sqrt(mass / stiffness);
    map_point(map, "found", rolling, found_limit(d, limit) / spring);
    map_point(map, "predicted", rolling, limit / spring),
        map_point(map, "critical step", rolling, critical(d) / spring);
  }
}

/// Grains compressed in a periodic cell without friction until at rest, then with friction and small random velocities.
Description packed(double friction, double shear_to_normal = shear_ratio) {
  auto grains = jumble({4, 4, 4}, 1e-3, 0, 9);
  constexpr double closer = 0.92, side = 4e-3 * closer;
  for (Grain& g : grains) g.position *= closer;
  Description m = material(1);
  m["shear_to_normal_stiffness"] = shear_to_normal;
  const auto cell = [&](const std::vector<Grain>& list, double tangent) {
    m["friction_angle"] = std::atan(tangent);
    Description d = description("linear-frictional", m, list);
    d["domain"] = {{"low", {0, 0, 0}}, {"high", {side, side, side}}, {"periodic", {true, true, true}}};
    d["guards"] = {{"overlap", 1}, {"travel", 1}, {"energy", 1e9}};
    return d;
  };
  Description loose = cell(grains, 0);
  loose["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  Trial t(loose);
  while (equilibrium(t.world()).unbalanced_force > 1e-11 && t.world().step() < 200000) t.step(100);
  EXPECT_LT(equilibrium(t.world()).unbalanced_force, 1e-11);
  EXPECT_GT(t.kernel().state().pairs.touching_count(), 2 * grains.size()) << "dense";
  Random random(2);
  const auto about = [&] { return 1e-12 * (2 * random.uniform() - 1); };
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    grains[i].position = t.position(i), grains[i].velocity = {about(), about(), about()};
  return cell(grains, friction);
}

TEST(TimeStep, DensePackingStartsToGrowAboveTheStepThatIsSaidToBeSafe) {
  for (const double friction : {0.0, 10.0}) {
    const Description d = packed(friction);
    const double said = critical(d), found = found_limit(d, 1.2 * said);
    EXPECT_LE(said, found);
    EXPECT_GE(said, 0.8 * found) << "not much shorter than necessary";
    EXPECT_LT(growth(d, 0.99 * said, 4000), 1e3);
  }
}

/// 2/ω of the fastest mode of all grains of a packing whose contacts stick [s].
double limit_of_all_modes(const Trial& t) {
  const World& world = t.world();
  const ContactLaw& law = *t.kernel().state().settings.law;
  const auto count = static_cast<Eigen::Index>(world.positions().size());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(6 * count, 6 * count);
  for (const Contact& c : world.contacts()) {
    const double a = world.positions()[c.a].w, b = world.positions()[c.b].w;
    const Stiffness k = law.stiffness({.radius_a = a,
                                       .radius_b = b,
                                       .inverse_mass_a = world.velocities()[c.a].w,
                                       .inverse_mass_b = world.velocities()[c.b].w,
                                       .overlap = c.overlap,
                                       .wall = false},
                                      0, 0);
    const Mat3 along = c.normal * c.normal.transpose(), across = Mat3::Identity() - along;
    const Mat3 turn{
        {0, -c.normal.z(), c.normal.y()}, {c.normal.z(), 0, -c.normal.x()}, {-c.normal.y(), c.normal.x(), 0}};
    // Relative displacement of the centres and slip of the surfaces, with the branch extended to the sum of the radii;
    // the normal force rotates with the branch.
    const Mat3 extended = (a + b) / c.branch.norm() * Mat3::Identity();
    Eigen::Matrix<double, 3, 12> slip, apart;
    slip << -extended, a * turn, extended, b * turn;
    apart << -Mat3::Identity(), Mat3::Zero(), Mat3::Identity(), Mat3::Zero();
    const Eigen::Matrix<double, 12, 12> one =
        slip.transpose() * (k.shear * across) * slip +
        apart.transpose() * (k.normal * along - c.normal_force / c.branch.norm() * across) * apart;
    const Eigen::Index first[] = {6 * c.a, 6 * c.b};
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 2; ++column)
        whole.block<6, 6>(first[row], first[column]) += one.block<6, 6>(6 * row, 6 * column);
  }
  Eigen::VectorXd scale(6 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    scale.segment<3>(6 * i).setConstant(std::sqrt(world.velocities()[k].w));
    scale.segment<3>(6 * i + 3).setConstant(std::sqrt(world.spins()[k].w));
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * whole * scale.asDiagonal();
  return 2 /
         std::sqrt(
             Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

TEST(TimeStep, DensePackingStartsToGrowWhereItsEigenvaluesSay) {
  for (const double ratio : {0.03, 0.1, 0.3, 1.0}) {
    const Description d = packed(10, ratio);
    const double predicted = limit_of_all_modes(Trial(d)), said = critical(d);
    const double found = found_limit(d, predicted);
    EXPECT_NEAR(found / predicted, 1, 0.01) << ratio;
    EXPECT_LE(said, found);
    constexpr double r = 0.5e-3;
    const double spring = 2 * std::sqrt(density * 4 / 3 * std::numbers::pi * r * r / modulus);
    const std::string map =
        "longest stable step of a dense packing, over 2 √(m/k) of its mean grain|shear over normal stiffness";
    map_point(map, "found", ratio, found / spring);
    map_point(map, "predicted", ratio, predicted / spring);
    map_point(map, "critical step", ratio, said / spring);
  }
}

/// Soft Hertz grains in a periodic cell, some of them compressed.
Description soft(const std::vector<Grain>& grains, double side) {
  Description d = description(
      "hertz-mindlin",
      {{"density", density}, {"young_modulus", 5e6}, {"poisson_ratio", 0.3}, {"friction_angle", "27 deg"}}, grains);
  d["domain"] = {{"low", {0, 0, 0}}, {"high", {side, side, side}}, {"periodic", {true, true, true}}};
  d["guards"] = {{"overlap", 1}, {"travel", 1}, {"energy", 1e9}};
  return d;
}

/// Every 60 steps the critical step of the present contacts is at most that of all modes, and not much shorter.
void expect_close_bound(const std::string& name, Trial& t, double side, int samples) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (int k = 0; k < samples; ++k) {
    t.step(60);
    std::vector<Grain> now;
    for (std::uint32_t i = 0; i < t.world().positions().size(); ++i)
      now.push_back({t.position(i), t.world().positions()[index_of(t.world(), i)].w});
    const Trial still(soft(now, side));
    const double ratio = still.kernel().critical_time_step() / limit_of_all_modes(still);
    least = std::min(least, ratio), most = std::max(most, ratio);
  }
  EXPECT_LE(most, 1) << name;
  EXPECT_GE(least, 0.8) << name << ": not much shorter than necessary";
  figure("critical step over that of all modes, least, " + name, least);
  figure("critical step over that of all modes, most, " + name, most);
}

TEST(TimeStep, IsCloseToThatOfAllModesOfSoftGrainsAtRestAndInFlow) {
  constexpr double side = 3.8e-3;
  auto grains = jumble({4, 4, 4}, 1e-3, 0, 9);
  for (Grain& g : grains) g.position *= side / 4e-3;
  Description still = soft(grains, side);
  still["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.7}};
  Trial rest(still);
  expect_close_bound("at rest", rest, side, 15);
  for (Grain& g : grains) g.velocity.x() = 2 * std::sin(2 * std::numbers::pi * g.position.z() / side);
  Trial flow(soft(grains, side));
  expect_close_bound("in flow", flow, side, 15);
}

TEST(TimeStep, AtTheDefaultSafetyNothingGrows) {
  // Many dashpots on one body: bounds from single dashpots would allow unstable steps.
  for (const double e : {1.0, 0.5, 0.1, 0.02})
    for (const Description& d : {pressed(e, true), lattice("linear-frictional", e)})
      EXPECT_LT(growth(d, 0.8 * critical(d), 4000), 20) << "restitution " << e;
  Description packing = lattice("linear-frictional", 1);
  packing["time_step"]["steps_per_impact"] = 0;
  const Trial chosen(packing);
  const double share = chosen.world().dt() / chosen.kernel().critical_time_step();
  EXPECT_NEAR(share, 0.8, 1e-12);
  figure("share of the bound that is chosen", share);
}

}  // namespace
}  // namespace grit::test::time_step_tests
