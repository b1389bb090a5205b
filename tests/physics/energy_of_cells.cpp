// Work of a deforming cell.
#include <gtest/gtest.h>

#include <cmath>

#include "energy_balance.hpp"
#include "support/clump.hpp"
#include "support/verified.hpp"

namespace grit::test::energy_balance_tests {
namespace {

// All spheres move with the mean flow, so that overlaps follow from the strain of the cell.
TEST(Energies, ACellsWorkIsStoredInALattice) {
  constexpr int side = 3;
  const double spacing = 1.99 * radius, modulus = 1e8;
  std::vector<Grain> list;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z) list.push_back({spacing * Vec3(x + 0.25, y + 0.25, z + 0.25), radius});
  Kept lattice(
      periodic("linear-rolling", {{"contact_modulus", modulus}}, list, Vec3::Constant(side * spacing), {-40, 0, 10}));
  const double kinetic = lattice.world().energies().kinetic;
  lattice.step(2000);
  const Energies now = lattice.world().energies();
  const Cell& cell = lattice.world().cell();
  double stored = 0;
  const auto spring = [&](double apart) { return 0.5 * modulus * radius * std::pow(2 * radius - apart, 2); };
  for (int k = 0; k < 3; ++k)
    stored += side * side * side * (spring((cell.high[k] - cell.low[k]) / side) - spring(spacing));
  ASSERT_GT(stored, 500 * kinetic);
  verify("work of a cell that squeezes a lattice, less its motion's, over what its springs store",
         (now.cell - (now.kinetic - kinetic)) / stored, 1, 1e-9);
  EXPECT_LE(std::abs(now.closure_error), 1e-9 * stored);
}

// Without contacts, they move with the mean flow and re-enter with the flow of the opposite side.
TEST(Energies, ACellsWorkMovesWhatGoesThroughIt) {
  for (const auto& [clumped, sheared] :
       {std::pair(false, false), std::pair(true, false), std::pair(false, true), std::pair(true, true)}) {
    SCOPED_TRACE(clumped);
    Description d = periodic("linear-rolling", {}, {{Vec3::Constant(0.012), radius, {3, -2, 1}, {20, 30, 10}}},
                             Vec3::Constant(0.02), {-20, 30, 10});
    if (clumped) make_clumps(d, boomerang());
    d["time_step"]["value"] = 1e-6;
    if (sheared) d["domain"]["shear_rate"] = {{"xy", 30}, {"xz", -50}, {"yz", 40}};
    Kept one(d);
    const double before = one.world().energies().kinetic;
    for (int round = 0; round < 20; ++round) one.kernel().request_rebuild(), one.step(1000);
    const Energies now = one.world().energies();
    EXPECT_GT(std::abs(now.kinetic - before), 0.01 * before);
    EXPECT_LE(std::abs(now.closure_error), 2e-8 * now.kinetic);
  }
}

/// A packing in a cell compressed along two axes and extended along the third.
Energies strained_packing(double share_of_critical, bool clumped, double friction, double damping = 0) {
  Description d = periodic("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", friction}},
                           jumble({6, 6, 6}, 1e-3, 0.005, 5), Vec3::Constant(6e-3), {-40, -30, 20});
  if (friction == 0) d["materials"]["grain"]["rolling_limit"] = 0;
  if (clumped) make_clumps(d, boomerang());
  if (damping > 0) d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", damping}};
  d["time_step"]["safety"] = share_of_critical;
  d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
  Kept cell(d);
  while (cell.world().time() < 1.5e-3) cell.step();
  return cell.world().energies();
}

TEST(Energies, OfAStrainedPackingClosesBetterWithShorterSteps) {
  for (const bool clumped : {false, true}) {
    const std::string of = clumped ? "clumps" : "spheres";
    const double smooth = closure_fraction(strained_packing(0.05, clumped, 0, 0.2));
    verify("closure error of smooth " + of + " in a cell that strains, over all that is turned over", smooth, 0, 1e-3,
           1.0);
    const Energies rough = strained_packing(0.05, clumped, 0.3);
    EXPECT_GT(std::abs(rough.cell), 0.3 * turnover(rough));
    EXPECT_GT(rough.friction, 0.1 * turnover(rough));
    // The rest is due to the law, of the order of overlap over radius.
    verify("closure error of rough " + of + " in a cell that strains, over all that is turned over",
           closure_fraction(rough), 0, 5e-3, 1.0);
    if (clumped) continue;
    verify(
        "closure error of smooth spheres in a cell that strains, over that at half of the step",
        closure_fraction(strained_packing(0.2, false, 0, 0.2)) / closure_fraction(strained_packing(0.1, false, 0, 0.2)),
        4, 0.1);
  }
}

