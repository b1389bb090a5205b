#include "coarse-graining.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <numbers>

#include "grit/testing/probe.hpp"
#include "lucy.hpp"

namespace grit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// ∫ f over low … high, exact for polynomials up to the seventh degree in each part.
template <class F>
double integral(double low, double high, int parts, F f) {
  constexpr double weights[] = {41, 216, 27, 272, 27, 216, 41};
  double sum = 0;
  const double part = (high - low) / parts;
  for (int p = 0; p < parts; ++p)
    for (int k = 0; k < 7; ++k) sum += weights[k] / 840 * part * f(low + (p + k / 6.0) * part);
  return sum;
}

TEST(Lucy, HasAnIntegralOfOne) {
  for (const double cutoff : {0.01, 3.0}) {
    const Lucy kernel(cutoff);
    const auto shell = [&](double r) { return 4 * std::numbers::pi * r * r * kernel(r); };
    EXPECT_NEAR(integral(0, cutoff, 1, shell), 1, 1e-14);
    EXPECT_EQ(kernel(cutoff), 0);
    EXPECT_EQ(kernel(2 * cutoff), 0);
  }
}

TEST(Lucy, IsIntegratedAlongALine) {
  const Lucy kernel(2);
  struct Line {
    Vec3 point, way;
  };
  for (const auto& [point, way] : std::vector<Line>{{{0.3, -0.2, 0.5}, {1, 0.5, 0.25}},  // inside
                                                    {{0, 0, 0}, {0, 0, 1}},              // through the middle
                                                    {{1e-9, 0, 0.5}, {0, 0, 1}},         // nearly
                                                    {{0.1, 0, 0}, {7, 0, 0}},            // out of it
                                                    {{3, 0.5, 0.5}, {9, 0, 0}},          // in and out
                                                    {{0.4, 0.4, 1}, {0, 0, 1e-3}},       // short
                                                    {{0.4, 0.4, 1}, {0, 0, 0}}}) {
    const double exact = kernel.along(point, way);
    EXPECT_NEAR(exact, integral(0, 1, 3000, [&](double s) { return kernel((point - s * way).norm()); }), 1e-11);
    EXPECT_GT(exact, 0);
  }
  EXPECT_EQ(kernel.along({3, 0, 0}, {0, 5, 0}), 0);   // passes by
  EXPECT_EQ(kernel.along({-3, 0, 0}, {5, 0, 0}), 0);  // leads away
}

/// Three grains that move, two contacts and a wall, with forces that hold nothing in balance.
FakeWorld moving() {
  FakeWorld world;
  world.density = 2;
  world.add({0, 0, 0}, 1, {0.5, -0.25, 1}), world.add({1.5, 0.5, 1}, 0.8, {-1, 0.5, 0}), world.add({3, 0, 0.5}, 0.9);
  world.wall.push_back(still_wall("wall"));
  world.add_contact(0, 1, Vec3(1.5, 0.5, 1), Vec3(4, 1, -2)),
      world.add_contact(1, 2, Vec3(1.5, -0.5, -0.5), Vec3(1, 3, 2));
  world.add_wall_contact(0, 0, Vec3(-0.9, 0, -0.2), Vec3(-5, 2, 1));
  return world;
}
double mass(const FakeWorld& world, std::size_t body) { return 1 / world.velocity[body].w; }

TEST(CoarseFields, AddUpToWhatThereIs) {
  const FakeWorld world = moving();
  const double cutoff = 2, step = cutoff / 16;
  const PointGrid grid{Vec3(-3.01, -2.52, -2.53), Vec3::Constant(step), {66, 42, 48}};
  double density = 0;
  Vec3 momentum = Vec3::Zero(), wall = Vec3::Zero();
  Mat3 contact = Mat3::Zero(), flux = Mat3::Zero();
  for (const CoarseFields& field : coarse_fields(world, grid, cutoff)) {
    density += field.density, momentum += field.momentum, contact += field.contact, wall += field.wall_force;
    flux += field.kinetic + field.momentum * field.velocity().transpose();
  }
  const double space = step * step * step;
  double total = 0;
  Vec3 moved = Vec3::Zero();
  Mat3 love_weber = Mat3::Zero(), all_flux = Mat3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 v = xyz(world.velocity[i]);
    total += mass(world, i), moved += mass(world, i) * v, all_flux += mass(world, i) * v * v.transpose();
  }
  for (const Contact& c : world.contact) love_weber += c.force * c.branch.transpose();
  // The kernel's cusp and cutoff leave a sum over points a sixteenth of c apart an error of some 1e-8.
  EXPECT_NEAR(density * space, total, 1e-7 * total);
  EXPECT_NEAR((momentum * space - moved).norm(), 0, 1e-7 * moved.norm());
  EXPECT_NEAR((flux * space - all_flux).norm(), 0, 1e-7 * all_flux.norm());
  EXPECT_NEAR((contact * space - love_weber).norm(), 0, 1e-7 * love_weber.norm());
  EXPECT_NEAR((wall * space + world.contact[2].force).norm(), 0, 1e-7 * world.contact[2].force.norm());
}

