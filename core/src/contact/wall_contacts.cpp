#include "contact/wall_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "grit/contact/fields.hpp"

namespace grit {
namespace {

auto key(const auto& t) { return std::tuple(t.wall, t.body, t.feature); }

/// A gap between walls that is narrower, in radii, is closed.
constexpr double no_gap = 1e-8;
/// By which the normal of an edge in such a gap may be tilted.
constexpr double tilted_by_rounding = 4 * no_gap;
/// Cosine between normals of one surface that goes on in another wall or face.
constexpr double goes_on = 0.9;

/// A law takes the change of the normal for a turn of what is touched, with which a sphere turns that pivots about an
/// edge or is carried along: (overlap / dt) (normal − normal_before) of surface velocity. A touch that goes on in one
/// whose normal leans towards where the body goes is over a valley, where two normals meet neither of which turns but
/// with the wall. What the law adds for their difference is taken off beforehand: it would be felt as a jerk.
void stand_still_in_valley(WallTouch& touch, const Row& body, const Row& body_velocity, double dt) {
  // Both as somebody sees them who rides on the wall at the body's centre.
  const Vec3 turned = touch.normal - touch.normal_before - dt * touch.spin.cross(touch.normal);
  const Vec3 passes = xyz(body_velocity) - touch.velocity + touch.spin.cross((body.w - touch.overlap) * touch.normal);
  if (dt > 0 && turned.dot(passes) > 0) touch.velocity -= touch.overlap / dt * turned;
}

static_assert(offsetof(Sphere, radius) == offsetof(Row, w));

PairSize at_wall(const Bodies& bodies, std::uint32_t body, double overlap) {
  const double radius = bodies.position[body].w;
  return {.radius_a = radius,
          .radius_b = radius,
          .inverse_mass_a = bodies.velocity[body].w,
          .inverse_mass_b = 0,
          .overlap = overlap,
          .wall = true};
}

/// Which of two touches that are as deep is the deeper is rounding: beside the joint of two faces it may be the edge,
/// whose normal, however little tilted, would push the sphere further aside. Takes the face's.
void straighten(WallTouch& touch, std::span<const WallSurface> walls) {
  const WallSurface& wall = walls[touch.wall];
  if (!wall.geometry->flat()) return;
  const Vec3 normal = wall.pose.turn * wall.geometry->normal();
  const Vec3 into = std::copysign(1.0, touch.normal.dot(normal)) * normal;
  if ((touch.normal - into).norm() <= tilted_by_rounding) touch.normal = into;
}

}  // namespace

void WallContacts::rebuild(const Bodies& bodies, std::span<const WallSurface> walls, const Skins& skins,
                           std::span<const StateField> fields, std::span<const std::uint32_t> order) {
  set_fields(fields);
  const std::size_t count = bodies.count(), field_count = fields_.size();
  // Memories follow their bodies into other chunks.
  if (!order.empty()) {
    constexpr std::uint32_t gone = ~0u;
    std::vector<std::uint32_t> now(std::max(count, chunks_.size() * chunk_bodies), gone);
    for (std::size_t i = 0; i < count; ++i) now[order[i]] = static_cast<std::uint32_t>(i);
    std::vector<WallTouch> touch;
    std::vector<double> state;
    for (Chunk& chunk : chunks_) {
      touch.insert(touch.end(), chunk.touch.begin(), chunk.touch.end());
      state.insert(state.end(), chunk.state.begin(), chunk.state.end());
      chunk.touch.clear(), chunk.state.clear(), chunk.row.clear();
    }
    for (WallTouch& t : touch) t.body = now[t.body];
    chunks_.resize(chunks_of(count));
    std::vector<std::size_t> place(touch.size());
    std::iota(place.begin(), place.end(), std::size_t{0});
    std::erase_if(place, [&](std::size_t p) { return touch[p].body == gone; });
    std::sort(place.begin(), place.end(), [&](std::size_t p, std::size_t q) { return key(touch[p]) < key(touch[q]); });
    for (const std::size_t p : place) {
      Chunk& chunk = chunks_[touch[p].body / chunk_bodies];
      chunk.touch.push_back(touch[p]);
      chunk.state.insert(chunk.state.end(), state.begin() + static_cast<std::ptrdiff_t>(p * field_count),
                         state.begin() + static_cast<std::ptrdiff_t>((p + 1) * field_count));
      chunk.row.emplace_back();
    }
  }

  chunks_.resize(chunks_of(count));
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    Chunk& chunk = chunks_[c];
    chunk.candidate.clear();
    chunk.candidate_start.assign(1, 0);
    const std::size_t first = c * chunk_bodies, last = std::min(count, first + chunk_bodies);
    const double skin = skins.of_chunk(c) + skins.of_walls();
    // A sphere around all spheres of the chunk: most walls are far from most chunks.
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
    for (std::size_t i = first; i < last; ++i)
      low = low.cwiseMin(xyz(bodies.position[i])), high = high.cwiseMax(xyz(bodies.position[i]));
    const Vec3 middle = 0.5 * (low + high);
    double around = 0;
    for (std::size_t i = first; i < last; ++i)
      around = std::max(around, (xyz(bodies.position[i]) - middle).norm() + bodies.position[i].w + skin);
    around *= 1 + 1e-12;
    for (const WallSurface& wall : walls) {
      const bool close = !middle.allFinite() || wall.geometry->near(wall.pose, middle, around);
      for (std::size_t i = first; close && i < last; ++i)
        if (wall.geometry->near(wall.pose, xyz(bodies.position[i]), bodies.position[i].w + skin))
          chunk.candidate.push_back(static_cast<std::uint32_t>(i));
      chunk.candidate_start.push_back(static_cast<std::uint32_t>(chunk.candidate.size()));
    }
  }
}

