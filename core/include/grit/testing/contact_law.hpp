// Tests that every contact law must pass. A plugin's test includes this file once and writes
//   INSTANTIATE_TEST_SUITE_P(MyLaw, ContactLawContract, testing::ValuesIn(setups()), setup_name);
// with at least one setup for each combination of the law's features. Radii are about 1 m and masses 1 kg; stiffnesses
// should be 1e5 … 1e7 N/m, so that a step of 1e-5 s is small.
// A law without single precision is not tested for it. Set LawSetup::attracts for a law with attraction, and clear
// LawSetup::usual_limits for a law whose limits are not those of friction_angle, rolling_limit and twisting_limit, and
// LawSetup::losses for a law without losses().
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ostream>
#include <random>

#include "grit/testing/laws.hpp"
#include "grit/testing/pairs.hpp"

namespace grit::test {

/// One combination of features of a law, with parameters, and what the contract has to know about it.
struct LawSetup {
  std::string name;        ///< letters and digits
  LawValues values;        ///< at least three materials
  std::size_t state_size;  ///< numbers in the contact history
  /// A wall is evaluated as a sphere of this radius, over that of the body; 1 for laws with radius_b = radius_a;
  /// 0 if no sphere acts like a wall.
  double wall_sphere = 1;
  bool attracts = false;  ///< its normal force may be negative
  /// Whether shear force, rolling and twisting moment have the limits tan(friction_angle) F_n, rolling_limit R F_n and
  /// twisting_limit R F_n, with the mean radius R. A law without one of them does not have its parameter.
  bool usual_limits = true;
  /// Whether the law reports what it dissipates: LawTraits::losses. Of one that does not, no more is tested than that
  /// it creates no energy.
  bool losses = true;
};
inline std::ostream& operator<<(std::ostream& out, const LawSetup& setup) { return out << setup.name; }
inline std::string setup_name(const testing::TestParamInfo<LawSetup>& info) { return info.param.name; }

/// `values` with the parameter `name` set to 0, for all materials or only for the first.
inline LawValues without(LawValues values, const std::string& name, bool everywhere = true) {
  for (std::size_t m = 0; m < (everywhere ? values.materials.size() : 1); ++m) values.materials[m][name] = 0.0;
  for (auto& [pair, overrides] : values.interfaces)
    if (everywhere || (pair.first == 0 && pair.second == 0))
      if (const auto own = overrides.find(name); own != overrides.end()) own->second = 0.0;
  return values;
}

/// What every contact law must fulfil.
class ContactLawContract : public testing::TestWithParam<LawSetup> {
 protected:
  static constexpr double dt_ = 1e-5;
  std::unique_ptr<ContactLaw> law_ = make_law(GetParam().values);
  std::mt19937 random_{20110277};

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Vec3 direction() {
    Vec3 v = vector(1);
    while (v.norm() < 0.1 || v.norm() > 1) v = vector(1);
    return v.normalized();
  }
  double value(std::size_t material, const std::string& name) const {
    return std::get<double>(GetParam().values.materials[material].at(name));
  }
  /// The smaller of two materials' values; 0 for a parameter that the setup does not give.
  double smaller(std::size_t a, std::size_t b, const std::string& name) const {
    return GetParam().values.materials[a].contains(name) ? std::min(value(a, name), value(b, name)) : 0;
  }