CoarseFields at(const FakeWorld& world, const Vec3& point, double cutoff) {
  return coarse_fields(world, {point, Vec3::Ones(), {1, 1, 1}}, cutoff).front();
}
/// By differences of the fourth order.
template <class F>
auto derivative(double h, F f) {
  using Value = decltype(f(h));
  return Value((8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h));
}
/// Σ_j ∂ tensor_ij / ∂ x_j of what `of` takes from the fields.
template <class Of>
Vec3 divergence(const FakeWorld& world, const Vec3& point, double cutoff, Of of) {
  Vec3 sum = Vec3::Zero();
  for (int j = 0; j < 3; ++j)
    sum += derivative(1e-3 * cutoff,
                      [&](double h) -> Vec3 { return of(at(world, point + h * Vec3::Unit(j), cutoff)).col(j); });
  return sum;
}

const std::vector<Vec3> points{{0.31, 0.22, 0.43}, {1.1, -0.3, 0.9}, {-0.7, 0.4, -0.6}, {2.2, 0.7, 0.1}};

// Two balls on a floor between two walls, and a third on both: 2 F cos θ is its weight W.
TEST(CoarseFields, HoldAPackingAtRestInBalance) {
  FakeWorld world;
  world.density = 3;
  const Vec3 left(-1.2, 0, 1), right(1.2, 0, 1), top(0, 0, 2.6), gravity(0, 0, -10);
  world.add(left, 1), world.add(right, 1), world.add(top, 1);
  for (const auto* name : {"floor", "left", "right"}) world.wall.push_back(still_wall(name));
  const double weight = 10 * mass(world, 0), thrust = weight / 1.6;
  world.add_contact(2, 0, left - top, thrust * (left - top) / 2),
      world.add_contact(2, 1, right - top, thrust * (right - top) / 2);
  world.add_wall_contact(0, 0, Vec3(0, 0, -1), Vec3(0, 0, -1.5 * weight));
  world.add_wall_contact(1, 0, Vec3(0, 0, -1), Vec3(0, 0, -1.5 * weight));
  world.add_wall_contact(0, 1, Vec3(-1, 0, 0), Vec3(-0.6 * thrust, 0, 0));
  world.add_wall_contact(1, 2, Vec3(1, 0, 0), Vec3(0.6 * thrust, 0, 0));
  for (const double cutoff : {1.7, 3.3})
    for (const Vec3& point : points) {
      const CoarseFields here = at(world, point, cutoff);
      const Vec3 gradient = divergence(world, point, cutoff, [](const CoarseFields& f) { return f.contact; });
      const Vec3 rest = -gradient + here.density * gravity + here.wall_force;
      EXPECT_NEAR(rest.norm(), 0, 1e-10 * weight) << point.transpose() << ", cutoff " << cutoff;
      EXPECT_GT(gradient.norm(), 1e-3 * weight);
      EXPECT_EQ(here.kinetic.norm(), 0);
    }
}