void WallContacts::set_fields(std::span<const StateField> fields) {
  const std::size_t before = fields_.size(), after = fields.size();
  const std::vector<FieldMove> moves = moves_of_fields(fields_, fields);
  const bool same = same_fields(fields_, fields);
  fields_.assign(fields.begin(), fields.end());
  if (same) return;
  for (Chunk& chunk : chunks_) {
    std::vector<double> state(chunk.touch.size() * after);
    for (std::size_t i = 0; i < chunk.touch.size(); ++i)
      for (const auto& [from, to] : moves) state[i * after + to] = chunk.state[i * before + from];
    chunk.state.swap(state);
  }
}

double WallContacts::evaluate(std::size_t c, const ContactLaw& law, const Bodies& bodies, bool one_material,
                              std::span<const WallSurface> walls, double dt, BodySum* sum, Losses* losses) {
  static thread_local Workspace work;
  Chunk& chunk = chunks_[c];
  chunk.load.assign(walls.size(), {});
  if (chunk.candidate.empty()) {
    chunk.touch.clear(), chunk.state.clear(), chunk.row.clear();
    return 0;
  }
  work.before.clear();
  for (const WallTouch& t : chunk.touch)
    work.before.push_back({t.normal, t.body, t.wall, t.feature, t.material, t.overlap});
  chunk.touch.clear();
  for (std::uint32_t w = 0; w < walls.size(); ++w) {
    const WallSurface& wall = walls[w];
    work.spheres.clear(), work.found.clear();
    for (std::uint32_t n = chunk.candidate_start[w]; n < chunk.candidate_start[w + 1]; ++n) {
      Sphere& sphere = work.spheres.emplace_back();
      // At once: a vector that is read before its components have arrived in the cache is waited for.
      std::memcpy(sphere.centre.data(), &bodies.position[chunk.candidate[n]], sizeof(Row));
      sphere.body = chunk.candidate[n];
    }
    if (work.spheres.empty()) continue;
    wall.geometry->touch(wall.pose, work.spheres, work.found);
    const bool turns = !wall.spin.isZero(0);
    for (const Touch& t : work.found) {
      WallTouch& touch = chunk.touch.emplace_back();
      touch.normal = touch.normal_before = t.normal;
      touch.velocity = wall.velocity, touch.spin = wall.spin;
      touch.overlap = t.overlap, touch.body = t.body;
      touch.wall = w, touch.feature = t.feature, touch.material = wall.material;
      if (!turns) continue;
      const Row& x = bodies.position[t.body];
      touch.velocity = wall.point_velocity(xyz(x) + (x.w - t.overlap) * t.normal);
    }
  }

  leave_out_hidden(chunk, work, bodies, walls);
  hand_on_memories(chunk, work, bodies, dt);
  if (losses != nullptr) part(work, law, bodies, *losses);
  chunk.row.resize(chunk.touch.size());
  WallBatch batch{.position = bodies.position.data(),
                  .velocity = bodies.velocity.data(),
                  .spin = bodies.spin.data(),
                  .material = one_material ? nullptr : bodies.material.data(),
                  .count = chunk.touch.size(),
                  .touch = chunk.touch.data(),
                  .dt = dt,
                  .state = chunk.state.data(),
                  .row = chunk.row.data(),
                  .sum = sum,
                  .largest_overlap = 0,
                  .losses = losses};
  law.evaluate_walls(batch);

  for (std::size_t i = 0; i < chunk.touch.size(); ++i) {
    const WallTouch& t = chunk.touch[i];
    const Row& x = bodies.position[t.body];
    const Vec3 reference = walls[t.wall].reference();
    const double out = x.w - t.overlap;  // from the centre to the point, from there to the reference point
    const double px = x.x + out * t.normal.x() - reference.x(), py = x.y + out * t.normal.y() - reference.y(),
                 pz = x.z + out * t.normal.z() - reference.z();
    const Row force = chunk.row[i].force, moment = chunk.row[i].moment;
    WallLoad& load = chunk.load[t.wall];
    load.force += Vec3(force.x, force.y, force.z);
    load.moment += Vec3(py * force.z - pz * force.y + moment.x, pz * force.x - px * force.z + moment.y,
                        px * force.y - py * force.x + moment.z);
    ++load.touches;
    if (!walls[t.wall].gives_way) continue;
    const PairSize size = at_wall(bodies, t.body, t.overlap);
    const Stiffness k = law.stiffness(size, bodies.material[t.body], t.material);
    load.stiffness += k.normal;
    load.spring += std::max(k.normal, k.shear);
    load.dashpot += 2 * std::max(k.damping_ratio * std::sqrt(k.normal / size.inverse_mass_a),
                                 k.shear_damping_ratio * std::sqrt(k.shear / (3.5 * size.inverse_mass_a)));
  }
  return batch.largest_overlap;
}

