#include "grit/testing/contact_law.hpp"

#include <algorithm>

#include "grit/testing/energy_paths.hpp"

namespace grit::test {

int contact_law_contract() { return 0; }

namespace {

TEST_P(ContactLawContract, KeepsOnlyTheHistoryThatItsParametersNeed) {
  EXPECT_EQ(law_->state().size(), GetParam().state_size);
  for (const StateField& field : law_->state()) {
    EXPECT_EQ(std::abs(field.swap), 1);
    EXPECT_FALSE(field.unit.empty());
  }
}

TEST_P(ContactLawContract, LanesAgreeWithScalarTwin) {
  const auto fields = law_->state();
  for (const auto& [periodic, materials, lonely] : {std::array{false, false, false},
                                                    {false, true, false},
                                                    {true, false, false},
                                                    {true, true, false},
                                                    {false, false, true},
                                                    {true, true, true}}) {
    Pairs lanes = scene(periodic, materials, lonely), twin = lanes;
    lanes.evaluate(), twin.evaluate_reference();
    int touching = 0;
    for (std::size_t c = 0; c < lanes.places(); ++c) {
      ASSERT_EQ(lanes.touching(c), twin.touching(c));
      if (!lanes.touching(c)) continue;
      ++touching;
      // If spring and attraction nearly cancel, their sum has the rounding errors of each.
      const double spring = GetParam().attracts ? spring_force(lanes, c) : 0;
      const double eps = round_off(lanes, c), force = std::max(scale(lanes, c, "N"), spring),
                   moment = scale(lanes, c, "N m");
      EXPECT_LE((vec(lanes.row(c).force) - vec(twin.row(c).force)).norm(), eps * force) << c;
      EXPECT_LE((vec(lanes.row(c).moment) - vec(twin.row(c).moment)).norm(), eps * moment) << c;
      EXPECT_NEAR(lanes.row(c).force.w, twin.row(c).force.w, eps * force) << c;
      EXPECT_NEAR(lanes.overlap(c), twin.overlap(c), eps * std::abs(twin.overlap(c))) << c;
      const auto a = lanes.a(c);
      EXPECT_LE((vec(lanes.sum(a).force) - vec(twin.sum(a).force)).norm(), eps * force) << c;
      EXPECT_LE((vec(lanes.sum(a).moment) - vec(twin.sum(a).moment)).norm(), eps * moment) << c;
      for (std::size_t f = 0; f < fields.size(); ++f)
        EXPECT_NEAR(lanes.state(c, f), twin.state(c, f), eps * scale(lanes, c, fields[f].unit)) << c << fields[f].name;
    }
    EXPECT_NEAR(lanes.largest_overlap(), twin.largest_overlap(), 1e-13);
    EXPECT_GT(touching, lonely ? 70 : 20);
    EXPECT_LT(touching, lonely ? 174 : 58);
  }
}

TEST_P(ContactLawContract, DevicesAgreeWithTheScalarTwin) {
  if (!law_->device()) GTEST_SKIP() << "devices cannot evaluate the law";
  const auto fields = law_->state();
  for (const bool periodic : {false, true})
    for (const bool materials : {false, true}) {
      Pairs device = scene(periodic, materials, false), twin = device;
      EXPECT_TRUE(device.evaluate_on_device()) << "the two bodies of a pair differ";
      twin.evaluate_reference();
      std::vector<Vec3> force(twin.count(), Vec3::Zero()), moment = force;
      std::vector<double> forces(twin.count(), 0.0), moments = forces, eps = forces;  // sums of magnitudes
      for (std::size_t c = 0; c < twin.places(); ++c) {
        ASSERT_EQ(device.touching(c), twin.touching(c)) << c;
        if (!twin.touching(c)) continue;
        if (law_->has_reach()) EXPECT_EQ(device.acts(c), twin.acts(c)) << c;
        const auto a = twin.a(c), b = twin.b(c);
        force[b] += vec(twin.row(c).force), moment[b] += vec(twin.row(c).moment);
        const double spring = GetParam().attracts ? spring_force(twin, c) : 0;
        for (const auto body : {a, b}) {
          forces[body] += std::max(scale(twin, c, "N"), spring), moments[body] += scale(twin, c, "N m");
          eps[body] = std::max(eps[body], round_off(twin, c));
        }
        for (std::size_t f = 0; f < fields.size(); ++f)
          EXPECT_NEAR(device.state(c, f), twin.state(c, f), round_off(twin, c) * scale(twin, c, fields[f].unit))
              << c << fields[f].name;
      }
      for (std::size_t i = 0; i < twin.count(); ++i) {
        EXPECT_LE((vec(device.sum(i).force) - vec(twin.sum(i).force) - force[i]).norm(), eps[i] * forces[i]) << i;
        EXPECT_LE((vec(device.sum(i).moment) - vec(twin.sum(i).moment) - moment[i]).norm(), eps[i] * moments[i]) << i;
      }
      EXPECT_NEAR(device.largest_overlap(), twin.largest_overlap(), 1e-13);
    }
}

/// The law in single precision.
std::unique_ptr<ContactLaw> single_law(LawValues values) {
  values.settings["precision"] = "single";
  return make_law(values);
}

TEST_P(ContactLawContract, SinglePrecisionIsThatOfItsScalarTwinAndNearDouble) {
  if (!has_single_precision()) GTEST_SKIP() << "the law has no single precision";
  const auto fields = law_->state();
  auto single = single_law(GetParam().values);
  ASSERT_EQ(single->state().size(), fields.size());
  EXPECT_EQ(law_->loop().precision, "double");
  EXPECT_EQ(single->loop().precision, "single");
  // Some tens of rounding errors of 2^-24 each; forces accumulate over 31 steps.
  constexpr double eps = 5e-6;
  for (const bool periodic : {false, true})
    for (const bool materials : {false, true})
      for (const bool lonely : {false, true}) {
        random_.seed(11);
        Pairs exact = scene(periodic, materials, lonely);
        std::swap(law_, single);
        random_.seed(11);
        Pairs lanes = scene(periodic, materials, lonely), twin = lanes;
        std::swap(law_, single);
        exact.evaluate(), lanes.evaluate(), twin.evaluate_reference();
        double furthest = 0;
        for (std::size_t c = 0; c < exact.places(); ++c) {
          ASSERT_EQ(lanes.touching(c), exact.touching(c));
          ASSERT_EQ(twin.touching(c), exact.touching(c));
          if (!exact.touching(c)) continue;
          // If spring and dashpot nearly cancel, their sum has the rounding errors of each.
          const double force = std::max(scale(exact, c, "N"), spring_force(exact, c));
          const auto scale_of = [&](const std::string& unit) {
            return unit == "N" ? force : unit == "N m" ? force * exact.position(exact.a(c)).w : scale(exact, c, unit);
          };
          const double moment = scale_of("N m");
          for (Pairs* other : {&exact, &twin}) {
            EXPECT_LE((vec(lanes.row(c).force) - vec(other->row(c).force)).norm(), eps * force) << c;
            EXPECT_LE((vec(lanes.row(c).moment) - vec(other->row(c).moment)).norm(), eps * moment) << c;
            EXPECT_NEAR(lanes.overlap(c), other->overlap(c), 1e-6 * std::abs(exact.overlap(c))) << c;
            for (std::size_t f = 0; f < fields.size(); ++f)
              EXPECT_NEAR(lanes.state(c, f), other->state(c, f), eps * scale_of(fields[f].unit)) << c << fields[f].name;
          }
          furthest = std::max(furthest, (vec(lanes.row(c).force) - vec(exact.row(c).force)).norm() / force);
        }
        EXPECT_GT(furthest, 1e-9) << "evaluated in double precision";
      }
}

TEST_P(ContactLawContract, BlockWithoutContactsIsSkippedUntilOneIsPossible) {
  sleeps_until_one_can(*law_);
  if (has_single_precision()) sleeps_until_one_can(*single_law(GetParam().values));
}

TEST_P(ContactLawContract, LanesWithoutContactAreZero) {
  Pairs pairs = scene(true, true);
  for (std::size_t c = 0; c < pairs.places(); ++c) {
    const ContactRow& row = pairs.row(c);
    for (const Row& r : {row.force, row.moment})
      for (const double x : {r.x, r.y, r.z, r.w}) {
        EXPECT_TRUE(std::isfinite(x));
        if (!pairs.touching(c)) {
          EXPECT_EQ(x, 0);
        }
      }
    for (const double x : pairs.state(c)) {
      EXPECT_TRUE(std::isfinite(x));
      if (!pairs.touching(c)) {
        EXPECT_EQ(x, 0);
      }
    }
  }
  for (std::size_t i = 0; i < pairs.count(); ++i)
    EXPECT_TRUE(vec(pairs.sum(i).force).allFinite() && vec(pairs.sum(i).moment).allFinite());
}

TEST_P(ContactLawContract, PositionInBlockDoesNotMatter) {
  const auto result = [&](std::size_t place, bool company) {
    random_.seed(7);
    Pairs pairs(*law_, dt_);
    pairs.add({vector(1), 1, vector(1), vector(5)});
    const Vec3 centre = vec(pairs.position(0));
    pairs.add({centre + 1.65 * direction(), 0.7, vector(1), vector(5)});
    random_.seed(static_cast<unsigned>(place));
    for (std::size_t c = 0; c < 2 * block_size; ++c) {
      if (c == place) pairs.pair(0, 1);
      else if (!company) pairs.skip();
      else {
        const auto a = pairs.add({vector(9), 1, vector(1), vector(5)});
        const auto b = pairs.add({vec(pairs.position(a)) + uniform(1.6, 1.8) * direction(), 0.7, vector(9), vector(9)});
        pairs.pair(a, b);
      }
    }
    for (int step = 0; step < 5; ++step) pairs.step();
    EXPECT_TRUE(pairs.touching(place));
    struct Bits {
      ContactRow row;
      BodySum sum;
      std::vector<double> state;
    };
    return Bits{pairs.row(place), pairs.sum(0), pairs.state(place)};
  };
  const auto first = result(0, false);
  for (std::size_t place = 0; place < 2 * block_size; ++place)
    for (const bool company : {false, true}) {
      const auto other = result(place, company);
      EXPECT_EQ(std::memcmp(&first.row, &other.row, sizeof first.row), 0) << place;
      EXPECT_EQ(std::memcmp(&first.sum.force, &other.sum.force, 3 * sizeof(double)), 0) << place;
      EXPECT_EQ(std::memcmp(&first.sum.moment, &other.sum.moment, 3 * sizeof(double)), 0) << place;
      EXPECT_EQ(first.state, other.state) << place;
    }
}

TEST_P(ContactLawContract, WithinAChunkBothBodiesHaveTheirSums) {
  for (const bool periodic : {false, true}) {
    Pairs across = scene(periodic, true), within = across;
    across.evaluate(), within.evaluate_within();
    std::vector<BodySum> expected;
    for (std::size_t i = 0; i < across.count(); ++i) expected.push_back(across.sum(i));
    for (std::size_t c = 0; c < across.places(); ++c)
      if (across.touching(c)) {
        expected[across.b(c)].force += across.row(c).force;
        expected[across.b(c)].moment += across.row(c).moment;
      }
    for (std::size_t i = 0; i < across.count(); ++i) {
      const Vec3 force = vec(expected[i].force), moment = vec(expected[i].moment);
      EXPECT_LE((vec(within.sum(i).force) - force).norm(), 1e-15 * force.norm()) << i;
      EXPECT_LE((vec(within.sum(i).moment) - moment).norm(), 1e-15 * moment.norm()) << i;
    }
    for (std::size_t c = 0; c < across.places(); ++c) EXPECT_EQ(within.state(c), across.state(c)) << c;
  }
}

TEST_P(ContactLawContract, EvaluatedAgainGivesTheSameForceAndHistory) {
  const auto fields = law_->state();
  Pairs pairs = scene(true, true);
  Pairs once = pairs;
  pairs.evaluate_again();
  for (std::size_t c = 0; c < pairs.places(); ++c) {
    ASSERT_EQ(pairs.touching(c), once.touching(c));
    if (!pairs.touching(c)) continue;
    const double force = scale(pairs, c, "N"), moment = scale(pairs, c, "N m");
    EXPECT_LE((vec(pairs.row(c).force) - vec(once.row(c).force)).norm(), 1e-14 * force) << c;
    EXPECT_LE((vec(pairs.row(c).moment) - vec(once.row(c).moment)).norm(), 1e-14 * moment) << c;
    EXPECT_EQ(pairs.row(c).force.w, once.row(c).force.w) << c;
    for (std::size_t f = 0; f < fields.size(); ++f)
      EXPECT_NEAR(pairs.state(c, f), once.state(c, f), 1e-14 * scale(pairs, c, fields[f].unit)) << c << fields[f].name;
  }
}

TEST_P(ContactLawContract, ForcesAndMomentsBalance) {
  Pairs pairs = scene(true, true);
  for (std::size_t c = 0; c < pairs.places(); ++c) {
    if (!pairs.touching(c)) continue;
    const BodySum& on_a = pairs.sum(pairs.a(c));
    const ContactRow& on_b = pairs.row(c);
    EXPECT_EQ(vec(on_a.force), -vec(on_b.force));
    const Vec3 spin = vec(on_a.moment) + vec(on_b.moment) + branch(pairs, c).cross(vec(on_b.force));
    EXPECT_LE(spin.norm(), 1e-14 * vec(on_b.force).norm() * (1 + branch(pairs, c).norm())) << c;
  }
}

TEST_P(ContactLawContract, FrameDoesNotMatter) {
  Pairs here = scene(true, true), there = here;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.3, -0.8, 0.1, 0.6).normalized();
  const auto rotate = [&](Row& row) { set(row, turn * vec(row)); };
  for (std::size_t i = 0; i < there.count(); ++i)
    rotate(there.position(i)), rotate(there.velocity(i)), rotate(there.spin(i));
  for (ImageShift& shift : there.shifts) rotate(shift.position), rotate(shift.velocity);
  const auto fields = law_->state();
  const auto rotate_state = [&](Pairs& pairs, std::size_t c) {
    for (std::size_t f = 0; f + 2 < fields.size(); ++f) {
      if (!fields[f].name.ends_with("_x")) continue;
      const Vec3 v = turn * Vec3(pairs.state(c, f), pairs.state(c, f + 1), pairs.state(c, f + 2));
      for (int k = 0; k < 3; ++k) pairs.state(c, f + as_index(k)) = v[k];
    }
  };
  for (std::size_t c = 0; c < there.places(); ++c) rotate_state(there, c);
  here.step(), there.step();
  for (std::size_t c = 0; c < here.places(); ++c) {
    ASSERT_EQ(here.touching(c), there.touching(c));
    if (!here.touching(c)) continue;
    const double eps = 30 * round_off(here, c);
    EXPECT_LE((turn * vec(here.row(c).force) - vec(there.row(c).force)).norm(), eps * scale(here, c, "N"));
    EXPECT_LE((turn * vec(here.row(c).moment) - vec(there.row(c).moment)).norm(), eps * scale(here, c, "N m"));
    rotate_state(here, c);
    for (std::size_t f = 0; f < fields.size(); ++f)
      EXPECT_NEAR(here.state(c, f), there.state(c, f), eps * scale(here, c, fields[f].unit)) << fields[f].name;
  }
}

TEST_P(ContactLawContract, OrderOfTheTwoDoesNotMatter) {
  Pairs one = scene(false, true), other(*law_, dt_);
  other.one_material = false;
  const auto fields = law_->state();
  for (std::size_t i = 0; i < one.count(); ++i) {
    other.add({vec(one.position(i)), one.position(i).w, vec(one.velocity(i)), vec(one.spin(i)), 1 / one.velocity(i).w,
               one.material(i)});
  }
  for (std::size_t c = 0; c < one.places(); ++c) {
    if (one.b(c) == one.count()) {
      other.skip();
      continue;
    }
    other.pair(one.b(c), one.a(c));
    if (one.touching(c)) other.mark_contacts(c);
    for (std::size_t f = 0; f < fields.size(); ++f) other.state(c, f) = fields[f].swap * one.state(c, f);
  }
  one.step(), other.step();
  for (std::size_t c = 0; c < one.places(); ++c) {
    ASSERT_EQ(one.touching(c), other.touching(c));
    if (!one.touching(c)) continue;
    const double eps = round_off(one, c), force = scale(one, c, "N"), moment = scale(one, c, "N m");
    EXPECT_LE((vec(one.row(c).force) + vec(other.row(c).force)).norm(), eps * force);
    EXPECT_LE((vec(one.sum(one.a(c)).moment) - vec(other.row(c).moment)).norm(), eps * moment);
    EXPECT_LE((vec(one.row(c).moment) - vec(other.sum(one.b(c)).moment)).norm(), eps * moment);
    for (std::size_t f = 0; f < fields.size(); ++f)
      EXPECT_NEAR(one.state(c, f), fields[f].swap * other.state(c, f), eps * scale(one, c, fields[f].unit));
  }
}

TEST_P(ContactLawContract, PairThatRotatesAsOneBodyDoesNotSlip) {
  Pairs pairs = two(0.05);
  slip(pairs, 2e-3), roll(pairs, 1e-3);
  const auto fields = law_->state();
  const std::vector<double> stored = pairs.state(0);
  const Vec3 axis = Vec3(0.5, -0.7, 0.4).normalized(), middle(0.1, 0.2, 0.3);
  constexpr double angle = 1e-4;
  const Eigen::AngleAxisd turn(angle, axis);
  Vec3 a = vec(pairs.position(0)), b = vec(pairs.position(1));
  constexpr int steps = 12000;
  for (int step = 0; step < steps; ++step) {
    const Vec3 next_a = middle + turn * (a - middle), next_b = middle + turn * (b - middle);
    set(pairs.velocity(0), (next_a - a) / dt_), set(pairs.velocity(1), (next_b - b) / dt_);
    set(pairs.spin(0), angle / dt_ * axis), set(pairs.spin(1), angle / dt_ * axis);
    pairs.step();
    a = next_a, b = next_b;
  }
  const Eigen::AngleAxisd whole(steps * angle, axis);
  double size = 0;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].name.ends_with("_x")) {
      const Vec3 before(stored[f], stored[f + 1], stored[f + 2]);
      const Vec3 now(pairs.state(0, f), pairs.state(0, f + 1), pairs.state(0, f + 2));
      EXPECT_LE((now - whole * before).norm(), 1e-5 * before.norm()) << fields[f].name;
      size += before.norm();
      f += 2;
    } else {
      EXPECT_NEAR(pairs.state(0, f), stored[f], 1e-5 * std::abs(stored[f]) + 1e-9) << fields[f].name;
      size += std::abs(stored[f]);
    }
  }
  if (!fields.empty()) {
    EXPECT_GT(size, 0);
  }
}

