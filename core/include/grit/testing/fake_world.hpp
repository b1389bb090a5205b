// A World whose state a test sets: fill the public members.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "grit/world.hpp"

namespace grit {

/// Clearance from a plane wall that is solid behind; `normal` is its unit normal, towards the bodies.
inline std::function<std::optional<Clearance>(const Vec3&)> flat_surface(const Vec3& point, const Vec3& normal) {
  return [=](const Vec3& x) { return Clearance{normal.dot(x - point), -normal}; };
}

/// A world of which a test sets each part.
struct FakeWorld : World {
  double now = 0, time_step = 1e-6, density = 2600;
  std::uint64_t steps = 0;
  std::string stage_name = "stage";
  std::vector<std::uint32_t> id;
  std::vector<Row> position, velocity, spin, force, moment;
  std::vector<std::uint8_t> material;
  std::vector<Vec3> rotation, displacement;
  std::vector<Contact> contact;  ///< pairs first
  std::vector<WallView> wall;
  std::vector<Departure> departure;
  Cell box{Vec3::Constant(-std::numeric_limits<double>::infinity()),
           Vec3::Constant(std::numeric_limits<double>::infinity())};
  Region whole{Vec3::Zero(), Vec3::Ones()};  ///< the specimen
  std::optional<Region> with_grooves;        ///< the envelope, if it differs from the specimen
  std::vector<std::function<std::optional<Clearance>(const Vec3&)>> surface;  ///< of walls, by index; may be shorter
  std::vector<double> volume_fraction;                                        ///< of bodies in clumps; empty: all 1
  std::vector<Vec3> arm;                                                      ///< of bodies in clumps

  /// Adds a sphere of `density`; returns its index.
  std::uint32_t add(const Vec3& centre, double radius, const Vec3& speed = Vec3::Zero(),
                    const Vec3& turn = Vec3::Zero()) {
    const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;
    const auto index = static_cast<std::uint32_t>(position.size());
    id.push_back(index);
    position.push_back({centre[0], centre[1], centre[2], radius});
    velocity.push_back({speed[0], speed[1], speed[2], 1 / mass});
    spin.push_back({turn[0], turn[1], turn[2], 1 / (0.4 * mass * radius * radius)});
    force.push_back({});
    moment.push_back({});
    material.push_back(0);
    return index;
  }
  /// Adds a contact of two bodies with this force on b [N]; the branch may cross a periodic side.
  void add_contact(std::uint32_t a, std::uint32_t b, const Vec3& branch, const Vec3& force_on_b) {
    Contact pair;
    pair.a = a, pair.b = b;
    pair.overlap = position[a].w + position[b].w - branch.norm();
    fill(pair, branch, force_on_b);
  }
  /// Adds a contact with a wall; `branch` reaches from the body's centre to the contact point [m].
  void add_wall_contact(std::uint32_t body, std::uint32_t wall_index, const Vec3& branch, const Vec3& force_on_wall) {
    Contact touching;
    touching.a = body, touching.b = wall_index, touching.with_wall = true;
    touching.overlap = position[body].w - branch.norm();
    fill(touching, branch, force_on_wall);
  }
  void make_periodic(const Vec3& low, const Vec3& high) { box = {low, high, {true, true, true}}, whole = {low, high}; }

  double time() const override { return now; }
  std::uint64_t step() const override { return steps; }
  double dt() const override { return time_step; }
  const std::string& stage() const override { return stage_name; }
  std::span<const std::uint32_t> ids() const override { return id; }
  std::span<const Row> positions() const override { return position; }
  std::span<const Row> velocities() const override { return velocity; }
  std::span<const Row> spins() const override { return spin; }
  std::span<const std::uint8_t> materials() const override { return material; }
  std::span<const Vec3> rotations() const override { return rotation; }
  std::span<const Vec3> displacements() const override { return displacement; }
  std::span<const Row> forces() const override { return force; }
  std::span<const Row> moments() const override { return moment; }
  std::span<const Contact> contacts() const override { return contact; }
  std::span<const WallView> walls() const override { return wall; }
  std::optional<Clearance> clearance(std::size_t w, const Vec3& point, double reach) const override {
    const auto found = w < surface.size() ? surface[w](point) : std::nullopt;
    return found && found->distance < reach ? found : std::nullopt;
  }
  std::span<const Vec3> arms() const override { return arm; }
  std::span<const double> volume_fractions() const override { return volume_fraction; }
  std::span<const Departure> departures() const override { return departure; }
  const Cell& cell() const override { return box; }
  Region specimen() const override { return whole; }
  Region envelope() const override { return with_grooves.value_or(whole); }
  Region interior(double margin) const override {
    Region inner = whole;
    for (int k = 0; k < 3; ++k)
      if (!box.periodic[static_cast<std::size_t>(k)]) inner.low[k] += margin, inner.high[k] -= margin;
    return inner;
  }
  double mean_diameter() const override {
    double sum = 0;
    for (const auto& body : position) sum += 2 * body.w;
    return position.empty() ? 0 : sum / static_cast<double>(position.size());
  }
  double solid_density() const override { return density; }

 private:
  void fill(Contact& made, const Vec3& branch, const Vec3& force_on_b) {
    made.branch = branch, made.normal = branch.normalized(), made.force = force_on_b, made.moment = Vec3::Zero();
    made.normal_force = force_on_b.dot(made.normal);
    contact.push_back(made);
  }
};

}  // namespace grit
