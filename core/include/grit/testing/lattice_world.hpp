// A world for the tests of probes and engines, and its state at later instants.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "grit/testing/fake_world.hpp"

namespace grit {

/// A wall at rest without load.
inline WallView still_wall(std::string name) {
  WallView wall;
  wall.name = std::move(name);
  for (auto* vector :
       {&wall.position, &wall.stage_position, &wall.velocity, &wall.spin, &wall.force, &wall.moment, &wall.normal})
    vector->setZero();
  return wall;
}

/// A box of nx × ny × nz grains on a cubic lattice with its low corner at (0, 0, 0). The spacing is 0.99 diameters;
/// forces, velocities and sizes differ from grain to grain. Walls "bottom" and "top-wall" carry the lowest and highest
/// layer. `diameter` in m.
inline FakeWorld lattice_world(int nx, int ny, int nz, double diameter = 0.5e-3) {
  FakeWorld world;
  const double spacing = 0.99 * diameter;
  const auto vary = [](int i, int period) { return 1 + 0.2 * ((i % period) - period / 2) / period; };
  const auto index = [=](int i, int j, int k) { return static_cast<std::uint32_t>((i * ny + j) * nz + k); };
  world.wall = {still_wall("bottom"), still_wall("top-wall")};
  world.wall[0].normal = Vec3::UnitZ(), world.wall[1].normal = -Vec3::UnitZ();
  world.wall[1].velocity = {1e-3, 0, -1e-5}, world.wall[1].position = {2e-3, 0, -1e-4};
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const int count = static_cast<int>(world.position.size());
        const auto body = world.add((Vec3(i, j, k).array() + 0.5) * spacing, 0.5 * diameter * vary(count, 7),
                                    1e-3 * Vec3(vary(count, 3), -vary(count, 5), 0.1), Vec3(0.1, vary(count, 4), 0));
        world.force[body] = {1e-6 * vary(count, 5), -1e-6, 2e-6, 0};
      }
  const double volume = spacing * spacing;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const int count = static_cast<int>(world.contact.size());
        const auto contact = [&](int di, int dj, int dk, double pressure) {
          if (i + di < nx && j + dj < ny && k + dk < nz)
            world.add_contact(index(i, j, k), index(i + di, j + dj, k + dk), spacing * Vec3(di, dj, dk),
                              volume * pressure * vary(count, 9) * Vec3(di + 0.1, dj, dk));
        };
        contact(1, 0, 0, 50e3), contact(0, 1, 0, 60e3), contact(0, 0, 1, 100e3);
      }
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (const int side : {0, 1}) {
        const Vec3 out = side == 0 ? Vec3(0, 0, -1) : Vec3(0, 0, 1);
        auto& wall = world.wall[static_cast<std::size_t>(side)];
        world.add_wall_contact(index(i, j, side == 0 ? 0 : nz - 1), static_cast<std::uint32_t>(side),
                               0.5 * spacing * out, volume * 100e3 * out);
        wall.force += volume * 100e3 * out, ++wall.contacts;
      }
  for (auto& wall : world.wall) wall.area = nx * ny * volume, wall.pressure = std::abs(wall.force.z()) / wall.area;
  world.whole = {Vec3::Zero(), spacing * Vec3(nx, ny, nz)};
  world.surface = {flat_surface(world.whole.low, Vec3::UnitZ()), flat_surface(world.whole.high, -Vec3::UnitZ())};
  world.now = 0.25, world.steps = 250000;
  return world;
}

/// The world some samples later, 0.1 ms each: bodies have moved and rotated, walls have moved, and contact forces have
/// changed in ways that do not follow from the earlier state.
inline FakeWorld later(FakeWorld world, int samples) {
  const auto vary = [=](std::size_t i) { return std::sin(1.7 * samples * static_cast<double>(i % 13 + 1)); };
  world.now += 1e-4 * samples, world.steps += 100u * static_cast<unsigned>(samples);
  const double diameter = world.mean_diameter();
  for (std::size_t i = 0; i < world.position.size(); ++i) {
    const double moved = 0.02 * diameter * vary(i);
    world.position[i].x += moved, world.position[i].z += 0.5 * moved;
    world.velocity[i].x *= 1 + 0.5 * vary(i), world.force[i].x *= 1 + 0.5 * vary(i + 3);
    if (!world.rotation.empty()) world.rotation[i] += 0.1 * Vec3(vary(i), vary(i + 1), vary(i + 2));
    if (!world.displacement.empty()) world.displacement[i] += Vec3(moved, 0, 0.5 * moved);
  }
  for (std::size_t c = 0; c < world.contact.size(); ++c) {
    const double factor = 1 + 0.95 * vary(c);
    world.contact[c].force *= factor, world.contact[c].normal_force *= factor;
  }
  for (auto& wall : world.wall) {
    wall.position.x() += 1e-6 * samples, wall.stage_position.x() += 1e-6 * samples;
    wall.velocity.x() += 1e-3 * vary(5), wall.pressure *= 1 + 0.5 * vary(2);
  }
  return world;
}

}  // namespace grit
