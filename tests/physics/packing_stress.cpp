// A packing in a box of smooth walls: the stress from contacts equals that from wall forces.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "support/packing.hpp"
#include "support/verified.hpp"

namespace grit::test::packing_stress_tests {
namespace {

constexpr double side_length = 6e-3;

Description boxed() {
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}}, jumble({6, 6, 6}, 1e-3, 0, 12));
  d["materials"]["smooth"] = {{"friction_angle", 0}, {"rolling_limit", 0}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][std::string(up ? "low_" : "high_") + "xyz"[axis]] =
          side(axis, up ? 0 : side_length, Vec3::Zero(), Vec3::Constant(side_length), up, "smooth");
  d["specimen"] = {{"low", {"low_x", "low_y", "low_z"}}, {"high", {"high_x", "high_y", "high_z"}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.7}};
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  d["time_step"]["steps_per_impact"] = 0;  // only the state at rest matters
  return d;
}

/// (Σ over walls of force ⊗ contact point + Σ over bodies of net force ⊗ position) / volume.
Mat3 from_outside(const World& world) {
  Mat3 sum = Mat3::Zero();
  for (const Contact& c : world.contacts())
    if (c.with_wall) sum += c.force * (xyz(world.positions()[c.a]) + c.branch).transpose();
  for (std::size_t i = 0; i < world.positions().size(); ++i)
    sum += xyz(world.forces()[i]) * xyz(world.positions()[i]).transpose();
  return sum / world.specimen().volume();
}

TEST(PackingStress, OfContactsIsThatOfWalls) {
  Trial t(boxed());
  t.step(20);
  Mat3 inside = mean_stress(t.world(), t.world().specimen());
  // Follows from Newton's law at every instant, to round-off.
  EXPECT_LT((inside - from_outside(t.world())).norm(), 1e-14 * inside.norm()) << inside << "\n\n"
                                                                              << from_outside(t.world());

  while (equilibrium(t.world()).unbalanced_force > 1e-10 && t.world().step() < 120000) t.step(100);
  ASSERT_LT(equilibrium(t.world()).unbalanced_force, 1e-10);
  inside = mean_stress(t.world(), t.world().specimen());
  Mat3 outside = Mat3::Zero();
  const auto walls = t.world().walls();
  for (int axis = 0; axis < 3; ++axis)
    for (const WallView& wall : walls)
      if (wall.name == std::string("high_") + "xyz"[axis]) outside.col(axis) = wall.force / wall.area;
  // At rest except for residual net forces.
  EXPECT_LT((inside.diagonal() - outside.diagonal()).norm(), 1e-9 * inside.norm());
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(inside(axis, axis), 1e3) << "compressed";
  EXPECT_NEAR(inside(0, 1), inside(1, 0), 1e-9 * inside.norm()) << "moments balance";
  EXPECT_EQ(outside(0, 1), 0) << "smooth walls";
}

/// Values of a probe of the description at this instant.
ChannelValues sampled(const Trial& t, const std::string& name) {
  const auto probe = t.scene().description->probes.at(name).probe.make();
  probe->prepare(t.world());
  ChannelValues values("probe " + name, probe->channels());
  probe->sample(t.world(), values);
  return values;
}

TEST(PackingStress, OfEachSliceBearsWhatItsWallsPressWith) {
  Description d = boxed();
  for (const char* axis : {"x", "y", "z"})
    d["probes"][axis] = {{"type", "stress"}, {"along", axis}, {"slices", 13}, {"every_steps", 1000}};
  Trial t(d);
  while (equilibrium(t.world()).unbalanced_force > 1e-10 && t.world().step() < 120000) t.step(100);
  ASSERT_LT(equilibrium(t.world()).unbalanced_force, 1e-10);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string letter{"xyz"[axis]};
    const auto walls = t.world().walls();
    const auto wall = std::ranges::find_if(walls, [&](const WallView& view) { return view.name == "high_" + letter; });
    ASSERT_NE(wall, walls.end());
    const Vec3 pressed = wall->force / wall->area;
    const ChannelValues values = sampled(t, letter);
    const auto profile = values.list("stress_profile_" + letter + letter);
    // The other walls are smooth: the normal force on any section across the axis is that of the end wall.
    for (std::size_t s = 0; s < 13; ++s)
      EXPECT_NEAR(profile[s], pressed[axis], 1e-8 * pressed.norm()) << letter << ", slice " << s;
    EXPECT_GT(pressed.norm(), 1e3) << "compressed";
  }
}

