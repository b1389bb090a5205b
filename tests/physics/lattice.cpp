// Regular packings of equal spheres in a periodic cell: closed forms of elastic constants, speed of sound and strength.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::lattice_tests {
namespace {

constexpr double radius = 5e-4, diameter = 2 * radius, density = 2500;

/// Positions of spheres in contact in an orthogonal periodic cell; lengths in diameters.
struct Lattice {
  Vec3 cell;
  std::vector<Vec3> places;
  std::size_t neighbours;
};
const double root2 = std::numbers::sqrt2, bcc = 2 / std::numbers::sqrt3;
// Along the cubic axes, and rotated by 45 degrees about z.
const Lattice simple_cubic{Vec3::Ones(), {Vec3::Zero()}, 6};
const Lattice simple_cubic_turned{{root2, root2, 1}, {Vec3::Zero(), {root2 / 2, root2 / 2, 0}}, 6};
const Lattice face_centred{
    Vec3::Constant(root2),
    {Vec3::Zero(), {root2 / 2, root2 / 2, 0}, {root2 / 2, 0, root2 / 2}, {0, root2 / 2, root2 / 2}},
    12};
const Lattice face_centred_turned{{1, 1, root2}, {Vec3::Zero(), {0.5, 0.5, root2 / 2}}, 12};
const Lattice body_centred{Vec3::Constant(bcc), {Vec3::Zero(), Vec3::Constant(bcc / 2)}, 8};
const Lattice body_centred_turned{
    {root2 * bcc, root2* bcc, bcc},
    {Vec3::Zero(), {root2 * bcc / 2, root2* bcc / 2, 0}, {root2 * bcc / 2, 0, bcc / 2}, {0, root2* bcc / 2, bcc / 2}},
    8};

struct Law {
  const char* name;
  Description material;
  std::function<double(double overlap)> normal, shear;  ///< stiffnesses [N/m]
};
const double modulus = 1e8;
const Law linear_rolling{"linear-rolling",
                         {{"contact_modulus", modulus}, {"shear_to_normal_stiffness", 0.3}},
                         [](double) { return modulus * radius; },
                         [](double) { return 0.3 * modulus * radius; }};
const Law linear_frictional{"linear-frictional", linear_rolling.material, linear_rolling.normal, linear_rolling.shear};
const double young = 1e9, poisson = 0.25;
const Law hertz_mindlin{
    "hertz-mindlin",
    {{"young_modulus", young}, {"poisson_ratio", poisson}},
    [](double overlap) { return young / (1 - poisson * poisson) * std::sqrt(radius / 2 * overlap); },
    [](double overlap) { return 2 * young / (2 - poisson) / (1 + poisson) * std::sqrt(radius / 2 * overlap); }};

/// As many cells as needed, compressed by `squeeze` of a diameter.
Description packed(const Lattice& lattice, const Law& law, double squeeze, std::array<int, 3> cells) {
  const double scale = diameter * (1 - squeeze);
  std::vector<Grain> grains;
  for (int x = 0; x < cells[0]; ++x)
    for (int y = 0; y < cells[1]; ++y)
      for (int z = 0; z < cells[2]; ++z)
        for (const Vec3& place : lattice.places) {
          const Vec3 corner = lattice.cell.cwiseProduct(Vec3(x, y, z));
          grains.push_back({scale * (corner + place + Vec3::Constant(0.25)), radius});
        }
  Description d = description(law.name, law.material, grains);
  d["materials"]["grain"]["density"] = density;
  d["domain"] = {{"low", {0, 0, 0}},
                 {"high", vector(scale * lattice.cell.cwiseProduct(Vec3(cells[0], cells[1], cells[2])))},
                 {"periodic", {true, true, true}}};
  return d;
}
/// So that no body meets another twice.
std::array<int, 3> enough(const Lattice& lattice) {
  std::array<int, 3> cells{};
  for (int k = 0; k < 3; ++k) cells[as_index(k)] = static_cast<int>(std::ceil(2.5 / lattice.cell[k]));
  return cells;
}

Vec3 size(const World& world) { return world.cell().high - world.cell().low; }

/// Pressures along the axes.
Vec3 pressure(const World& world) {
  Vec3 sum = Vec3::Zero();
  for (const Contact& c : world.contacts()) sum += c.force.cwiseProduct(c.branch);
  return sum / size(world).prod();
}

/// Stresses over `strain`, tension and extension positive. By symmetry all bodies move with the mean flow.
Vec3 response(const Lattice& lattice, const Law& law, double squeeze, double strain, const Vec3& direction) {
  constexpr double dt = 1e-9;
  constexpr int steps = 10;
  Description d = packed(lattice, law, squeeze, enough(lattice));
  d["materials"]["grain"]["friction_angle"] = "80 deg";
  d["time_step"]["value"] = dt;
  d["domain"]["strain_rate"] = vector(strain / (dt * steps) * direction);
  Trial t(d);
  EXPECT_EQ(2 * t.kernel().state().pairs.touching_count(), lattice.neighbours * t.world().positions().size());
  const Vec3 before = pressure(t.world());
  t.step(steps);
  return (before - pressure(t.world())) / strain;
}

struct Elastic {
  const char* name;
  const Lattice& straight;
  const Lattice& turned;
  const Law& law;
  std::function<std::array<double, 3>(double normal, double shear)> constants;  ///< C11 d, C12 d, C44 d