TEST_P(ContactLawContract, NeverAttracts) {
  if (GetParam().attracts) GTEST_SKIP() << "the law attracts";
  for (const double speed : {-50.0, -1.0, 1.0, 50.0}) {
    Pairs pairs = two(0.02);
    for (int step = 0; step < 200; ++step) {
      set(pairs.velocity(1), {0.3, 0, speed});
      pairs.step();
      EXPECT_GE(pairs.row(0).force.w, 0);
      EXPECT_GE(vec(pairs.row(0).force).dot(branch(pairs, 0)), -1e-13 * vec(pairs.row(0).force).norm());
    }
  }
}

/// Parameters of materials and interfaces that remove a spring if they are 0.
std::vector<std::string> switches(const LawValues& values) {
  const Stiffness on = make_law(values)->stiffness({1, 0.7, 1, 1, 0.02}, 0, 0);
  Parameters parameters;
  std::unique_ptr<ContactLaw>(grit_plugin()->make_contact())->declare_material("any", parameters);
  std::vector<std::string> names;
  for (const Parameter& p : parameters.entries()) {
    if (!std::holds_alternative<double*>(p.target()) || !p.allows(0)) continue;
    const Stiffness off = make_law(without(values, p.name()))->stiffness({1, 0.7, 1, 1, 0.02}, 0, 0);
    if ((on.shear > 0 && off.shear == 0) || (on.rolling > 0 && off.rolling == 0) ||
        (on.twisting > 0 && off.twisting == 0))
      names.push_back(p.name());
  }
  return names;
}