// ∂ρ/∂t + div(ρV) = 0 and ∂(ρV)/∂t + div(ρVV + σ) = ρg + t, with the forces as they are at the instant.
TEST(CoarseFields, KeepMassAndMomentum) {
  const FakeWorld world = moving();
  const Vec3 gravity(1, 0, -3);
  std::vector<Vec3> acceleration(3, gravity);
  for (const Contact& c : world.contact) {
    acceleration[c.a] -= c.force / mass(world, c.a);
    if (!c.with_wall) acceleration[c.b] += c.force / mass(world, c.b);
  }
  const auto later = [&](double t) {
    FakeWorld now = world;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 v = xyz(world.velocity[i]), x = xyz(world.position[i]) + t * v + 0.5 * t * t * acceleration[i],
                 w = v + t * acceleration[i];
      now.position[i] = {x[0], x[1], x[2], world.position[i].w};
      now.velocity[i] = {w[0], w[1], w[2], world.velocity[i].w};
    }
    return now;
  };
  const double cutoff = 2.3;
  for (const Vec3& point : points) {
    const CoarseFields here = at(world, point, cutoff);
    const double density = derivative(1e-3, [&](double t) { return at(later(t), point, cutoff).density; });
    const Vec3 momentum = derivative(1e-3, [&](double t) { return at(later(t), point, cutoff).momentum; });
    const Vec3 outflow = divergence(world, point, cutoff,
                                    [](const CoarseFields& f) { return Mat3(Vec3::UnitX() * f.momentum.transpose()); });
    const Vec3 spread = divergence(world, point, cutoff, [](const CoarseFields& f) {
      return Mat3(f.contact + f.kinetic + f.momentum * f.velocity().transpose());
    });
    EXPECT_NEAR(density + outflow.x(), 0, 1e-9) << point.transpose();
    EXPECT_NEAR((momentum + spread - here.density * gravity - here.wall_force).norm(), 0, 1e-9) << point.transpose();
    EXPECT_GT(std::abs(density), 1e-3);
    EXPECT_GT(momentum.norm(), 1e-2);
  }
}

TEST(CoarseFields, HaveTheStressOfFluctuationsAlone) {
  FakeWorld world;
  world.add({0, 0, 0}, 1, {3, 1, 0}), world.add({0, 0, 0}, 1, {1, 1, 0});
  const CoarseFields here = at(world, {0.5, 0, 0}, 2);
  EXPECT_NEAR((here.velocity() - Vec3(2, 1, 0)).norm(), 0, 1e-13);
  Mat3 kinetic = Mat3::Zero();
  kinetic(0, 0) = here.density;  // fluctuations of ±1 along x
  EXPECT_NEAR((here.kinetic - kinetic).norm(), 0, 1e-12 * here.density);
}

TEST(CoarseFields, CountPeriodicImages) {
  FakeWorld world, images;
  world.make_periodic({0, 0, 0}, {2, 3, 4});
  const Vec3 place(1.9, 0.2, 0.1), branch(0.5, -0.6, 0.3), force(1, 2, 3);
  world.add(place, 0.5, {1, 0, 0}), world.add_contact(0, 0, branch, force);
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      for (int k = -4; k <= 4; ++k) {
        const auto body = images.add(place + Vec3(2.0 * i, 3.0 * j, 4.0 * k), 0.5, {1, 0, 0});
        images.add_contact(body, body, branch, force);
      }
  for (const double cutoff : {1.5, 5.0})  // the larger sees the same grain several times
    for (const Vec3& point : points) {
      const CoarseFields one = at(world, point, cutoff), all = at(images, point, cutoff);
      EXPECT_NEAR(one.density, all.density, 1e-12 * all.density);
      EXPECT_NEAR((one.contact - all.contact).norm(), 0, 1e-12);
      EXPECT_GE(all.density, 0);
    }
  EXPECT_GT(at(world, points[0], 5.0).density, 0);
}

// Over a period the mean of points is the integral, as closely as a sum over points has it.
TEST(CoarseGraining, HasTheMeanStressOfThePacking) {
  FakeWorld world = lattice_world(6, 4, 8);
  world.make_periodic(world.whole.low, world.whole.high);
  CoarseGraining probe;
  probe.spacing = 0.5;
  probe.prepare(world);
  const double volume = world.whole.volume();
  double total = 0;
  for (std::size_t i = 0; i < world.velocity.size(); ++i) total += mass(world, i);
  const Mat3 stress = mean_stress(world, world.whole);
  EXPECT_NEAR(channel_value(probe, world, "density"), total / volume, 1e-5 * total / volume);
  EXPECT_NEAR(channel_value(probe, world, "mean_stress"), stress.trace() / 3, 1e-5 * stress.trace() / 3);
}

