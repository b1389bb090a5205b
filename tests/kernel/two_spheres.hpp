// States of a few equal spheres.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kernel/passes.hpp"
#include "kernel/state.hpp"
#include "support/scene.hpp"

namespace grit::test {

inline constexpr double radius = 1e-3, density = 2500;
inline double sphere_mass() { return density * 4.0 / 3.0 * 3.14159265358979323846 * radius * radius * radius; }
inline double sphere_inertia() { return 0.4 * sphere_mass() * radius * radius; }

/// A box from −10 mm to 10 mm along each axis.
inline Cell box(std::array<bool, 3> periodic = {false, false, false}) {
  return {Vec3::Constant(-0.01), Vec3::Constant(0.01), periodic};
}

/// A law with one material, mixed.
inline std::shared_ptr<ContactLaw> law(const std::string& name) {
  const auto law = installed().make<ContactLaw>(name);
  Parameters material;
  law->declare_material("sand", material);
  const std::vector<std::string> names{"sand"};
  law->mix(names, 1);
  return law;
}

/// Spheres at rest.
inline State spheres(const std::vector<Vec3>& centres, const Cell& cell = box(),
                     const std::string& law_name = "linear-frictional") {
  State state(cell);
  for (const Vec3& centre : centres) state.bodies.add(centre, radius, sphere_mass(), sphere_inertia(), 0);
  state.bodies.finish({});
  state.statistics.add(state.bodies, 0, 0, {});
  state.materials = {"sand"};
  state.settings.law = law(law_name);
  state.settings.fields = state.settings.law->state();
  state.pairs.set_fields(state.settings.fields), state.wall_contacts.set_fields(state.settings.fields);
  state.sum.resize(state.bodies.count() + 1);
  state.cell.update_images(0);
  return state;
}

/// Two spheres along x, whose centres are `distance` [m] apart, about the origin.
inline State two_spheres(double distance, const Cell& cell = box(), const std::string& law_name = "linear-frictional") {
  return spheres({{-0.5 * distance, 0, 0}, {0.5 * distance, 0, 0}}, cell, law_name);
}

/// A floor at z = 0.
inline WallSurface floor_surface() {
  const auto geometry = installed().make<Geometry>("plane");
  Parameters parameters;
  geometry->declare(parameters);
  geometry->prepare();
  WallSurface surface;
  surface.geometry = geometry;
  return surface;
}

/// Sets the velocity of a body [m/s].
inline void set_velocity(State& state, std::size_t body, const Vec3& v) {
  Row& row = state.bodies.velocity[body];
  row = {v.x(), v.y(), v.z(), row.w};
}

/// As if the bodies of the only chunk had moved along x at speeds up to this [m/s].
inline void set_speed(Passes& passes, double speed) {
  passes.chunks()[0].motion.velocities = {{-speed, 0, 0}, {speed, 0, 0}};
  passes.chunks()[0].relative_speed = speed;
}

/// Updates neighbour lists and contacts.
inline void search(State& state, Passes& passes, const Renumbering& now = {}) {
  passes.resize(state.bodies.count());
  state.lists.rebuild(state.bodies, state.cell, state.statistics, state.reaches(), state.time.dt, 0, passes);
  state.pairs.rebuild(state.bodies, state.lists.search(), state.cell.periodic(), state.settings.fields, now, {},
                      passes.ranks(), passes.team());
  state.lists.compare_velocities(state.pairs.reached(), passes.ranks());
  state.wall_contacts.rebuild(state.bodies, state.group, state.surfaces, state.lists.skins(), state.settings.fields,
                              now, passes.ranks(), passes.team());
}

/// Evaluates the contacts of the only chunk.
inline void evaluate(State& state) {
  std::fill(state.sum.begin(), state.sum.end(), BodySum{});
  state.overlap = state.pairs.evaluate(ContactTable::Kind::within, 0, state.instant(false), state.sum.data(), nullptr);
  state.pairs.gather(0, state.sum.data());
}

}  // namespace grit::test
