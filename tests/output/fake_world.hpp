// Worlds whose values identify each body.
#pragma once

#include "grit/testing/fake_world.hpp"

namespace grit {

struct NumberedWorld : FakeWorld {
  NumberedWorld() { stage_name = "shear"; }

  /// A grain whose velocity and spin follow from its id.
  void add(std::uint32_t number, const Vec3& centre, double radius) {
    const double n = number;
    const auto index = FakeWorld::add(centre, radius, {n, n + 0.25, n + 0.5}, {-n, 2 * n, 3 * n});
    id[index] = number;
    material[index] = static_cast<std::uint8_t>(number % 2);
  }

  void add_wall(const std::string& name, const Vec3& moved) {
    const Vec3 zero = Vec3::Zero();
    wall.push_back({name, moved, moved, zero, zero, zero, zero, 0, 0, zero, 0, false, {}});
  }
};

}  // namespace grit