TEST(Energies, OfAShearedPackingCloses) {
  for (const auto& [clumped, kept] : {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
    SCOPED_TRACE(clumped);
    Description d = periodic("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0.3}},
                             jumble({6, 6, 6}, 1e-3, 0.005, 5), Vec3::Constant(6e-3), {-20, -20, 0});
    if (clumped) make_clumps(d, boomerang());
    d["domain"]["shear_rate"] = {{"xy", 200}, {"xz", -400}, {"yz", 300}};
    if (kept) {
      d["domain"]["shear_rate"].erase("xy");
      d["domain"]["servo"] = {{"stress", {{"zz", 1e5}, {"xy", 2e4}}}, {"max_strain_rate", 100}, {"interval", 5}};
    }
    d["time_step"]["safety"] = 0.05;
    d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
    Kept cell(d);
    while (cell.world().time() < 1.5e-3) cell.step();
    const Energies now = cell.world().energies();
    EXPECT_GT(std::abs(now.cell), 0.1 * turnover(now));
    EXPECT_GT(now.friction, 0.1 * turnover(now));
    const std::string of = std::string(clumped ? "clumps" : "spheres") + (kept ? " at prescribed stresses" : "");
    verify("closure error of sheared " + of + ", over all that is turned over", closure_fraction(now), 0, 5e-3, 1.0);
  }
}

TEST(Energies, OfAPackingUnderPrescribedStressesCloses) {
  for (const bool clumped : {false, true}) {
    SCOPED_TRACE(clumped);
    Description d = periodic("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0.3}},
                             jumble({6, 6, 6}, 1e-3, 0.005, 5), Vec3::Constant(6e-3), {0, 0, -30});
    if (clumped) make_clumps(d, boomerang());
    d["domain"]["servo"] = {{"stress", {{"xx", 5e4}, {"yy", 1e5}}}, {"max_strain_rate", 40}, {"interval", 5}};
    d["time_step"]["safety"] = 0.05;
    d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
    Kept cell(d);
    while (cell.world().time() < 1.5e-3) cell.step();
    const Energies now = cell.world().energies();
    EXPECT_GT(std::abs(now.cell), 0.3 * turnover(now));
    verify("closure error of rough " + std::string(clumped ? "clumps" : "spheres") +
               " under prescribed stresses, over all that is turned over",
           closure_fraction(now), 0, 5e-3, 1.0);
  }
}

// In slow deformation, bodies are in equilibrium.
TEST(Energies, ACellsWorkIsThatOfItsStresses) {
  for (const bool sheared : {false, true}) {
    Description d =
        periodic("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0.3}}, jumble({6, 6, 6}, 1e-3, 0, 5),
                 Vec3::Constant(6e-3), sheared ? Vec3(-4, -4, -4) : Vec3(-8, -6, 4));
    if (sheared) d["domain"]["shear_rate"] = {{"xy", 10}, {"xz", -20}, {"yz", 15}};
    d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
    d["time_step"]["safety"] = 0.4;
    d["guards"]["overlap"] = 0.9;
    Kept cell(d);
    const auto power = [&] {
      const Cell& now = cell.world().cell();
      const Mat3 stress = mean_stress(cell.world(), {now.low, now.high});
      const Vec3 shear(stress(0, 1), stress(0, 2), stress(1, 2));
      return -(now.high - now.low).prod() * (now.strain_rate.dot(stress.diagonal()) + now.shear_rate.dot(shear));
    };
    while (cell.world().time() < 1e-3) cell.step();
    const double before = cell.world().energies().cell;
    double work = 0;
    for (double last = power(); cell.world().time() < 6e-3;) {
      const double from = cell.world().time();
      cell.step();
      const double now = power();
      work += 0.5 * (last + now) * (cell.world().time() - from), last = now;
    }
    verify("work of a cell that " + std::string(sheared ? "shears" : "strains") + " slowly over that of its stresses",
           (cell.world().energies().cell - before) / work, 1, 0.01);
  }
}

TEST(Energies, AChangeOfTheStrainRateIsPutInBySettings) {
  for (const bool clumped : {false, true}) {
    std::vector<Grain> apart = jumble({6, 6, 6}, 1e-3, 0.05, 5);
    for (Grain& grain : apart) grain.radius *= 0.85;
    Description d = periodic("linear-frictional", {{"contact_modulus", 1e7}, {"friction_angle", 0}}, apart,
                             Vec3::Constant(6e-3), Vec3::Zero());
    if (clumped) make_clumps(d, boomerang());
    d["time_step"]["safety"] = 0.1;
    d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
    const auto stage = [&](const std::string& name, const Vec3& rate) {
      d["stages"].push_back({{"name", name},
                             {"change", {{"domain", {{"strain_rate", vector(rate)}}}}},
                             {"until", {{"type", "steps"}, {"value", 1}}},
                             {"limit", 1}});
    };
    stage("fast", {-40, 30, 0}), stage("slow", {4, 0, -3});
    Kept cell(d);
    for (const int next : {1, 2}) {
      cell.step(300);
      const Energies before = cell.world().energies();
      cell.begin_stage(static_cast<std::size_t>(next), next == 1 ? "fast" : "slow");
      cell.kernel().find_forces();
      const Energies now = cell.world().energies();
      const double scale = now.kinetic + turnover(now);
      EXPECT_NEAR(now.closure_error, before.closure_error, 1e-6 * scale);
      EXPECT_NEAR(now.kinetic - before.kinetic, now.settings - before.settings, 1e-3 * scale);
      EXPECT_GT(std::abs(now.settings - before.settings), 0.05 * scale);
    }
    cell.step(300);
    const Energies now = cell.world().energies();
    EXPECT_LE(std::abs(now.closure_error), 2e-3 * (now.kinetic + turnover(now)));
  }
}

}  // namespace
}  // namespace grit::test::energy_balance_tests