void WallContacts::leave_out_hidden(Chunk& chunk, Workspace& work, const Bodies& bodies,
                                    std::span<const WallSurface> walls) {
  if (chunk.touch.size() < 2) return;
  constexpr std::uint32_t none = ~0u;
  std::array<std::uint32_t, chunk_bodies> latest;  // touch of each body
  latest.fill(none);
  auto& before = work.same_body_before;
  auto& hide = work.hide;
  before.assign(chunk.touch.size(), none), hide.assign(chunk.touch.size(), false);
  bool any = false;
  for (std::uint32_t i = 0; i < chunk.touch.size(); ++i) {
    const WallTouch& t = chunk.touch[i];
    before[i] = std::exchange(latest[t.body % chunk_bodies], i);
    const Row& body = bodies.position[t.body];
    for (std::uint32_t j = before[i]; j != none; j = before[j]) {
      // A wall tells each of its own places once. What is hidden itself hides what is behind it.
      if (chunk.touch[j].wall == t.wall) continue;
      const bool later_is_lesser = t.overlap <= chunk.touch[j].overlap;
      const std::uint32_t lesser = later_is_lesser ? i : j, deeper = later_is_lesser ? j : i;
      const auto hides = [&](std::uint32_t one, std::uint32_t other) {
        return !hide[other] && hidden(chunk.touch[other], chunk.touch[one], body, walls, work);
      };
      const double deeper_by = chunk.touch[deeper].overlap - chunk.touch[lesser].overlap;
      const bool alike = deeper_by <= no_gap * body.w;
      if (hides(deeper, lesser)) {
        any = hide[lesser] = true;
        if (alike) straighten(chunk.touch[deeper], walls);
      } else if (alike && !hide[lesser] && hides(lesser, deeper)) {
        any = hide[deeper] = true;
        straighten(chunk.touch[lesser], walls);
      }
    }
  }
  if (!any) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chunk.touch.size(); ++i)
    if (!hide[i]) chunk.touch[kept++] = chunk.touch[i];
  chunk.touch.resize(kept);
}

bool WallContacts::hidden(const WallTouch& lesser, const WallTouch& deeper, const Row& body,
                          std::span<const WallSurface> walls, Workspace& work) {
  const Vec3 place = xyz(body) + (body.w - lesser.overlap) * lesser.normal;
  const double close = no_gap * body.w;
  const Sphere probe{place - close * deeper.normal, 2 * close, deeper.body};
  const WallSurface& wall = walls[deeper.wall];
  work.found.clear();
  wall.geometry->touch(wall.pose, {&probe, 1}, work.found);
  return !work.found.empty();
}

