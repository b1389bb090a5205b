// A world that is what a test says it is.
#pragma once

#include "grit/world.hpp"

namespace grit {

class FakeWorld : public World {
 public:
  double now = 0;
  std::uint64_t steps = 0;
  std::string stage_name = "shear";
  std::vector<std::uint32_t> id;
  std::vector<Row> position, velocity, spin, force, moment;
  std::vector<std::uint8_t> material;
  std::vector<Vec3> rotation, displacement;
  std::vector<Contact> contact;
  std::vector<WallView> wall;
  Cell box;

  /// A grain whose velocity and spin can be told from its id.
  void add(std::uint32_t number, const Vec3& centre, double radius) {
    const double n = number;
    id.push_back(number);
    position.push_back({centre.x(), centre.y(), centre.z(), radius});
    velocity.push_back({n, n + 0.25, n + 0.5, 1});
    spin.push_back({-n, 2 * n, 3 * n, 1});
    material.push_back(static_cast<std::uint8_t>(number % 2));
  }

  void add_wall(const std::string& name, const Vec3& moved) {
    const Vec3 zero = Vec3::Zero();
    wall.push_back({name, moved, moved, zero, zero, zero, zero, 0, 0, zero, 0});
  }

  double time() const override { return now; }
  std::uint64_t step() const override { return steps; }
  double dt() const override { return 1e-6; }
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
  const Cell& cell() const override { return box; }
  Region specimen() const override { return {Vec3(0, 0, 0), Vec3(1, 1, 1)}; }
  Region interior(double margin) const override { return {Vec3::Constant(margin), Vec3::Constant(1 - margin)}; }
  double mean_diameter() const override {
    double sum = 0;
    for (const auto& row : position) sum += 2 * row.w;
    return position.empty() ? 0 : sum / static_cast<double>(position.size());
  }
  double solid_density() const override { return 2600; }
};

}  // namespace grit