/// A spring that was removed for some time restarts unloaded, whether or not the other springs of the law were kept.
TEST_P(ContactLawContract, SpringsThatWereOffComeBackUnloaded) {
  const Stiffness k = law_->stiffness({1, 0.7, 1, 1, 0.02}, 0, 0);
  const std::vector<std::string> names = switches(GetParam().values);
  EXPECT_EQ(names.empty(), k.shear == 0 && k.rolling == 0 && k.twisting == 0);
  for (const std::string& name : names)
    for (const bool everywhere : {true, false})
      for (const auto evaluate : {&Pairs::evaluate, &Pairs::evaluate_reference}) {
        const auto off = make_law(without(GetParam().values, name, everywhere));
        Pairs pairs = two(0.02);
        slip(pairs, 1e-3), roll(pairs, 1e-3), twist(pairs, 1e-3);
        pairs.change(*off), (pairs.*evaluate)();
        const ContactRow without_it = pairs.row(0);
        const double stored = off->energy(size(pairs, 0.02), 0, 0, pairs.state(0)).total();
        pairs.change(*law_), (pairs.*evaluate)();
        const ContactRow& now = pairs.row(0);
        const double eps = 1e-12 * std::abs(without_it.force.w);
        EXPECT_LE((vec(now.force) - vec(without_it.force)).norm(), eps) << name;
        EXPECT_LE((vec(now.moment) - vec(without_it.moment)).norm(), eps) << name;
        EXPECT_NEAR(law_->energy(size(pairs, 0.02), 0, 0, pairs.state(0)).total(), stored, 1e-12 * std::abs(stored))
            << name;
      }
}