// In pairs that lie in one place, of which one goes as fast as the other comes, all motion is fluctuation: the trace of
// its stress is ρ v² at each point.
TEST(CoarseGraining, HasTheKineticStressOfGrainsThatComeAndGo) {
  FakeWorld world;
  const Vec3 speed(0.3, -0.2, 0.6);
  for (const double x : {0.5, 1.5, 2.5})
    for (const double sign : {1.0, -1.0}) world.add({x, 0.5, 0.5}, 0.5, sign * speed);
  world.make_periodic({0, 0, 0}, {3, 1, 1});
  CoarseGraining probe;
  probe.spacing = 0.25;
  probe.prepare(world);
  const double expected = channel_value(probe, world, "density") * speed.squaredNorm() / 3;
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(channel_value(probe, world, "kinetic_stress"), expected, 1e-12 * expected);
}

TEST(CoarseGraining, SetsPointsInTheMiddleOfTheirCells) {
  FakeWorld world;
  world.add({0.5, 0.5, 0.5}, 0.1);
  world.whole = {{0, 0, 0}, {1, 0.5, 0.1}};
  CoarseGraining probe;
  probe.prepare(world);
  EXPECT_EQ(channel_value(probe, world, "points"), 5 * 2 * 1);
  auto fields = probe.fields(world);
  EXPECT_EQ(fields[0].name, "centre");
  EXPECT_EQ(fields[1].name, "size");
  ASSERT_EQ(fields[0].values.size(), 30u);
  EXPECT_NEAR(fields[0].values[0], 0.1, 1e-15);
  EXPECT_NEAR(fields[0].values[1], 0.125, 1e-15);
  EXPECT_NEAR(fields[0].values[2], 0.05, 1e-15);
  EXPECT_NEAR(fields[0].values[4], 0.375, 1e-15) << "y runs faster than x";
  EXPECT_NEAR(fields[1].values[0], 0.2, 1e-15);
  EXPECT_NEAR(fields[1].values[1], 0.25, 1e-15);
  probe.slice = "x", probe.region_low = Vec3(0.2, 0, 0);
  EXPECT_EQ(channel_value(probe, world, "points"), 2);
  fields = probe.fields(world);
  EXPECT_NEAR(fields[0].values[0], 0.6, 1e-15);
  EXPECT_NEAR(fields[1].values[0], 0.8, 1e-15);
}

TEST(CoarseGraining, RefusesGridsThatAreNoneOrTooLarge) {
  FakeWorld world;
  world.add({0.5, 0.5, 0.5}, 1e-4);
  CoarseGraining probe;
  try {
    probe.prepare(world);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("spacing: found a grid of 125000000000"));
    EXPECT_THAT(error.what(),
                HasSubstr(" points; allowed is at most 5000000 points; use a larger spacing, a slice, or a smaller "));
  }
  probe.region_low = Vec3(0, 0, 0), probe.region_high = Vec3(1, 1, 0);
  EXPECT_EQ(complaints(probe),
            "region_high: found a corner not above region_low, allowed: more than region_low along x, y and z\n");
}

TEST(CoarseGraining, HasNoPointsOnceTheyWouldBeTooMany) {
  FakeWorld world;
  world.add({0.5, 0.5, 0.5}, 0.1);
  CoarseGraining probe;
  probe.prepare(world);
  EXPECT_EQ(channel_value(probe, world, "points"), 5 * 5 * 5);
  const auto expect_nothing = [&] {
    EXPECT_EQ(channel_value(probe, world, "points"), 0);
    for (const auto* name : {"density", "mean_stress", "kinetic_stress"})
      EXPECT_TRUE(std::isnan(channel_value(probe, world, name))) << name;
    for (const Field& field : probe.fields(world)) EXPECT_TRUE(field.values.empty()) << field.name;
  };
  world.whole.high.z() = 1e6;  // a run goes on when its specimen has grown
  expect_nothing();
  world = FakeWorld();
  expect_nothing();
}

INSTANTIATE_TEST_SUITE_P(CoarseGraining, ProbeContract,
                         testing::Values(ProbeCase{"everywhere", [] { return std::make_shared<CoarseGraining>(); }},
                                         ProbeCase{"slice",
                                                   [] {
                                                     auto probe = std::make_shared<CoarseGraining>();
                                                     probe->slice = "y", probe->cutoff = 1;
                                                     return probe;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
