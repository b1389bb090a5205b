// Oblique and spinning impacts of spheres on a plane or on each other: Chung & Ooi (2011), doi
// 10.1007/s10035-011-0277-0, tests 4 to 8. Sliding contacts are compared with closed forms, contacts that stick for
// some time with a numerical solution of the law's equations. Linear laws are compared with their closed forms, also in
// tests 7 and 8.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "grit/contact/restitution.hpp"
#include "support/rebound.hpp"
#include "support/verified.hpp"

namespace grit::test::oblique_impact_tests {
namespace {

using std::numbers::pi;

struct Material {
  std::string name;
  double young, poisson, density, friction, restitution;

  double mass(double radius) const { return density * 4 / 3 * pi * radius * radius * radius; }
  /// Maximum overlap of an elastic impact on a rigid plane [m].
  double overlap(double radius, double speed) const {
    const double spring = 4.0 / 3 * young / (1 - poisson * poisson) * std::sqrt(radius);
    return std::pow(1.25 * mass(radius) * speed * speed / spring, 0.4);
  }
  double duration(double radius, double speed) const { return 2.9432 * overlap(radius, speed) / speed; }
  Description hertz() const {
    return {{"density", density},
            {"young_modulus", young},
            {"poisson_ratio", poisson},
            {"friction_angle", std::atan(friction)},
            {"restitution", restitution}};
  }
  /// Young's modulus as the modulus of the law. Its shear spring reaches the limit soon; a dashpot, if any, acts
  /// immediately.
  Description linear(const std::string& law) const {
    Description m{{"density", density},
                  {"contact_modulus", young},
                  {"shear_to_normal_stiffness", 10},
                  {"friction_angle", std::atan(friction)}};
    if (law == "linear-rolling") m["rolling_limit"] = 0;
    else m["restitution"] = restitution;
    return m;
  }
  /// Duration of an elastic impact of two equal bodies with a linear law.
  double linear_duration(double radius) const { return pi * std::sqrt(mass(radius) / (2 * young * radius)); }
  /// linear-rolling has no dashpot.
  double restitution_by(const std::string& law) const { return law == "linear-rolling" ? 1 : restitution; }
};

// Two materials for each test, with the values of the scripts of YADE and PySPH for these tests.
const std::vector<Material> of_fourth{{"oxide", 380e9, 0.23, 4000, 0.092, 0.98},
                                      {"alloy", 70e9, 0.33, 2700, 0.092, 0.98}};
const std::vector<Material> of_fifth{{"steel", 208e9, 0.3, 7850, 0.3, 1}, {"polyethylene", 1e9, 0.4, 1400, 0.3, 1}};
const std::vector<Material> of_sixth{{"alloy", 70e9, 0.33, 2700, 0.4, 0.5}, {"copper", 120e9, 0.35, 8900, 0.4, 0.5}};
const std::vector<Material> of_eighth{{"alloy", 70e9, 0.33, 2700, 0.4, 0.5}, {"nylon", 2.5e9, 0.4, 1000, 0.4, 0.5}};

std::string at(const Material& m, const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return ", " + m.name + text;
}

/// A ball in contact with a rigid body at rest.
struct Course {
  double depth = 0, closing, along, spin, shear = 0;  ///< m, m/s, m/s, rad/s; of the spring, on the ball [N]
  double pushed = 0;                                  ///< normal impulse before friction reached its limit [N s]
};
Course after(const Course& c, const Course& rate, double dt) {
  return {c.depth + dt * rate.depth, c.closing + dt * rate.closing, c.along + dt * rate.along,
          c.spin + dt * rate.spin,   c.shear + dt * rate.shear,     c.pushed};
}

/// Hertz's spring with its dashpot and Mindlin's spring with Coulomb's limit, as a system of differential equations.
struct Equations {
  Material material;
  double radius, reduced_radius;
  double nearer;  ///< overlap over the sum of the radii, over depth over radius: on a sphere R / (R + its radius)
  double mass = material.mass(radius);
  double damping = 2 * std::sqrt(5.0 / 6) * damping_of_restitution(material.restitution);