TEST_P(ContactLawContract, SpringsOnWallsThatWereOffComeBackUnloaded) {
  for (const std::string& name : switches(GetParam().values)) {
    const auto off = make_law(without(GetParam().values, name));
    WallPair wall(*law_, {.radius = 0.8, .spin = {30, -20, 40}}, dt_);
    wall.contact.overlap = 0.01;
    wall.evaluate();
    set(wall.spin, Vec3::Zero());
    wall.evaluate();
    wall.change(*off), wall.evaluate();
    const ContactRow without_it = wall.row;
    wall.change(*law_), wall.evaluate();
    const double eps = 1e-12 * std::abs(without_it.force.w);
    EXPECT_LE((vec(wall.row.force) - vec(without_it.force)).norm(), eps) << name;
    EXPECT_LE((vec(wall.row.moment) - vec(without_it.moment)).norm(), eps) << name;
  }
}

TEST_P(ContactLawContract, LimitsHold) {
  if (!GetParam().usual_limits) GTEST_SKIP() << "the law has other limits";
  Pairs pairs = scene(false, true);
  for (std::size_t c = 0; c < pairs.places(); ++c) {
    if (!pairs.touching(c)) continue;
    const std::size_t a = pairs.material(pairs.a(c)), b = pairs.material(pairs.b(c));
    const double normal = pairs.row(c).force.w, coulomb = std::tan(smaller(a, b, "friction_angle"));
    EXPECT_LE(shear(pairs, c).norm(), coulomb * normal * (1 + 1e-12) + 1e-12 * normal);
    const Vec3 n = branch(pairs, c).normalized(), moment = law_moment(pairs, c);
    const double arm = 0.5 * (pairs.position(pairs.a(c)).w + pairs.position(pairs.b(c)).w);
    EXPECT_LE((moment - moment.dot(n) * n).norm(), (smaller(a, b, "rolling_limit") * arm + 1e-12) * normal);
    EXPECT_LE(std::abs(moment.dot(n)), (smaller(a, b, "twisting_limit") * arm + 1e-12) * normal);
  }
}