  /// Pairs in contact, nearly in contact, opening and closing, with a history of some steps; every seventh is padding.
  /// `lonely`: each pair has its own block.
  Pairs scene(bool periodic, bool materials, bool lonely = false) {
    Pairs pairs(*law_, dt_);
    pairs.one_material = !materials;
    if (periodic) pairs.shifts = {{}, {{40, 0, 0, 0}, {0.5, 0, 0, 0}}, {{-3, 40, 7, 0}, {0, -0.5, 0.2, 0}}};
    for (int n = 0; n < (lonely ? 180 : 60); ++n) {
      if (n % 7 == 3) pairs.skip();
      while (lonely && pairs.places() / block_size < static_cast<std::size_t>(n)) pairs.skip();
      const double radius_a = uniform(0.5, 1.5), radius_b = uniform(0.5, 1.5);
      const Vec3 centre = vector(30), normal = direction();
      const auto image = static_cast<std::uint8_t>(periodic ? n % 3 : 0);
      const Vec3 shift = periodic ? vec(pairs.shifts[image].position) : Vec3::Zero();
      const Vec3 drift = periodic ? vec(pairs.shifts[image].velocity) : Vec3::Zero();
      const auto kind = [&] { return static_cast<std::uint8_t>(materials ? random_() % 3 : 0); };
      const std::uint32_t a = pairs.add({centre, radius_a, vector(1), vector(2), uniform(0.5, 2), kind()});
      const Vec3 other = centre + (radius_a + radius_b) * uniform(0.92, 1.03) * normal - shift;
      const std::uint32_t b = pairs.add(
          {other, radius_b, vec(pairs.velocity(a)) + vector(20) - drift, vector(300), uniform(0.5, 2), kind()});
      pairs.pair(a, b, image);
    }
    for (int step = 0; step < 30; ++step) pairs.step();
    return pairs;
  }
  Vec3 branch(Pairs& pairs, std::size_t c) {
    Vec3 d = vec(pairs.position(pairs.b(c))) - vec(pairs.position(pairs.a(c)));
    return pairs.shifts.empty() ? d : d + vec(pairs.shifts[pairs.image(c)].position);
  }
  /// Relative round-off of values that follow from the overlap, a small difference of large numbers.
  double round_off(Pairs& pairs, std::size_t c) {
    const double reach = pairs.position(pairs.a(c)).w + pairs.position(pairs.b(c)).w;
    return 1e-14 *
           (1 + 0.1 * (reach + branch(pairs, c).cwiseAbs().maxCoeff()) / std::max(std::abs(pairs.overlap(c)), 1e-9));
  }
  /// Order of magnitude of a field with this unit.
  double scale(Pairs& pairs, std::size_t c, const std::string& unit) {
    const double force = vec(pairs.row(c).force).norm(), radius = pairs.position(pairs.a(c)).w;
    return unit == "N" ? force : unit == "N m" ? force * radius : radius;
  }
  double spring_force(Pairs& pairs, std::size_t c) {
    const std::uint32_t a = pairs.a(c), b = pairs.b(c);
    const PairSize size{.radius_a = pairs.position(a).w,
                        .radius_b = pairs.position(b).w,
                        .inverse_mass_a = pairs.velocity(a).w,
                        .inverse_mass_b = pairs.velocity(b).w,
                        .overlap = pairs.overlap(c)};
    return law_->stiffness(size, pairs.material(a), pairs.material(b)).normal * size.overlap;
  }
  /// The moment of the law on b, without that of the shear force.
  Vec3 law_moment(Pairs& pairs, std::size_t c) {
    const Vec3 n = branch(pairs, c).normalized(), force = vec(pairs.row(c).force);
    const double radius_a = pairs.position(pairs.a(c)).w, radius_b = pairs.position(pairs.b(c)).w;
    const double arm = radius_b * branch(pairs, c).norm() / (radius_a + radius_b);
    return vec(pairs.row(c).moment) + arm * n.cross(force);
  }
  Vec3 shear(Pairs& pairs, std::size_t c) {
    const Vec3 n = branch(pairs, c).normalized(), force = vec(pairs.row(c).force);
    return force - force.dot(n) * n;
  }

  /// Response::shear: the shear force on b times the distance of the centres over the sum of the radii.
  Vec3 law_shear(Pairs& pairs, std::size_t c) {
    const double reach = pairs.position(pairs.a(c)).w + pairs.position(pairs.b(c)).w;
    return branch(pairs, c).norm() / reach * shear(pairs, c);
  }