  double contact(const Course& c) const { return std::sqrt(reduced_radius * std::max(c.depth, 0.0)); }
  double normal(const Course& c) const {
    const double stiffness = 2 * material.young / (1 - material.poisson * material.poisson) * contact(c);
    return std::max(0.0, 2.0 / 3 * stiffness * c.depth + damping * std::sqrt(stiffness * mass) * c.closing);
  }
  /// Distance of the centres over the sum of the radii.
  double branch(const Course& c) const { return 1 - nearer * c.depth / radius; }
  /// Of the shear spring, by Coulomb's law for the force on the ball.
  double limit(const Course& c) const { return material.friction * normal(c) * branch(c); }
  Course rate(const Course& c) const {
    const double shear_modulus = material.young / (2 * (2 - material.poisson) * (1 + material.poisson));
    // The limit also holds within a step.
    const double shear = std::clamp(c.shear, -limit(c), limit(c));
    const double eased = c.closing < 0 && c.depth > 0 ? 0.5 * c.closing / c.depth * c.shear : 0;
    return {.depth = c.closing,
            .closing = -normal(c) / mass,
            .along = shear / branch(c) / mass,
            .spin = -2.5 * shear / (mass * radius),
            .shear = eased - 8 * shear_modulus * contact(c) * (c.along / branch(c) - radius * c.spin)};
  }
  /// Fourth-order Runge–Kutta; shear above the friction limit slips.
  Course rebound(Course c) const {
    const double deepest = material.overlap(radius, c.closing), dt = 2.9432 * deepest / c.closing / 50000;
    bool slides = false;
    do {
      const Course k1 = rate(c), k2 = rate(after(c, k1, dt / 2)), k3 = rate(after(c, k2, dt / 2)),
                   k4 = rate(after(c, k3, dt));
      c = after(after(after(after(c, k1, dt / 6), k2, dt / 3), k3, dt / 3), k4, dt / 6);
      if (slides = slides || std::abs(c.shear) >= limit(c); !slides) c.pushed += dt * normal(c);
      c.shear = std::clamp(c.shear, -limit(c), limit(c));
    } while (c.depth > 1e-6 * deepest || c.closing > 0);
    return c;
  }
};

/// Errors are relative to the initial speed of the contact point.
void verify_rebound(const std::string& at, const Rebound& found, const Course& known, double scale, double radius,
                    double allowed) {
  verify("tangential speed" + at + ", error over that of the contact before [m/s]", found.velocity.x(), known.along,
         allowed, scale);
  verify("spin" + at + ", error over the speed of the contact before per radius [rad/s]", found.spin.y(), known.spin,
         allowed, scale / radius);
}

Rebound off_rigid_plane(const Material& m, double radius, const Vec3& velocity, const Vec3& spin) {
  Description rigid = m.hertz();
  rigid["young_modulus"] = 1e30;
  return from_plane("hertz-mindlin", m.hertz(), rigid, radius, velocity, spin,
                    m.duration(radius, -velocity.z()) / 4000);
}

TEST(ObliqueImpact, SlidesAsChungAndOoisFourthTestSays) {
  constexpr double radius = 2.5e-3, speed = 3.9;
  for (const Material& m : of_fourth)
    for (int angle = 35; angle < 89; angle += 5) {
      const Vec3 in = aslant(speed, angle);
      const Rebound out = off_rigid_plane(m, radius, in, Vec3::Zero());
      const double impulse = m.friction * (1 + m.restitution) * -in.z();
      verify("tangential restitution" + at(m, " at %g°", angle), out.velocity.x() / in.x(), 1 - impulse / in.x(), 1e-5);
      verify("spin" + at(m, " at %g°", angle) + " [rad/s]", out.spin.y(), 2.5 * impulse / radius, 1e-4);
      EXPECT_EQ(out.velocity.y(), 0);
    }
}

TEST(ObliqueImpact, FollowsItsEquationsAtSmallAnglesOfTheFourthTest) {
  constexpr double radius = 2.5e-3, speed = 3.9;
  for (const Material& m : of_fourth) {
    const Equations equations{m, radius, radius, 0};
    for (int angle = 2; angle < 32; angle += angle < 5 ? 3 : 5) {
      const Vec3 in = aslant(speed, angle);
      const Rebound out = off_rigid_plane(m, radius, in, Vec3::Zero());
      const Course known = equations.rebound({.closing = -in.z(), .along = in.x(), .spin = 0});
      verify_rebound(at(m, " at %g°", angle), out, known, in.x(), radius, 5e-4);
    }
  }
}

/// Angle of the velocity of the contact point to the normal [°].
double rebound_angle(double along, double spin, double leaving, double radius) {
  return std::atan((along - radius * spin) / leaving) * 180 / pi;
}

// Reference points of Chung and Ooi's test 4, with the sign of spins changed. Their restitutions are within 0.4 % of
// the closed form of sliding at all angles: they scatter less than the measurements below.
TEST(ObliqueImpact, LiesByThePointsGivenForTheFourthTest) {
  struct Point {
    double angle, restitution, spin, rebound;  ///< °; tangential; rad/s; of the contact point [°]
  };
  constexpr double radius = 2.5e-3, speed = 3.9;
  const Material& m = of_fourth[0];
  const Equations equations{m, radius, radius, 0};
  for (const Point& p : {Point{5, 0.948, 19.3, 3.8}, Point{10, 0.687, 213, -1.6}, Point{15, 0.624, 378, -5.5},
                         Point{20, 0.616, 511, -7.5}, Point{25, 0.634, 599, -7.5}, Point{30, 0.684, 617, -3.5},
                         Point{35, 0.737, 582, 3.4}, Point{40, 0.781, 545, 11.6}, Point{50, 0.845, 457, 29.4},
                         Point{60, 0.893, 357, 47.8}, Point{70, 0.932, 246, 64.6}, Point{80, 0.966, 126, 78.7},
                         Point{85, 0.983, 63, 84.5}}) {
    const Vec3 in = aslant(speed, p.angle);
    const Rebound out = off_rigid_plane(m, radius, in, Vec3::Zero());
    const Course known = equations.rebound({.closing = -in.z(), .along = in.x(), .spin = 0});
    const double leaves = rebound_angle(out.velocity.x(), out.spin.y(), out.velocity.z(), radius);
    const std::string here = at(m, " at %g°", p.angle);
    // The error of velocities is relative to the initial one, so that of the angle grows with its tangent.
    verify("rebound angle of the point of contact" + here + ", error over a tangent before of 1 [°]", leaves,
           rebound_angle(known.along, known.spin, -known.closing, radius), 1e-3, in.x() / -in.z() * 180 / pi);
    beside("tangential restitution" + here, out.velocity.x() / in.x(), p.restitution, p.restitution);
    beside("spin" + here + " [rad/s]", out.spin.y(), p.spin, p.spin);
    beside("rebound angle of the point of contact" + here + ", difference in ° [°]", leaves, p.rebound, 1);
  }
}

// Measurements of Kharaz, Gorham and Salman (2001), doi 10.1016/S0032-5910(01)00283-2, digitised for an example of
// Lethe. The plate was glass; friction and restitution are given, so that only its stiffness matters.
TEST(ObliqueImpact, LiesByWhatWasMeasuredForTheFourthTest) {
  constexpr double radius = 2.5e-3, speed = 3.9;
  const Material& m = of_fourth[0];
  const Equations equations{m, radius, radius, 0};
  struct Both {
    Rebound found;
    Course known;
  };
  const auto impact = [&](double angle) {
    const Vec3 in = aslant(speed, angle);
    return Both{off_rigid_plane(m, radius, in, Vec3::Zero()),
                equations.rebound({.closing = -in.z(), .along = in.x(), .spin = 0})};
  };
  const auto measured = [&](double angle) { return at(m, " at %g°, measured", angle); };
  for (const auto& [angle, restitution] : {std::pair{1.84, 0.793},
                                           {3.70, 0.745},
                                           {9.50, 0.673},
                                           {20.0, 0.597},
                                           {30.1, 0.688},
                                           {39.4, 0.771},
                                           {49.7, 0.848},
                                           {60.0, 0.901}}) {
    const auto [found, known] = impact(angle);
    const double along = aslant(speed, angle).x();
    verify("tangential restitution" + at(m, " at %g°", angle), found.velocity.x() / along, known.along / along, 5e-4);
    beside("tangential restitution" + measured(angle), found.velocity.x() / along, restitution, restitution);
  }
  for (const auto& [angle, spin] : {std::pair{6.14, 136.0},
                                    {11.0, 266.0},
                                    {21.3, 578.0},
                                    {31.2, 613.0},
                                    {39.1, 595.0},
                                    {50.3, 453.0},
                                    {60.3, 382.0}}) {
    const auto [found, known] = impact(angle);
    verify("spin" + at(m, " at %g°", angle) + ", error over the speed of the contact before per radius [rad/s]",
           found.spin.y(), known.spin, 5e-4, aslant(speed, angle).x() / radius);
    beside("spin" + measured(angle) + " [rad/s]", found.spin.y(), spin, spin);
  }
}

TEST(ObliqueImpact, SlidesAsChungAndOoisFifthTestSays) {
  constexpr double radius = 1e-5, normal = 5;
  // Slides throughout above tan θ = μ (7 − 1/κ), κ = 2 (1 − ν) / (2 − ν) (Maw, Barber and Fawcett 1976).
  for (const Material& m : of_fifth)
    for (const double ratio : {2.0, 3.0, 6.0, 12.0}) {
      const Rebound out = off_rigid_plane(m, radius, {ratio * normal, 0, -normal}, Vec3::Zero());
      const std::string here = at(m, " at tan θ = %g", ratio);
      verify("tangential speed" + here + " [m/s]", out.velocity.x(), (ratio - 2 * m.friction) * normal, 1e-8);
      verify("spin" + here + " [rad/s]", out.spin.y(), 5 * m.friction * normal / radius, 1e-9);
    }
}

TEST(ObliqueImpact, FollowsItsEquationsAtSmallAnglesOfTheFifthTest) {
  constexpr double radius = 1e-5, normal = 5;
  for (const Material& m : of_fifth) {
    const Equations equations{m, radius, radius, 0};
    for (const double ratio : {0.1, 0.25, 0.5, 1.0, 1.5}) {
      const Rebound out = off_rigid_plane(m, radius, {ratio * normal, 0, -normal}, Vec3::Zero());
      const Course known = equations.rebound({.closing = normal, .along = ratio * normal, .spin = 0});
      verify_rebound(at(m, " at tan θ = %g", ratio), out, known, ratio * normal, radius, 5e-4);
    }
  }
}

constexpr double radius = 0.1, normal = 0.2;  // of tests 6 to 8
/// Impulse over mass of a contact that slides throughout [m/s].
double sliding_impulse(const Material& m) { return m.friction * (1 + m.restitution) * normal; }

// The dashpot acts from the first instant, when the shear spring is not loaded yet: the slower the sphere spins, the
// more friction stays below its limit. This is a property of the law, not an error of the time step; the equations
// include it.
TEST(ObliqueImpact, SpinTurnsIntoSpeedAsChungAndOoisSixthTestSays) {
  for (const Material& m : of_sixth) {
    const double impulse = sliding_impulse(m);
    const Equations equations{m, radius, radius, 0};
    for (const double spin : {10.0, 20.0, 40.0}) {
      const Rebound out = off_rigid_plane(m, radius, {0, 0, -normal}, {0, spin, 0});
      const Course known = equations.rebound({.closing = normal, .along = 0, .spin = spin});
      const std::string from = at(m, " from %g rad/s", spin);
      EXPECT_GT(known.pushed, 0) << "sticks at first";
      if (spin == 10)
        verify("share of friction's impulse that comes short" + from, 1 - out.velocity.x() / impulse,
               1 - known.along / impulse, 1e-3, 1);
      if (spin < 20) continue;
      // The lowest point moves along −x, so that friction pushes along x.
      verify("tangential speed" + from + " [m/s]", out.velocity.x(), impulse, 5e-3);
      verify("spin" + from + " [rad/s]", out.spin.y(), spin - 2.5 * impulse / radius, 5e-3);
    }
  }
}

TEST(ObliqueImpact, FollowsItsEquationsAtSlowSpinsOfTheSixthTest) {
  for (const Material& m : of_sixth) {
    const Equations equations{m, radius, radius, 0};
    for (const double spin : {0.2, 1.0, 2.0, 4.0, 10.0, 40.0}) {
      const Rebound out = off_rigid_plane(m, radius, {0, 0, -normal}, {0, spin, 0});
      const Course known = equations.rebound({.closing = normal, .along = 0, .spin = spin});
      verify_rebound(at(m, " from %g rad/s", spin), out, known, radius * spin, radius, 3e-4);
    }
  }
}

/// Two equal spheres that collide head-on, each at this speed, with these spins about one axis.
std::array<Rebound, 2> off_each_other(const Material& m, double speed, double spin, double other_spin,
                                      const std::string& law = "hertz-mindlin") {
  const bool hertz = law == "hertz-mindlin";
  Description d = description(law, hertz ? m.hertz() : m.linear(law),
                              {{{0, 0, radius}, radius, {0, 0, -speed}, {0, spin, 0}},
                               {{0, 0, -radius}, radius, {0, 0, speed}, {0, other_spin, 0}}});
  d["time_step"]["value"] = (hertz ? m.duration(radius, speed) : m.linear_duration(radius)) / 4000;
  Trial t(d);
  do t.step();
  while ((t.position(1) - t.position(0)).norm() < 2 * radius);
  return {Rebound{t.velocity(0), t.spin(0)}, Rebound{t.velocity(1), t.spin(1)}};
}

// The motion is mirror-symmetric: the surfaces roll on each other without shear.
TEST(ObliqueImpact, OppositeSpinsRollOnEachOtherAsChungAndOoisSeventhTestSays) {
  for (const std::string law : {"hertz-mindlin", "linear-frictional", "linear-rolling"}) {
    const std::string by = law == "hertz-mindlin" ? "" : ", " + law;
    Errors tangential("tangential speed of two that spin against each other" + by + ", error over the speed before");
    Errors turning("spin of two that spin against each other" + by + ", error over that before");
    for (const Material& m : of_sixth)
      for (const double spin : {0.175, 2.0, 22.86}) {
        const auto out = off_each_other(m, normal, spin, -spin, law);
        for (const std::size_t i : {0u, 1u}) {
          const double before = i == 0 ? spin : -spin;
          tangential.add(out[i].velocity.x() / normal), turning.add(out[i].spin.y() / before - 1);
        }
        EXPECT_GT(out[0].velocity.z(), 0) << "they separate";
      }
    tangential.verify(1e-14);
    turning.verify(1e-14);
  }
}

// A rotation by 180° exchanges the two: the contact point stays at rest, as on a rigid plane. With half the overlap and
// twice the stiffness, all equations are those of test 6. Slow, so that the line of centres hardly rotates.
TEST(ObliqueImpact, LikeSpinsRubOnEachOtherAsOnAPlane) {
  Errors other("the second of two that spin alike, difference from the first over their speed before");
  for (const Material& m : of_sixth) {
    const Equations equations{m, radius, radius, 1};
    for (const double spin : {0.02, 0.2, 1.0, 4.0}) {
      constexpr double speed = 0.1 * normal;
      const auto out = off_each_other(m, speed, spin, spin);
      const Course known = equations.rebound({.closing = speed, .along = 0, .spin = spin});
      verify_rebound(" of two" + at(m, " from %g rad/s", spin), out[0], known, radius * spin, radius, 3e-4);
      other.add((out[1].velocity.x() + out[0].velocity.x()) / speed);
      other.add((out[1].spin.y() - out[0].spin.y()) / spin);
    }
  }
  other.verify(1e-12);
}

constexpr double heavy_radius = 0.5;

/// Rebound from a sphere that is a million times as dense and a thousand times as stiff.
Rebound off_heavy_sphere(const Material& m, double spin, const std::string& law = "hertz-mindlin") {
  const bool hertz = law == "hertz-mindlin";
  const Description light = hertz ? m.hertz() : m.linear(law);
  Description heavy = light;
  heavy[hertz ? "young_modulus" : "contact_modulus"] = 1e3 * m.young, heavy["density"] = 1e6 * m.density;
  Description d = description(law, light, {{{0, 0, radius}, radius, {0, 0, -normal}, {0, spin, 0}}});
  Description list = d["bodies"]["grains"];
  list["material"] = "heavy";
  list["source"]["bodies"] = Description::array({{{"position", {0, 0, -heavy_radius}}, {"radius", heavy_radius}}});
  d["bodies"]["target"] = list;
  d["materials"]["heavy"] = heavy;
  d["time_step"]["value"] = (hertz ? m.duration(radius, normal) : m.linear_duration(radius)) / 8000;
  Trial t(d);
  do t.step();
  while ((t.position(1) - t.position(0)).norm() < radius + heavy_radius);
  return {t.velocity(0), t.spin(0)};
}

TEST(ObliqueImpact, OffAMuchHeavierSphereIsOffAPlaneAsChungAndOoisEighthTestSays) {
  for (const std::string law : {"hertz-mindlin", "linear-frictional", "linear-rolling"})
    for (const Material& m : of_eighth) {
      const std::string by = law == "hertz-mindlin" ? m.name : law + ", " + m.name;
      const Rebound out = off_heavy_sphere(m, 20, law);
      const double impulse = m.friction * (1 + m.restitution_by(law)) * normal;
      verify("tangential speed, " + by + " [m/s]", out.velocity.x(), impulse, 5e-3);
      verify("spin, " + by + " [rad/s]", out.spin.y(), 20 - 2.5 * impulse / radius, 5e-3);
    }
}

TEST(ObliqueImpact, FollowsItsEquationsAtSlowSpinsOfTheEighthTest) {
  const double reduced = radius * heavy_radius / (radius + heavy_radius);
  for (const Material& m : of_eighth) {
    const Equations equations{m, radius, reduced, reduced / heavy_radius};
    for (const double spin : {0.2, 1.0, 2.0, 4.0, 10.0}) {
      const Course known = equations.rebound({.closing = normal, .along = 0, .spin = spin});
      // The deformation of the heavy sphere is a thousandth of that of the light one.
      verify_rebound(at(m, " from %g rad/s", spin), off_heavy_sphere(m, spin), known, radius * spin, radius, 3e-4);
    }
  }
}

// The linear law for the balls of tests 1 to 6, with their Young's modulus as contact modulus.
TEST(ObliqueImpact, LinearLawHitsAsItsSpringSaysWithTheBallsOfTheFirstThreeTests) {
  struct Ball {
    const char* name;
    double modulus, density, radius, speed;
    bool plane;
  };
  for (const Ball& b : {Ball{"glass", 48e9, 2800, 0.01, 10, false}, Ball{"limestone", 20e9, 2500, 0.01, 10, false},
                        Ball{"aluminium", 70e9, 2700, 0.1, 0.2, true}, Ball{"magnesium", 40e9, 1800, 0.1, 0.2, true},
                        Ball{"oxide", 380e9, 4000, 0.0025, 3.9, true}, Ball{"iron", 100e9, 7000, 0.0025, 3.9, true}})
    for (const double restitution : {1.0, 0.5}) {
      // Two equal spheres move half the distance each: twice the stiffness and twice the overlap.
      const double stiffness = (b.plane ? 1 : 2) * b.modulus * b.radius,
                   mass = b.density * 4 / 3 * pi * std::pow(b.radius, 3);
      const double turn = std::sqrt(stiffness / mass), share = b.plane ? 1 : 2;
      const Description material{
          {"density", b.density}, {"contact_modulus", b.modulus}, {"friction_angle", 0}, {"restitution", restitution}};
      std::vector<Grain> grains{{{0, 0, b.radius}, b.radius, {0, 0, -b.speed}}};
      if (!b.plane) grains.push_back({{0, 0, -b.radius}, b.radius, {0, 0, b.speed}});
      Description d = description("linear-frictional", material, grains);
      if (b.plane) d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
      d["time_step"]["value"] = pi / turn / 4000;
      Trial t(d);
      double overlap = 0, force = 0;
      do {
        t.step();
        overlap = std::max(overlap, share * (b.radius - t.position(0).z()));
        for (const Contact& contact : t.world().contacts()) force = std::max(force, contact.normal_force);
      } while (t.position(0).z() < b.radius);
      const std::string here = std::string(", ") + b.name + " [";
      const double speed = t.velocity(0).z();
      if (restitution < 1) {
        verify("restitution of 0.5, linear, " + std::string(b.name) + ", error absolute", speed / b.speed, restitution,
               1e-4, 1);
        continue;
      }
      const double duration = t.world().time() - (t.position(0).z() - b.radius) / speed;
      verify("overlap of a linear impact" + here + "m]", overlap, share * b.speed / turn, 1e-6);
      verify("force of a linear impact" + here + "N]", force, b.speed * std::sqrt(stiffness * mass), 1e-6);
      verify("duration of a linear impact" + here + "s]", duration, pi / turn, 1e-6);
    }
}

TEST(ObliqueImpact, LinearLawSlidesAsCoulombSaysWithTheBallsOfTheFourthToSixthTests) {
  const auto slide = [](const Material& m, double r, const Vec3& in, double spin, const std::string& here) {
    const Description material = m.linear("linear-frictional");
    const double duration = pi * std::sqrt(m.mass(r) / (m.young * r));
    const Rebound out = from_plane("linear-frictional", material, material, r, in, {0, spin, 0}, duration / 4000);
    const double impulse = m.friction * (1 + m.restitution) * -in.z(), sign = spin == 0 ? -1 : 1;
    verify("change of tangential speed by sliding, linear" + here + " [m/s]", out.velocity.x() - in.x(), sign * impulse,
           5e-3);
    verify("spin by sliding, linear" + here + " [rad/s]", out.spin.y(), spin - sign * 2.5 * impulse / r, 5e-3);
  };
  for (const Material& m : of_fourth)
    for (const double angle : {45.0, 60.0, 80.0}) slide(m, 2.5e-3, aslant(3.9, angle), 0, at(m, " at %g°", angle));
  for (const Material& m : of_fifth)
    for (const double ratio : {3.0, 12.0}) slide(m, 1e-5, {5 * ratio, 0, -5}, 0, at(m, " at tan θ = %g", ratio));
  for (const Material& m : of_sixth)
    for (const double spin : {20.0, 40.0}) slide(m, radius, {0, 0, -normal}, spin, at(m, " from %g rad/s", spin));
}

/// Linear springs on a plane; with κ = 2/7 the contact point oscillates with the period of the normal spring.
struct Linear {
  static constexpr double modulus = 1e8, radius = 1e-3, density = 2500;
  double mass = density * 4 / 3 * pi * radius * radius * radius;
  double duration = pi / std::sqrt(modulus * radius / mass);
  static Description material(double ratio, double friction) {
    return {{"density", density},
            {"contact_modulus", modulus},
            {"shear_to_normal_stiffness", ratio},
            {"friction_angle", std::atan(friction)}};
  }
  static Description material(const std::string& law, double ratio, double friction) {
    Description m = material(ratio, friction);
    if (law == "linear-rolling") m["rolling_limit"] = 0;
    return m;
  }
};

TEST(ObliqueImpact, StickingContactGivesBackAllOfItsTangentialSpeed) {
  const Linear ball;
  for (const std::string law : {"linear-rolling", "linear-frictional"}) {
    const Description material = Linear::material(law, 2.0 / 7, 10);
    for (const double angle : {5.0, 30.0, 60.0, 80.0}) {
      const Vec3 in = aslant(0.01, angle);  // slow, so that the overlap is small
      const Rebound out = from_plane(law, material, material, ball.radius, in, Vec3::Zero(), ball.duration / 500);
      // The velocity of the contact point is reversed: 2/7 of its change is that of the centre.
      const std::string at = ", " + law + " at " + std::to_string(int(angle)) + "°";
      verify("tangential speed" + at + " [m/s]", out.velocity.x(), in.x() * (1 - 2 * 2.0 / 7), 2e-4);
      verify("spin" + at + " [rad/s]", out.spin.y(), 2.5 * 2 * 2.0 / 7 * in.x() / ball.radius, 2e-4);
    }
  }
}

// Slides throughout above tan θ = 7 μ, if that is also above μ over the ratio of stiffnesses.
TEST(ObliqueImpact, LinearLawsSlideAsCoulombSays) {
  const Linear ball;
  constexpr double friction = 0.1, speed = 0.01;
  for (const std::string law : {"linear-rolling", "linear-frictional"})
    for (const double restitution : {1.0, 0.6}) {
      if (law == "linear-rolling" && restitution < 1) continue;
      // A dashpot acts immediately, when the shear spring is not loaded yet; the spring must be loaded soon.
      Description material = Linear::material(law, restitution < 1 ? 10 : 0.3, friction);
      if (restitution < 1) material["restitution"] = restitution;
      for (const double angle : {45.0, 55.0, 65.0, 75.0, 85.0}) {
        const Vec3 in = aslant(speed, angle);
        const double allowed = restitution < 1 ? 2e-3 : 1e-8;
        const Rebound out = from_plane(law, material, material, ball.radius, in, Vec3::Zero(), ball.duration / 4000);
        const double impulse = friction * (1 + restitution) * -in.z();
        char at[64];
        std::snprintf(at, sizeof at, ", %s, restitution %g, at %g°", law.c_str(), restitution, angle);
        verify(std::string("loss of tangential speed by sliding") + at + " [m/s]", in.x() - out.velocity.x(), impulse,
               allowed);
        verify(std::string("spin by sliding") + at + " [rad/s]", out.spin.y(), 2.5 * impulse / ball.radius, allowed);
      }
    }
}

}  // namespace
}  // namespace grit::test::oblique_impact_tests