TEST_P(ContactLawContract, LimitsAreReached) {
  if (!GetParam().usual_limits) GTEST_SKIP() << "the law has other limits";
  Pairs pairs = two(0.01);
  const PairSize at = size(pairs, 0.01);
  const Stiffness k = law_->stiffness(at, 0, 0);
  for (int step = 0; step < 400; ++step) {
    set(pairs.spin(0), {0, 0, -30}), set(pairs.spin(1), {0, 400, 30});
    pairs.step();
  }
  const double normal = pairs.row(0).force.w, arm = 0.85;
  if (k.shear > 0) {
    EXPECT_NEAR(shear(pairs, 0).norm(), std::tan(value(0, "friction_angle")) * normal, 1e-9 * normal);
  }
  const Vec3 moment = law_moment(pairs, 0);
  if (k.rolling > 0) {
    EXPECT_NEAR(std::abs(moment.y()), value(0, "rolling_limit") * arm * normal, 1e-9 * normal);
  }
  if (k.twisting > 0) {
    EXPECT_NEAR(std::abs(moment.z()), value(0, "twisting_limit") * arm * normal, 1e-9 * normal);
  }
}

TEST_P(ContactLawContract, SeparationClearsTheHistory) {
  Pairs pairs = two(0.02), fresh = two(0.02);
  slip(pairs, 1e-3), roll(pairs, 1e-3), twist(pairs, 1e-3);
  EXPECT_TRUE(pairs.touching(0));
  move(pairs, {0, 0, 1.71 + law_->reach(size(pairs, 0), 0, 0)});
  EXPECT_FALSE(pairs.touching(0));
  for (const Row& r : {pairs.row(0).force, pairs.row(0).moment})
    for (const double x : {r.x, r.y, r.z, r.w}) EXPECT_EQ(x, 0);
  for (const double x : pairs.state(0)) EXPECT_EQ(x, 0);
  move(pairs, {0, 0, 1.68}), rest(pairs), pairs.step();
  fresh.step();
  EXPECT_LE((vec(pairs.row(0).force) - vec(fresh.row(0).force)).norm(), 1e-12 * vec(fresh.row(0).force).norm());
  EXPECT_LE(vec(pairs.row(0).moment).norm(), 1e-12 * vec(fresh.row(0).force).norm());
}

/// From beyond the reach into contact and back, and to and fro within the reach, without contact.
TEST_P(ContactLawContract, ActsUpToItsReachAndYieldsNoEnergy) {
  if (!law_->has_reach()) GTEST_SKIP() << "the law acts in contact only";
  Pairs pairs = two(-1);
  const double reach = law_->reach(size(pairs, 0), 0, 0), step = 1e-3 * std::max(reach, 1e-4);
  const bool apart = reach > 1e-9;  // more than rounding
  const auto overlap_at = [&](double overlap) { move(pairs, {0, 0, 1.7 - overlap}); };
  const auto energy = [&](double overlap) { return law_->energy(size(pairs, overlap), 0, 0, pairs.state(0)).normal; };
  double work = 0, turnover = 0;
  const auto go = [&](double from, double to) {
    overlap_at(from);
    const int steps = static_cast<int>(std::ceil(std::abs(to - from) / step));
    for (int k = 1; k <= steps; ++k) {
      const double before = pairs.row(0).force.w;
      overlap_at(from + (to - from) * k / steps);
      const double share = -0.5 * (before + pairs.row(0).force.w) * (to - from) / steps;
      work += share, turnover += std::abs(share);
    }
  };
  go(-1.1 * reach - step, -1.01 * reach);
  EXPECT_FALSE(pairs.touching(0));
  go(-0.99 * reach, -0.01 * reach);
  EXPECT_EQ(pairs.touching(0), apart);
  go(-0.01 * reach, -0.99 * reach), go(-0.99 * reach, -1.01 * reach - step);
  EXPECT_FALSE(pairs.touching(0));
  EXPECT_LE(work, 1e-9 * turnover) << "without contact";
  work = turnover = 0;
  go(-1.01 * reach - step, 1e-6);
  EXPECT_TRUE(pairs.touching(0));
  EXPECT_TRUE(pairs.acts(0));
  EXPECT_LE(std::abs(energy(1e-12)), 1e-9 * std::abs(pairs.row(0).force.w));
  go(1e-6, 0.01), go(0.01, -0.999 * reach);
  EXPECT_EQ(pairs.touching(0), apart);
  EXPECT_GE(energy(-0.999 * reach), 0);
  go(-0.999 * reach, -1.01 * reach - step);
  EXPECT_FALSE(pairs.touching(0));
  EXPECT_FALSE(pairs.acts(0));
  EXPECT_LE(work, 1e-3 * turnover) << "with contact";
}

