#include "bodies/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies/reordering.hpp"
#include "bodies/restored.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

/// Ids and indices have 32 bits, the padding has an index too, and the largest one means none.
constexpr std::size_t most_bodies = std::numeric_limits<std::uint32_t>::max() - 2;

/// Values of `count` bodies and of the padding after them.
template <class Array>
void permute(Array& values, std::span<const std::uint32_t> order, std::size_t count, Team& team) {
  if (values.empty()) return;
  Array moved(order.size() + values.size() - count);
  team.each_body(order.size(), [&](std::size_t i) { moved[i] = values[order[i]]; });
  for (std::size_t i = order.size(); i < moved.size(); ++i) moved[i] = values[count + i - order.size()];
  values.swap(moved);
}

bool finite(const Row& row) {
  return std::isfinite(row.x) && std::isfinite(row.y) && std::isfinite(row.z) && std::isfinite(row.w);
}

void check_restored(const Clumps& clumps, std::size_t bodies, std::uint32_t ids_given) {
  expect_restored(clumps.of_body.empty() ? clumps.none() : clumps.of_body.size() == bodies,
                  "the bodies of clumps have another number than the bodies");
  expect_restored(clumps.volume_fraction.size() == clumps.of_body.size(), "lists of clumps have different lengths");
  std::size_t of_clumps = 0;
  for (std::size_t c = 0; c < clumps.clump.size(); ++c) {
    const Clump& clump = clumps.clump[c];
    expect_restored(clump.first < clump.last && clump.last <= clumps.spheres.size(), "a clump has no spheres");
    for (std::uint32_t k = clump.first; k < clump.last; ++k)
      expect_restored(clumps.spheres[k] < bodies && clumps.of_body[clumps.spheres[k]].clump == c,
                      "a clump has a sphere that is not there, or is of another clump");
    of_clumps += clump.last - clump.first;
    expect_restored(clump.id < ids_given, "a clump has a number that was not given");
    expect_restored(clump.centre.allFinite() && clump.velocity.allFinite() && clump.momentum.allFinite() &&
                        clump.spin.allFinite() && clump.axes.allFinite() && clump.inertia.allFinite() &&
                        std::isfinite(clump.inverse_mass) && std::isfinite(clump.furthest) && clump.radius > 0,
                    "the place or the motion of a clump is not a number");
  }
  expect_restored(of_clumps == clumps.spheres.size(), "spheres are of no clump, or of several");
  const auto in_clump = [](const ClumpSphere& own) { return own.clump != no_clump; };
  expect_restored(static_cast<std::size_t>(std::ranges::count_if(clumps.of_body, in_clump)) == of_clumps,
                  "a body is of a clump that is not there");
}

}  // namespace

void check_restored(const Bodies& bodies, std::size_t materials, std::span<const std::string> groups) {
  const std::size_t count = bodies.count();
  expect_restored(bodies.rotation.size() == (bodies.state.has(BodyState::rotation) ? count : 0) &&
                      bodies.origin.size() == (bodies.state.has(BodyState::displacement) ? count : 0),
                  "lists of bodies have different lengths");
  for (std::size_t i = 0; i < count; ++i) {
    expect_restored(
        finite(bodies.position[i]) && bodies.position[i].w > 0 && finite(bodies.velocity[i]) && finite(bodies.spin[i]),
        "the place, the size or the motion of a body is not a number");
    expect_restored(bodies.id[i] < bodies.ids_given, "a body has a number that was not given");
    expect_restored(bodies.material[i] < materials, "a body has a material that the description lacks");
  }
  expect_restored(std::ranges::is_sorted(bodies.groups, {}, &BodyGroup::first_id), "groups of bodies do not ascend");
  for (const BodyGroup& group : bodies.groups)
    expect_restored(std::ranges::find(groups, group.name) != groups.end(),
                    "bodies are of a group that the description lacks");
  check_restored(bodies.clumps, count, bodies.clump_ids_given);
}