  /// Two spheres of radius 1 and 0.7 in contact along z, with the given overlap.
  Pairs two(double overlap, double dt = dt_) {
    Pairs pairs(*law_, dt);
    pairs.add({.position = Vec3::Zero(), .radius = 1});
    pairs.add({.position = {0, 0, 1.7 - overlap}, .radius = 0.7});
    pairs.pair(0, 1);
    return pairs;
  }
  static PairSize size(Pairs& pairs, double overlap) {
    return {.radius_a = pairs.position(0).w,
            .radius_b = pairs.position(1).w,
            .inverse_mass_a = pairs.velocity(0).w,
            .inverse_mass_b = pairs.velocity(1).w,
            .overlap = overlap};
  }
  /// Slips by `distance` along x in one step, then rests for one step: springs keep their force, dashpots do not.
  static void slip(Pairs& pairs, double distance) {
    const double spin = -distance / pairs.dt / (pairs.position(0).w + pairs.position(1).w);
    set(pairs.spin(0), {0, spin, 0}), set(pairs.spin(1), {0, spin, 0});
    pairs.step(), rest(pairs), pairs.step();
  }
  static void roll(Pairs& pairs, double angle) {
    const double ra = pairs.position(0).w, rb = pairs.position(1).w, rate = angle / pairs.dt / (ra + rb);
    set(pairs.spin(0), {0, -rate * rb, 0}), set(pairs.spin(1), {0, rate * ra, 0});
    pairs.step(), rest(pairs), pairs.step();
  }
  static void twist(Pairs& pairs, double angle) {
    set(pairs.spin(1), {0, 0, 0.5 * angle / pairs.dt}), set(pairs.spin(0), {0, 0, -0.5 * angle / pairs.dt});
    pairs.step(), rest(pairs), pairs.step();
  }
  static void rest(Pairs& pairs) {
    for (std::size_t i = 0; i < pairs.count(); ++i)
      set(pairs.velocity(i), Vec3::Zero()), set(pairs.spin(i), Vec3::Zero());
  }
  /// Moves body 1 to `to` in one step.
  static void move(Pairs& pairs, const Vec3& to) {
    set(pairs.velocity(1), (to - vec(pairs.position(1))) / pairs.dt);
    pairs.step();
  }
  static void sleeps_until_one_can(const ContactLaw& law) {
    Pairs pairs(law, dt_);
    const double nearest = 0.25, reach = law.reach({1, 1, 1, 1, 0, false}, 0, 0);
    for (std::size_t c = 0; c < block_size; ++c) {
      const double gap = nearest + static_cast<double>((c + 3) % block_size);
      const auto a = pairs.add({.position = {100.0 * static_cast<double>(c), 0, 0}, .radius = 1});
      pairs.pair(a, pairs.add({.position = vec(pairs.position(a)) + Vec3(2 + reach + gap, 0, 0), .radius = 1}));
    }
    const std::size_t first = block_size - 3;
    pairs.asleep_until = {0}, pairs.closing = 3;
    pairs.evaluate();
    const float until = pairs.asleep_until[0];
    EXPECT_LE(until, 3 + nearest);
    EXPECT_GT(until, 3 + nearest - 1e-5);
    pairs.position(pairs.b(first)).x -= nearest + 0.01;
    pairs.closing = std::nextafter(until, 0.0f);
    pairs.evaluate();
    EXPECT_FALSE(pairs.touching(first));
    pairs.closing = until;
    pairs.evaluate();
    EXPECT_TRUE(pairs.touching(first));
    // A block is evaluated as long as it has a contact, and may be skipped again afterwards.
    pairs.closing = 0;
    pairs.position(pairs.b(first)).x += 0.51;
    pairs.evaluate();
    EXPECT_FALSE(pairs.touching(first));
    EXPECT_NEAR(pairs.asleep_until[0], 0.5, 1e-5);
  }
  bool has_single_precision() {
    Parameters parameters;
    law_->declare(parameters);
    return std::ranges::any_of(parameters.entries(), [](const Parameter& p) { return p.name() == "precision"; });
  }
  bool stiffness_follows_overlap() {
    Pairs pairs = two(0.01);
    return law_->stiffness(size(pairs, 0.01), 0, 0).normal != law_->stiffness(size(pairs, 0.02), 0, 0).normal;
  }
};

/// Links the tests into a program that includes this file.
int contact_law_contract();
inline const int contact_law_contract_is_linked = contact_law_contract();

}  // namespace grit::test