TEST_P(ContactLawContract, NoReachIsLargerThanThatOfTheLargest) {
  const auto reach = [&](double a, double b, bool wall) {
    return law_->reach(
        {.radius_a = a, .radius_b = b, .inverse_mass_a = 1, .inverse_mass_b = 1, .overlap = 0, .wall = wall}, 0, 1);
  };
  const auto largest = [&](double radius) {
    const std::vector<double> all = law_->reaches(radius);
    return all.empty() ? 0 : *std::ranges::max_element(all);
  };
  EXPECT_EQ(law_->reaches(1).empty(), !law_->has_reach());
  for (const double other : {0.01, 0.1, 0.5, 1.0})
    for (const bool wall : {false, true}) EXPECT_LE(reach(wall ? 1 : other, 1, wall), largest(1)) << other;
  EXPECT_LE(largest(1.1), 1.1 * largest(1) * (1 + 1e-12));
}

TEST_P(ContactLawContract, ForceIsTheSlopeOfTheEnergy) {
  for (const double overlap : {1e-3, 0.02, 0.1}) {
    Pairs pairs = two(overlap);
    pairs.step();
    const auto energy = [&](double at) {
      return law_->energy(size(pairs, at), 0, 0, std::vector<double>(pairs.fields(), 0.0)).total();
    };
    const double h = 1e-4 * overlap;
    EXPECT_NEAR((energy(overlap + h) - energy(overlap - h)) / (2 * h), pairs.row(0).force.w,
                1e-7 * std::abs(pairs.row(0).force.w));
    const auto slope = [&](auto go, double start, double little) {
      Pairs more = two(overlap);
      go(more, start);
      Pairs less = more, at = more;
      go(more, little), go(less, -little);
      const auto stored = [&](Pairs& p) { return law_->energy(size(p, overlap), 0, 0, p.state(0)).total(); };
      return std::pair((stored(more) - stored(less)) / (2 * little), at);
    };
    auto [force, slipped] = slope(slip, 1e-2 * overlap, 1e-4 * overlap);
    EXPECT_NEAR(force, law_shear(slipped, 0).norm(), 1e-6 * law_shear(slipped, 0).norm() + 1e-9);
    auto [moment, rolled] = slope(roll, 1e-2 * overlap, 1e-4 * overlap);
    EXPECT_NEAR(moment, law_moment(rolled, 0).norm(), 1e-6 * law_moment(rolled, 0).norm() + 1e-9);
    auto [torque, twisted] = slope(twist, 1e-2 * overlap, 1e-4 * overlap);
    EXPECT_NEAR(torque, law_moment(twisted, 0).norm(), 1e-6 * law_moment(twisted, 0).norm() + 1e-9);
  }
}

TEST_P(ContactLawContract, WorkOnBodiesIsStoredOrReportedAsLost) {
  for (const std::string& fault : energy_faults(*law_, GetParam().losses)) ADD_FAILURE() << fault;
}

TEST_P(ContactLawContract, StiffnessIsTheSlopeOfTheForce) {
  for (const double overlap : {2e-3, 0.05}) {
    const auto normal = [&](double at) {
      Pairs pairs = two(at);
      pairs.step();
      return pairs.row(0).force.w;
    };
    Pairs slipped = two(overlap), rolled = slipped, twirled = slipped;
    const Stiffness k = law_->stiffness(size(slipped, overlap), 0, 0);
    const double h = 1e-4 * overlap, little = 1e-3 * overlap;
    EXPECT_NEAR((normal(overlap + h) - normal(overlap - h)) / (2 * h), k.normal, 1e-6 * k.normal);
    slip(slipped, little), roll(rolled, little), twist(twirled, little);
    EXPECT_NEAR(law_shear(slipped, 0).norm() / little, k.shear, 1e-9 * k.shear);
    EXPECT_NEAR(law_moment(rolled, 0).norm() / little, k.rolling, 1e-9 * k.rolling + 1e-12 * k.normal);
    EXPECT_NEAR(law_moment(twirled, 0).norm() / little, k.twisting, 1e-9 * k.twisting + 1e-12 * k.normal);
    EXPECT_GE(k.damping_ratio, 0);
  }
}