void Bodies::reserve(std::size_t more) {
  const std::size_t all = count() + more + 1;
  position.reserve(all), velocity.reserve(all), spin.reserve(all), material.reserve(all), id.reserve(all);
}

void Bodies::add(const Vec3& centre, double radius, double mass, double inertia, std::uint8_t body_material,
                 const Vec3& v, const Vec3& w) {
  position.push_back({centre.x(), centre.y(), centre.z(), radius});
  velocity.push_back({v.x(), v.y(), v.z(), 1 / mass});
  spin.push_back({w.x(), w.y(), w.z(), 1 / inertia});
  material.push_back(body_material);
  id.push_back(ids_given++);
}

void Bodies::add_clump(const ClumpShape& shape, const Vec3& centre, double radius, double mass, const Vec3& inertia,
                       const Eigen::Quaterniond& orientation, std::uint8_t body_material, const Vec3& v,
                       const Vec3& w) {
  const auto index = static_cast<std::uint32_t>(clumps.clump.size());
  Clump clump;
  clump.id = clump_ids_given++;
  clump.first = static_cast<std::uint32_t>(clumps.spheres.size());
  clump.centre = centre, clump.velocity = v, clump.spin = w;
  clump.orientation = orientation, clump.axes = orientation.toRotationMatrix();
  clump.inertia = inertia;
  clump.momentum = clump.axes * clump.inertia.cwiseProduct(clump.axes.transpose() * w);
  clump.inverse_mass = 1 / mass, clump.radius = radius, clump.volume = shape.volume * radius * radius * radius;
  clumps.of_body.resize(count()), clumps.volume_fraction.resize(count(), 1.0);
  for (std::size_t k = 0; k < shape.spheres.size(); ++k) {
    const Vec3 place = radius * xyz(shape.spheres[k]), arm = clump.axes * place;
    const double sphere_radius = radius * shape.spheres[k].w;
    clump.furthest = std::max(clump.furthest, place.norm() + sphere_radius);
    clumps.spheres.push_back(static_cast<std::uint32_t>(count()));
    add(centre + arm, sphere_radius, mass, clump.inertia.minCoeff(), body_material, v + w.cross(arm), w);
    clumps.of_body.push_back({.clump = index, .periods = {}, .place = place});
    clumps.volume_fraction.push_back(shape.volume_fractions[k]);
  }
  clump.last = static_cast<std::uint32_t>(clumps.spheres.size());
  clumps.clump.push_back(clump);
}

void Bodies::finish(StateRequest asked_for) {
  if (count() > most_bodies)
    throw Error(std::to_string(count()) + " bodies; allowed are up to " + std::to_string(most_bodies));
  pad();
  if (!clumps.none()) clumps.of_body.resize(count()), clumps.volume_fraction.resize(count(), 1.0);
  request(asked_for);
}

void Bodies::pad() {
  constexpr double far_away = 1e18;  // its square is finite in single precision too
  position.push_back({far_away, far_away, far_away, 0});
  velocity.push_back({});
  spin.push_back({});
  material.push_back(0);
}

void Bodies::request(StateRequest asked_for) {
  state = asked_for;
  rotation.resize(state.has(BodyState::rotation) ? count() : 0);
  origin.resize(state.has(BodyState::displacement) ? count() : 0);
  start_paths();
}

void Bodies::start_paths() {
  for (std::size_t i = 0; i < origin.size(); ++i) origin[i] = xyz(position[i]);
  std::ranges::fill(rotation, Vec3::Zero());
}

std::string Bodies::group_of(std::uint32_t body) const {
  const auto next = std::ranges::upper_bound(groups, body, {}, &BodyGroup::first_id);
  return next == groups.begin() ? "" : std::prev(next)->name;
}