void WallContacts::hand_on_memories(Chunk& chunk, Workspace& work, const Bodies& bodies, double dt) const {
  // What was touched is touched still, but for few steps.
  const auto same = [](const WallTouch& now, const Before& before) { return key(now) == key(before); };
  work.gone.clear();
  if (std::ranges::equal(chunk.touch, work.before, same)) {
    for (std::size_t i = 0; i < chunk.touch.size(); ++i) chunk.touch[i].normal_before = work.before[i].normal;
    return;
  }
  const std::size_t fields = fields_.size();
  work.state_before.swap(chunk.state);
  chunk.state.assign(chunk.touch.size() * fields, 0.0);
  const auto hand_on = [&](std::size_t from, std::size_t to) {
    chunk.touch[to].normal_before = work.before[from].normal;
    for (std::size_t f = 0; f < fields; ++f) chunk.state[to * fields + f] = work.state_before[from * fields + f];
  };
  auto &fresh = work.fresh, &gone = work.gone;
  fresh.clear();
  std::uint32_t old = 0;
  for (std::uint32_t i = 0; i < chunk.touch.size(); ++i) {
    const auto own = key(chunk.touch[i]);
    for (; old < work.before.size() && key(work.before[old]) < own; ++old) gone.push_back(old);
    if (old < work.before.size() && key(work.before[old]) == own) hand_on(old++, i);
    else fresh.push_back(i);
  }
  for (; old < work.before.size(); ++old) gone.push_back(old);
  // What goes on in another wall's surface remembers what it did on the one that it left.
  for (const std::uint32_t i : fresh) {
    const WallTouch& t = chunk.touch[i];
    auto best = gone.end();
    double nearest = goes_on;
    for (auto g = gone.begin(); g != gone.end(); ++g) {
      const Before& left = work.before[*g];
      const double cosine = left.normal.dot(t.normal);
      if (left.body == t.body && left.material == t.material && cosine > nearest) best = g, nearest = cosine;
    }
    if (best == gone.end()) continue;
    hand_on(*best, i);
    stand_still_in_valley(chunk.touch[i], bodies.position[t.body], bodies.velocity[t.body], dt);
    gone.erase(best);
  }
}

void WallContacts::part(const Workspace& work, const ContactLaw& law, const Bodies& bodies, Losses& losses) const {
  const std::size_t fields = fields_.size();
  for (const std::uint32_t g : work.gone) {
    const Before& left = work.before[g];
    const ElasticEnergy held = law.energy(at_wall(bodies, left.body, left.overlap), bodies.material[left.body],
                                          left.material, std::span(work.state_before).subspan(g * fields, fields));
    losses.friction += held.shear, losses.rolling += held.rolling;
  }
}

void WallContacts::grow(const Bodies& bodies, double factor) {
  const double share = 1 - 1 / factor;
  for (Chunk& chunk : chunks_)
    for (WallTouch& touch : chunk.touch) {
      touch.overlap += share * bodies.position[touch.body].w;
      // The middle of a clump's sphere comes closer as well.
      if (const std::uint32_t c = bodies.clumps.clump_of(touch.body); c != no_clump)
        touch.overlap +=
            share * touch.normal.dot(bodies.clumps.clump[c].axes * bodies.clumps.of_body[touch.body].place);
    }
}

void WallContacts::loads(std::span<WallLoad> loads) const {
  std::fill(loads.begin(), loads.end(), WallLoad{});
  for (const Chunk& chunk : chunks_)
    for (std::size_t w = 0; w < chunk.load.size(); ++w) {
      loads[w].force += chunk.load[w].force, loads[w].moment += chunk.load[w].moment;
      loads[w].stiffness += chunk.load[w].stiffness, loads[w].touches += chunk.load[w].touches;
      loads[w].spring += chunk.load[w].spring, loads[w].dashpot += chunk.load[w].dashpot;
      loads[w].near += chunk.candidate_start[w + 1] - chunk.candidate_start[w];
    }
}

double WallContacts::force_ahead(std::size_t wall, const WallSurface& surface, const Pose& there, const Vec3& velocity,
                                 const ContactLaw& law, const Bodies& bodies, bool all) const {
  std::vector<Sphere> spheres;
  std::vector<Touch> found;
  const auto look_at = [&](std::uint32_t body) {
    const Row& x = bodies.position[body];
    spheres.push_back({xyz(x), x.w, body});
  };
  if (all)
    for (std::uint32_t body = 0; body < bodies.count(); ++body) look_at(body);
  else
    for (const Chunk& chunk : chunks_)
      for (std::uint32_t n = chunk.candidate_start[wall]; n < chunk.candidate_start[wall + 1]; ++n)
        look_at(chunk.candidate[n]);
  if (!spheres.empty()) surface.geometry->touch(there, spheres, found);
  double sum = 0;
  for (const Touch& touch : found) {
    const PairSize size = at_wall(bodies, touch.body, touch.overlap);
    const Stiffness k = law.stiffness(size, bodies.material[touch.body], surface.material);
    const double dashpot = 2 * k.damping_ratio * std::sqrt(k.normal / size.inverse_mass_a),
                 closing = touch.normal.dot(xyz(bodies.velocity[touch.body]) - velocity);
    sum += std::max(0.0, k.normal * touch.overlap + dashpot * closing);
  }
  return sum;
}

std::size_t WallContacts::touching_count() const {
  std::size_t count = 0;
  for (const Chunk& chunk : chunks_) count += chunk.touch.size();
  return count;
}

}  // namespace grit