/// The time step uses 2 ζ √(k m*) with the stiffness and ratio that a law states.
TEST_P(ContactLawContract, StatedDampingCoversTheDashpots) {
  const double speed = 1e-3, dt = 1e-4 * dt_;  // short, so that springs hardly change
  for (const double overlap : {2e-3, 0.05}) {
    Pairs pairs = two(overlap);
    pairs.step();
    const PairSize pair = size(pairs, overlap);
    const Stiffness k = law_->stiffness(pair, 0, 0);
    const double inverse_mass = pair.inverse_mass_a + pair.inverse_mass_b;
    const auto at = [&](const Vec3& velocity) {
      Pairs moving = pairs;
      moving.dt = dt;
      set(moving.velocity(1), velocity);
      moving.evaluate();
      return moving;
    };
    const Pairs closing = at({0, 0, -speed}), opening = at({0, 0, speed});
    const double normal = (closing.row(0).force.w - opening.row(0).force.w) / (2 * speed);
    const double critical = 2 * std::sqrt(k.normal / inverse_mass);
    EXPECT_GE(k.damping_ratio * critical, normal - 1e-6 * critical)
        << "stiffness().damping_ratio is less than that of the normal dashpot in evaluate()";
    Pairs slipping = at({speed, 0, 0});
    // The surfaces slip faster than the centres move: the branch is extended to the sum of the radii.
    const double reach = pair.radius_a + pair.radius_b, slip = speed * reach / (reach - overlap);
    const double across = law_shear(slipping, 0).norm() / slip - k.shear * dt,
                 critical_shear = 2 * std::sqrt(k.shear / (3.5 * inverse_mass));
    EXPECT_GE(k.shear_damping_ratio * critical_shear, across - 1e-6 * critical_shear)
        << "stiffness().shear_damping_ratio is less than that of the shear dashpot in evaluate()";
  }
}

/// Forces and moments oppose the motion that causes them.
TEST_P(ContactLawContract, ResistanceOpposesMotion) {
  const Stiffness k = law_->stiffness(PairSize{1, 0.7, 1, 1, 0.02}, 0, 0);
  Pairs moved = two(0.02), rolled = moved, twirled = moved;
  move(moved, vec(moved.position(1)) + Vec3(1e-4, 0, 0));
  roll(rolled, 1e-4), twist(twirled, 1e-4);
  if (k.shear > 0) {
    EXPECT_LT(shear(moved, 0).x(), 0);
  }
  if (k.rolling > 0) {
    EXPECT_LT(law_moment(rolled, 0).y(), 0);
  }
  if (k.twisting > 0) {
    EXPECT_LT(law_moment(twirled, 0).z(), 0);
  }
}

TEST_P(ContactLawContract, ClosedCyclesLeaveNoForceAndYieldNoEnergy) {
  // Shear only; with normal motion in phase, in antiphase, and with a phase lag of 90 degrees.
  for (const double press : {0.0, 1e-3, -1e-3})
    for (const double lag : {0.0, 0.25}) {
      Pairs pairs = two(0.02);
      constexpr int steps = 400;
      const auto path = [&](int step) {
        const double phase = 2 * std::numbers::pi * step / steps;
        const double aside = 1e-3 * (1 - std::cos(phase));
        const double distance = 1.68 - press * (1 - std::cos(phase - 2 * std::numbers::pi * lag));
        return Vec3(distance * Vec3(std::sin(aside / 1.7), 0, std::cos(aside / 1.7)));
      };
      set(pairs.position(1), path(0));
      pairs.step();
      double largest = 0, work = 0, turnover = 0;
      for (int step = 1; step <= steps; ++step) {
        const Vec3 before = vec(pairs.row(0).force), from = vec(pairs.position(1));
        move(pairs, path(step));
        const double share = 0.5 * (before + vec(pairs.row(0).force)).dot(vec(pairs.position(1)) - from);
        work += share, turnover += std::abs(share);
        largest = std::max(largest, shear(pairs, 0).norm());
      }
      rest(pairs), pairs.step();
      // Back and forth on one line, the spring returns to its state, unless its stiffness depends on the overlap.
      if (press == 0 || (lag == 0 && !stiffness_follows_overlap())) {
        // A stiffness that depends on the overlap includes its round-off.
        const double closed = stiffness_follows_overlap() ? 1e-11 : 1e-12;
        EXPECT_LE(shear(pairs, 0).norm(), closed * largest + 1e-9 * closed) << press;
      }
      // Springs of constant stiffness yield nothing, to round-off. Where stiffness follows the overlap, the work
      // depends on the step.
      const double gained = stiffness_follows_overlap() ? 0.1 * std::abs(press) + 1e-9 : 1e-9;
      EXPECT_LE(work, gained * turnover) << press << ' ' << lag;
    }
  Pairs pairs = two(0.02);
  double largest = 0;
  for (int step = 0; step < 100; ++step) slip(pairs, 2e-5), largest = std::max(largest, shear(pairs, 0).norm());
  for (int step = 0; step < 100; ++step) slip(pairs, -2e-5);
  EXPECT_LE(shear(pairs, 0).norm(), 1e-12 * largest);
}