  friend void PrintTo(const Elastic& elastic, std::ostream* out) { *out << elastic.name; }
};
class LatticeIn : public testing::TestWithParam<Elastic> {};

TEST_P(LatticeIn, ElasticConstantsAreThoseOfItsSprings) {
  const Elastic& p = GetParam();
  // The change by the strain is small relative to the overlap, and the overlap to the diameter: closed forms for
  // overlap 0.
  constexpr double squeeze = 1e-5, strain = 1e-9;
  const Vec3 along = response(p.straight, p.law, squeeze, strain, {1, 0, 0});
  const Vec3 sheared = response(p.turned, p.law, squeeze, strain, {1, -1, 0});
  const double overlap = squeeze * diameter;
  const auto [c11, c12, c44] = p.constants(p.law.normal(overlap), p.law.shear(overlap));
  const double found[3] = {along.x(), along.y(), 0.25 * (sheared.x() - sheared.y())};
  const double wanted[3] = {c11 / diameter, c12 / diameter, c44 / diameter};
  const char* names[3] = {"C11 [Pa]", "C12 [Pa], error over C11", "C44 [Pa], error over C11"};
  for (int i = 0; i < 3; ++i) verify(names[i], found[i], wanted[i], 1e-4, wanted[0]);
  EXPECT_NEAR(along.y(), along.z(), 1e-6 * along.x());

  // Simple shear of the cell, in a time too short for bodies to rotate. The rotation in it adds an antisymmetric part.
  constexpr double dt = 1e-9;
  constexpr int steps = 10;
  const std::pair<int, int> planes[] = {{0, 1}, {0, 2}, {1, 2}};
  const char* components[] = {"xy", "xz", "yz"};
  for (int k = 0; k < 3; ++k) {
    Description d = packed(p.straight, p.law, squeeze, enough(p.straight));
    d["materials"]["grain"]["friction_angle"] = "80 deg";
    d["time_step"]["value"] = dt;
    d["domain"]["shear_rate"][components[k]] = strain / (dt * steps);
    Trial t(d);
    const auto stress = [&]() -> Mat3 {
      Mat3 sum = Mat3::Zero();
      for (const Contact& c : t.world().contacts()) sum += c.force * c.branch.transpose();
      return sum / size(t.world()).prod();
    };
    const Mat3 before = stress();
    t.step(steps);
    const Mat3 change = (before - stress()) / strain;
    const auto [i, j] = planes[k];
    EXPECT_NEAR(0.5 * (change(i, j) + change(j, i)), wanted[2], 1e-4 * wanted[0]) << components[k];
  }
}

using Constants = std::array<double, 3>;
Constants of_simple_cubic(double kn, double kt) { return {kn, 0, kt / 2}; }
Constants of_face_centred(double kn, double kt) { return {root2 * (kn + kt), (kn - kt) / root2, (kn + kt) / root2}; }
Constants of_body_centred(double kn, double kt) {
  return {(kn + 2 * kt) / std::numbers::sqrt3, (kn - kt) / std::numbers::sqrt3,
          (2 * kn + kt) / 2 / std::numbers::sqrt3};
}
INSTANTIATE_TEST_SUITE_P(
    Physics, LatticeIn,
    testing::Values(
        Elastic{"SimpleCubicLinearRolling", simple_cubic, simple_cubic_turned, linear_rolling, of_simple_cubic},
        Elastic{"SimpleCubicLinearFrictional", simple_cubic, simple_cubic_turned, linear_frictional, of_simple_cubic},
        Elastic{"SimpleCubicHertzMindlin", simple_cubic, simple_cubic_turned, hertz_mindlin, of_simple_cubic},
        Elastic{"FaceCentredLinearRolling", face_centred, face_centred_turned, linear_rolling, of_face_centred},
        Elastic{"FaceCentredLinearFrictional", face_centred, face_centred_turned, linear_frictional, of_face_centred},
        Elastic{"FaceCentredHertzMindlin", face_centred, face_centred_turned, hertz_mindlin, of_face_centred},
        Elastic{"BodyCentredLinearRolling", body_centred, body_centred_turned, linear_rolling, of_body_centred},
        Elastic{"BodyCentredLinearFrictional", body_centred, body_centred_turned, linear_frictional, of_body_centred},
        Elastic{"BodyCentredHertzMindlin", body_centred, body_centred_turned, hertz_mindlin, of_body_centred}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Lattice, SoundGoesAsFastAsItsStiffnessAndDensitySay) {
  constexpr int layers = 64;
  constexpr double squeeze = 1e-3;
  const double stiffness = modulus * radius, mass = density * std::numbers::pi / 6 * std::pow(diameter, 3);
  const double corner = std::sqrt(stiffness / mass), wave = 2 * std::numbers::pi / layers;
  const double frequency = 2 * corner * std::sin(wave / 2);
  const double spacing = diameter * (1 - squeeze), speed = 1e-3 * squeeze * diameter * frequency;
  Description d = packed(simple_cubic, linear_rolling, squeeze, {layers, 3, 3});
  for (Description& grain : d["bodies"]["grains"]["source"]["bodies"])
    grain["velocity"] = {speed * std::sin(wave * double(grain["position"][0]) / spacing), 0, 0};
  const double dt = 0.05 / corner;
  d["time_step"]["value"] = dt;
  Trial t(d);
  const auto amplitude = [&] {
    double sum = 0;
    const std::size_t count = t.world().positions().size();
    for (std::uint32_t id = 0; id < count; ++id)
      sum += t.velocity(id).x() * std::sin(wave * (std::floor(t.position(id).x() / spacing) + 0.25));
    return 2 * sum / static_cast<double>(count);
  };
  // At full steps the velocity is a cosine, with the frequency of the leap-frog scheme.
  const double turn = 2 * std::asin(0.5 * frequency * dt);
  double before = 0, now = amplitude();
  int zeros = 0, step = 0;
  while (zeros < 2) {
    t.step(), ++step;
    before = std::exchange(now, amplitude());
    ASSERT_NEAR(now, speed * std::cos(turn * step), 1e-8 * speed) << step;
    zeros += before * now < 0 ? 1 : 0;
  }
  const double period = (step - 1 + before / (before - now)) * dt / 0.75;  // second zero of a cosine: ¾ of the period
  const double found = layers * spacing / period;
  const double long_wave = std::sqrt(stiffness / spacing / (mass / std::pow(spacing, 3)));
  // A discrete chain of 64 layers is slower by (π/64)²/6; the time step makes it faster by (ω dt)²/24.
  verify("speed of a wave 64 layers long [m/s]", found, long_wave * std::sin(wave / 2) / (wave / 2), 2e-6);
  verify("the same against √(C11/ρ)", found, long_wave, 5e-4);
}

TEST(Lattice, FaceCentredPackingIsAsStrongAsThorntonSays) {
  // Compressed along z and extended equally along x and y: contacts across z slide at constant overlap, those in the
  // plane open. doi 10.1680/geot.1979.29.4.441
  for (const Law* law : {&linear_rolling, &linear_frictional, &hertz_mindlin})
    for (const double angle : {5.0, 18.0, 30.0, 40.0}) {
      constexpr double squeeze = 1e-6, dt = 1e-9;
      constexpr int steps = 200;
      Description d = packed(face_centred, *law, squeeze, enough(face_centred));
      d["materials"]["grain"]["friction_angle"] = std::to_string(angle) + " deg";
      d["time_step"]["value"] = dt;
      d["domain"]["strain_rate"] = vector(6e-6 / (dt * steps) * Vec3(1, 1, -1));
      Trial t(d);
      t.step(steps);
      EXPECT_EQ(2 * t.kernel().state().pairs.touching_count(), 8 * t.world().positions().size());
      const Vec3 stress = pressure(t.world());
      const double friction = std::tan(angle * std::numbers::pi / 180);
      const double ratio = 2 * (1 + friction) / (1 - friction);
      verify("σ1/σ3, " + std::string(law->name) + ", φ = " + std::to_string(int(angle)) + "°", stress.z() / stress.x(),
             ratio, 1e-4);
      EXPECT_NEAR(stress.y(), stress.x(), 1e-6 * stress.x());
    }
}

TEST(Lattice, FaceCentredPackingYieldsUnderConstantLateralStress) {
  // The same in a drained triaxial test: lateral stresses are kept while the cell is shortened along z. Contacts in the
  // plane open, since the lateral stress is then carried by those across it alone.
  for (const Law* law : {&linear_rolling, &linear_frictional, &hertz_mindlin})
    for (const double angle : {5.0, 18.0, 30.0}) {
      constexpr double squeeze = 1e-6, dt = 1e-9;
      constexpr int steps = 10000;
      Description d = packed(face_centred, *law, squeeze, enough(face_centred));
      d["materials"]["grain"]["friction_angle"] = std::to_string(angle) + " deg";
      d["time_step"]["value"] = dt;
      // By symmetry all bodies move with the mean flow; held ones do so in spite of rounding errors, which would grow.
      d["engines"]["hold"] = {{"type", "hold"}, {"translation", "xyz"}, {"rotation", "xyz"}};
      const double lateral = pressure(Trial(d).world()).x();
      d["domain"]["strain_rate"] = vector(-30 * squeeze / (steps * dt) * Vec3::UnitZ());
      d["domain"]["servo"] = {
          {"stress", {{"xx", lateral}, {"yy", lateral}}}, {"max_strain_rate", 1e4}, {"interval", 1}};
      Trial t(d);
      t.step(steps);
      EXPECT_EQ(2 * t.kernel().state().pairs.touching_count(), 8 * t.world().positions().size());
      const Vec3 stress = pressure(t.world());
      const double friction = std::tan(angle * std::numbers::pi / 180);
      const std::string of = std::string(law->name) + ", φ = " + std::to_string(int(angle)) + "°";
      verify("σ1/σ3 at constant lateral stress, " + of, stress.z() / stress.x(), 2 * (1 + friction) / (1 - friction),
             1e-3);
      verify("lateral stress over the one kept, " + of, stress.x() / lateral, 1, 1e-3);
      EXPECT_NEAR(stress.y(), stress.x(), 1e-6 * stress.x());
    }
}

TEST(Lattice, SixSpheresBetweenWallsAreAsStrongAsThorntonSays) {
  // A cell of the face-centred packing between smooth walls: one above, four in the plane, one below. The lids approach
  // and the sides move outwards so that contacts across slide at constant overlap; those in the plane open. Each lid
  // carries four contacts, each side the lateral components of four.
  constexpr double squeeze = 1e-5, sunk = squeeze * diameter;
  for (const Law* law : {&linear_rolling, &linear_frictional, &hertz_mindlin})
    for (const double angle : {5.0, 18.0, 30.0}) {
      const double friction = std::tan(angle * std::numbers::pi / 180);
      const double half = 0.5 * diameter * (1 - squeeze), high = root2 * half;
      std::vector<Grain> grains;
      for (const double sign : {-1.0, 1.0}) {
        grains.push_back({{0, 0, sign * high}, radius});
        for (const double other : {-1.0, 1.0}) grains.push_back({{sign * half, other * half, 0}, radius});
      }
      Description d = description(law->name, law->material, grains);
      d["materials"]["grain"]["density"] = density, d["materials"]["grain"]["friction_angle"] = std::atan(friction);
      d["materials"]["smooth"] = law->material;
      d["materials"]["smooth"]["friction_angle"] = 0;
      if (law == &linear_rolling)
        d["materials"]["grain"]["rolling_limit"] = d["materials"]["smooth"]["rolling_limit"] = 0;
      // So slow that residual oscillations are faster; otherwise local damping would act on the steady motion.
      constexpr double speed = 1e-6;
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
          const double place = (axis == 2 ? high : half) + radius - (axis == 2 ? 2 * root2 : root2) * sunk;
          const std::string name = std::string(sign > 0 ? "high_" : "low_") + "xyz"[axis];
          d["walls"][name] = plane(sign * place * Vec3::Unit(axis), -sign * Vec3::Unit(axis), "smooth");
          d["walls"][name]["motion"]["velocity"] =
              vector(sign * speed * (axis == 2 ? -1 : 1 / root2) * Vec3::Unit(axis));
        }
      d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
      d["time_step"]["safety"] = 0.2;
      Trial t(d);
      double lids = 0, sides = 0;
      while (t.world().time() < 0.03) t.step();
      for (int i = 0; i < 2000; ++i) {
        t.step();
        for (const WallView& wall : t.world().walls())
          (wall.name.ends_with("z") ? lids : sides) += wall.force.norm() / (wall.name.ends_with("z") ? 2 : 4);
      }
      EXPECT_EQ(t.kernel().state().pairs.touching_count(), 8u);
      verify(
          "force on a lid over that on a side, " + std::string(law->name) + ", φ = " + std::to_string(int(angle)) + "°",
          lids / sides, root2 * (1 + friction) / (1 - friction), 1e-3);
    }
}

}  // namespace
}  // namespace grit::test::lattice_tests