void Bodies::append(const Bodies& others) {
  if (std::size_t{ids_given} + others.ids_given > most_bodies)
    throw Error(std::to_string(std::size_t{ids_given} + others.ids_given) +
                " bodies in all, with those that left; allowed are up to " + std::to_string(most_bodies));
  const auto before = static_cast<std::uint32_t>(count()),
             clumps_before = static_cast<std::uint32_t>(clumps.clump.size()),
             spheres_before = static_cast<std::uint32_t>(clumps.spheres.size());
  const auto go_on = [](auto& array, const auto& more) { array.insert(array.end(), more.begin(), more.end()); };
  // The other bodies replace the padding and bring their own.
  position.pop_back(), velocity.pop_back(), spin.pop_back(), material.pop_back();
  go_on(position, others.position), go_on(velocity, others.velocity), go_on(spin, others.spin);
  go_on(material, others.material), go_on(rotation, others.rotation), go_on(origin, others.origin);
  for (const std::uint32_t other : others.id) id.push_back(ids_given + other);
  for (const BodyGroup& group : others.groups)
    if (groups.empty() || groups.back().name != group.name) groups.push_back({group.name, ids_given + group.first_id});
  if (!clumps.none() || !others.clumps.none()) {
    clumps.of_body.resize(before), clumps.volume_fraction.resize(before, 1.0);
    go_on(clumps.of_body, others.clumps.of_body), go_on(clumps.volume_fraction, others.clumps.volume_fraction);
    clumps.of_body.resize(count()), clumps.volume_fraction.resize(count(), 1.0);
    for (std::size_t i = before; i < count(); ++i)
      if (std::uint32_t& clump = clumps.of_body[i].clump; clump != no_clump) clump += clumps_before;
    for (const std::uint32_t sphere : others.clumps.spheres) clumps.spheres.push_back(before + sphere);
    for (Clump clump : others.clumps.clump) {
      clump.id += clump_ids_given, clump.first += spheres_before, clump.last += spheres_before;
      clumps.clump.push_back(clump);
    }
  }
  ids_given += others.ids_given, clump_ids_given += others.clump_ids_given;
}

void Bodies::serialize(SharedArchive& archive) {
  bool turns = !rotation.empty(), has_origins = !origin.empty();
  const std::size_t bodies = archive.length(count(), 3 * sizeof(Row) + sizeof(id[0]) + sizeof(material[0]));
  archive(turns, has_origins);
  if (archive.restoring()) {
    id.resize(bodies);
    rotation.assign(turns ? bodies : 0, Vec3::Zero()), origin.assign(has_origins ? bodies : 0, Vec3::Zero());
    position.resize(bodies), velocity.resize(bodies), spin.resize(bodies), material.resize(bodies);
  }
  archive.each_body(bodies, position, velocity, spin, id, material, rotation, origin);
  archive(clumps, groups, ids_given, clump_ids_given);
  if (archive.restoring()) pad();
}

void Bodies::reorder(std::span<const std::uint32_t> order, Team& team) {
  const std::size_t before = count();
  const auto each = [&](auto&... arrays) { (permute(arrays, order, before, team), ...); };
  each(position, velocity, spin, id, material, rotation, origin);
  if (clumps.none()) return;
  each(clumps.of_body, clumps.volume_fraction);
  const Renumbering now(order, before);
  std::vector<Clump> kept;
  std::vector<std::uint32_t> spheres;
  // Clumps have the order of their first spheres, so that those of neighbouring bodies are close in memory.
  const auto place = [&](const Clump& clump) { return now(clumps.spheres[clump.first]); };
  std::ranges::sort(clumps.clump, {}, place);
  for (Clump clump : clumps.clump) {
    if (place(clump) == body_gone) break;
    const auto first = static_cast<std::uint32_t>(spheres.size());
    for (std::uint32_t k = clump.first; k < clump.last; ++k) {
      spheres.push_back(now(clumps.spheres[k]));
      clumps.of_body[spheres.back()].clump = static_cast<std::uint32_t>(kept.size());
    }
    clump.first = first, clump.last = static_cast<std::uint32_t>(spheres.size());
    kept.push_back(clump);
  }
  clumps.clump.swap(kept), clumps.spheres.swap(spheres);
  if (clumps.none()) clumps = {};
}

}  // namespace grit