TEST_P(ContactLawContract, WallIsLikeAFixedSphere) {
  if (GetParam().wall_sphere == 0) GTEST_SKIP() << "a wall is like no sphere";
  const double ratio = GetParam().wall_sphere, radius = 0.8, overlap = 0.01;
  const double infinite = std::numeric_limits<double>::infinity();
  const Vec3 velocity(0, 0, 0.2), spin(3, 5, 0);
  for (const std::size_t surface : {0u, 1u}) {
    Pairs pairs(*law_, dt_);
    pairs.one_material = false;
    pairs.add({.radius = radius, .velocity = velocity, .spin = spin, .mass = 1.3});
    pairs.add({.position = {0, 0, (1 + ratio) * radius - overlap},
               .radius = ratio * radius,
               .mass = infinite,
               .material = ratio == 1 ? std::uint8_t{0} : static_cast<std::uint8_t>(surface)});
    pairs.pair(0, 1);
    WallPair wall(*law_, {.radius = radius, .velocity = velocity, .spin = spin, .mass = 1.3}, dt_);
    wall.contact.normal = wall.contact.normal_before = Vec3::UnitZ();
    wall.contact.overlap = overlap;
    // For laws where a wall takes the stiffness of the grain, its own material does not matter.
    wall.contact.material = ratio == 1 ? 0 : static_cast<std::uint32_t>(surface);
    for (int step = 0; step < 3; ++step) pairs.evaluate(), wall.evaluate();
    const double force = vec(pairs.row(0).force).norm(), eps = ratio == 1 ? 1e-12 : 1e-5;
    // The shear force on a sphere exceeds that of its spring, as the distance of the centres is below the sum of the
    // radii; at a wall they are the same.
    const Vec3 of_springs = vec(pairs.row(0).force) - shear(pairs, 0) + law_shear(pairs, 0);
    EXPECT_LE((of_springs - vec(wall.row.force)).norm(), eps * force);
    EXPECT_NEAR(pairs.row(0).force.w, wall.row.force.w, eps * force);
    if (ratio == 1) {
      EXPECT_LE((law_moment(pairs, 0) - wall.law_moment()).norm(), 1e-12 * force);
    }
    EXPECT_LE((vec(wall.sum.force) + vec(wall.row.force)).norm(), 0);
    const Vec3 arm = (radius - overlap) * Vec3::UnitZ();
    EXPECT_LE((vec(wall.sum.moment) + vec(wall.row.moment) + arm.cross(vec(wall.row.force))).norm(), 1e-14 * force);
  }
}

TEST_P(ContactLawContract, StiffnessAndEnergyOfAWallFitItsForces) {
  const double radius = 0.8, overlap = 0.01, little = 1e-5;
  for (const std::size_t surface : {0u, 2u}) {
    const PairSize size{
        .radius_a = radius, .radius_b = radius, .inverse_mass_a = 1, .inverse_mass_b = 0, .overlap = overlap};
    ASSERT_TRUE(size.wall);
    const Stiffness k = law_->stiffness(size, 0, surface);
    const auto contact = [&](double at, const Vec3& spin, const Vec3& wall_velocity) {
      WallPair wall(*law_, {.radius = radius, .spin = spin}, dt_);
      wall.contact.overlap = at, wall.contact.material = static_cast<std::uint32_t>(surface);
      wall.contact.velocity = wall_velocity;
      wall.evaluate();
      set(wall.spin, Vec3::Zero()), wall.contact.velocity.setZero();
      wall.evaluate();
      return wall;
    };
    const Vec3 none = Vec3::Zero();
    const auto normal = [&](double at) { return contact(at, none, none).row.force.w; };
    const double h = 1e-4 * overlap;
    EXPECT_NEAR((normal(overlap + h) - normal(overlap - h)) / (2 * h), k.normal, 1e-6 * k.normal);
    auto slid = contact(overlap, none, {little / dt_, 0, 0});
    EXPECT_NEAR(-slid.row.force.x / little, k.shear, 1e-9 * k.shear);
    auto rolled = contact(overlap, {0, -little / dt_, 0}, {0, 0, 0});
    EXPECT_NEAR(-rolled.law_moment().y() / little, k.rolling, 1e-9 * k.rolling);
    auto twirled = contact(overlap, {0, 0, -little / dt_}, none);
    EXPECT_NEAR(-twirled.law_moment().z() / little, k.twisting, 1e-9 * k.twisting);
    PairSize deeper = size, flatter = size;
    deeper.overlap += h, flatter.overlap -= h;
    const std::vector<double> clean(law_->state().size(), 0.0);
    const auto stored = [&](const PairSize& s, const std::vector<double>& state) {
      return law_->energy(s, 0, surface, state).total();
    };
    EXPECT_NEAR((stored(deeper, clean) - stored(flatter, clean)) / (2 * h), normal(overlap),
                1e-6 * std::abs(normal(overlap)));
    const double kept = stored(size, slid.state()) - stored(size, clean);
    EXPECT_NEAR(kept, 0.5 * k.shear * little * little, 1e-6 * 0.5 * k.shear * little * little + 1e-12 * k.normal * h);
  }
}

TEST_P(ContactLawContract, GrainCarriedByARotatingWallDoesNotSlip) {
  WallPair wall(*law_, {.radius = 1}, dt_);
  const double overlap = 0.02, angle = 1e-4;
  const Eigen::AngleAxisd turn(angle, Vec3::UnitY());
  Vec3 normal = -Vec3::UnitZ(), centre(5, 0, 3);
  wall.contact.overlap = overlap;
  for (int step = 0; step < 12000; ++step) {
    const Vec3 next = turn * centre;
    wall.contact.normal_before = normal, normal = turn * normal, wall.contact.normal = normal;
    set(wall.velocity, (next - centre) / dt_), set(wall.spin, angle / dt_ * Vec3::UnitY());
    centre = next;
    wall.contact.spin = angle / dt_ * Vec3::UnitY();
    // At the middle of the step, as the velocity of the sphere.
    const Vec3 point = centre + (1 - overlap) * normal;
    wall.contact.velocity = (point - turn.inverse() * point) / dt_;
    wall.evaluate();
  }
  const Vec3 force = vec(wall.row.force), slip = force - force.dot(normal) * normal;
  EXPECT_LE(slip.norm(), 1e-6 * force.norm());
  EXPECT_LE(vec(wall.row.moment).norm(), 1e-6 * force.norm());
}

}  // namespace
}  // namespace grit::test