TEST(PackingStress, CouplesChangeAsForcesAreAsymmetric) {
  // At rest between a rough floor and a rough lid, periodic laterally: as moments on grains are in equilibrium, the
  // change of couple stress from section to section equals the skew part of the stress in between.
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}}, jumble({6, 6, 6}, 1e-3, 0, 12));
  d["domain"] = {{"low", {0, 0, -1e-3}}, {"high", {side_length, side_length, side_length + 1e-3}}};
  d["domain"]["periodic"] = {true, true, false};
  const Vec3 low(-side_length, -side_length, 0), high(2 * side_length, 2 * side_length, 0);
  d["walls"]["floor"] = side(2, 0, low, high, true);
  d["walls"]["lid"] = side(2, side_length, low, high, false);
  d["specimen"] = {{"low", {"", "", "floor"}}, {"high", {"", "", "lid"}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.7}};
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  constexpr std::size_t slices = 600;
  d["probes"]["z"] = {{"type", "stress"}, {"slices", slices}, {"every_steps", 1000}};
  Trial t(d);
  while (equilibrium(t.world()).unbalanced_force > 1e-7 && t.world().step() < 60000) t.step(100);
  ASSERT_LT(equilibrium(t.world()).unbalanced_force, 1e-7);
  const ChannelValues values = sampled(t, "z");
  const double thickness = side_length / slices;
  const auto couple_at = [&](std::size_t s) {
    const auto of = [&](const char* ij) { return values.list("couple_stress_profile_" + std::string(ij))[s]; };
    return Vec3(of("xz"), of("yz"), of("zz"));
  };
  const auto skew_at = [&](std::size_t s) {
    const auto of = [&](const char* ij) { return values.list("stress_profile_" + std::string(ij))[s]; };
    return Vec3(of("zy") - of("yz"), of("xz") - of("zx"), of("yx") - of("xy"));
  };
  // From midway between the first two layers of grains to midway between the last two.
  const std::size_t from = 100, to = 500;
  Vec3 changed = couple_at(to) - couple_at(from), balance = changed;
  for (std::size_t s = from; s < to; ++s) balance += 0.5 * thickness * (skew_at(s) + skew_at(s + 1));
  double largest = 0;
  for (std::size_t s = from; s <= to; ++s) largest = std::max(largest, couple_at(s).norm());
  EXPECT_LT(balance.norm(), 1e-4 * largest) << balance.transpose() << " of " << changed.transpose();
  EXPECT_GT(changed.norm(), 1e-3 * largest) << "not zero";
}

Mat3 stress_at_rest(const Description& d) {
  Trial t(d);
  t.step(10000);
  EXPECT_LT(equilibrium(t.world()).unbalanced_force, 1e-4);
  return mean_stress(t.world(), t.world().specimen());
}

/// linear-rolling with pairs evaluated one by one as scalars.
class ScalarTwin final : public ContactLaw {
 public:
  static PluginInfo plugin() {
    PluginInfo info;
    info.kind = "contact", info.name = "scalar-twin", info.version = "1", info.doc = "linear-rolling by plain scalars";
    info.make_contact = []() -> ContactLaw* { return new ScalarTwin; };
    return info;
  }
  static inline std::size_t batches = 0;

  void declare(Parameters& parameters) override { law_->declare(parameters); }
  void clear_materials() override { law_->clear_materials(); }
  void declare_material(const std::string& name, Parameters& parameters) override {
    law_->declare_material(name, parameters);
  }
  void declare_interface(const std::string& a, const std::string& b, Parameters& parameters) override {
    law_->declare_interface(a, b, parameters);
  }
  void mix(std::span<const std::string> materials, std::size_t of_bodies) override { law_->mix(materials, of_bodies); }
  std::vector<StateField> state() const override { return law_->state(); }
  LawLoop loop() const override { return law_->loop(); }
  void evaluate_pairs(PairBatch& batch) const noexcept override {
    ++batches;
    law_->evaluate_pairs_reference(batch);
  }
  void evaluate_walls(WallBatch& batch) const noexcept override { law_->evaluate_walls(batch); }
  void evaluate_pairs_reference(PairBatch& batch) const noexcept override { law_->evaluate_pairs_reference(batch); }
  Stiffness stiffness(const PairSize& pair, std::size_t a, std::size_t b) const override {
    return law_->stiffness(pair, a, b);
  }
  std::vector<double> mixed(std::size_t a, std::size_t b, bool wall) const override { return law_->mixed(a, b, wall); }
  ElasticEnergy energy(const PairSize& pair, std::size_t a, std::size_t b,
                       std::span<const double> state) const override {
    return law_->energy(pair, a, b, state);
  }

 private:
  std::shared_ptr<ContactLaw> law_ = installed().make<ContactLaw>("linear-rolling");
};

TEST(PackingStress, IsThatOfTheScalarTwin) {
  installed().add(ScalarTwin::plugin());
  Description d = boxed();
  const Mat3 lanes = stress_at_rest(d);
  ScalarTwin::batches = 0;
  d["contacts"]["type"] = "scalar-twin";
  const Mat3 scalars = stress_at_rest(d);
  EXPECT_GT(ScalarTwin::batches, 10000u);
  verify("mean stress after 10 000 steps in SIMD lanes against plain scalars, Pa", lanes.trace() / 3,
         scalars.trace() / 3, 1e-5);
  EXPECT_LT((lanes - scalars).norm(), 1e-5 * scalars.norm());
}

TEST(PackingStress, IsTheSameInSinglePrecision) {
  const auto at_rest = [](const char* precision) {
    Description d = boxed();
    d["contacts"]["precision"] = precision;
    return stress_at_rest(d);
  };
  const Mat3 exact = at_rest("double"), rounded = at_rest("single");
  verify("mean stress after 10 000 steps in single precision against double, Pa", rounded.trace() / 3,
         exact.trace() / 3, 5e-6);
  EXPECT_LT((rounded - exact).norm(), 1e-4 * exact.norm());
  EXPECT_GT((rounded - exact).norm(), 0) << "evaluated in double precision";
}

}  // namespace
}  // namespace grit::test::packing_stress_tests
