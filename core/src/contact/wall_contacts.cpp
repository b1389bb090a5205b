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

#include "bodies/restored.hpp"
#include "grit/contact/fields.hpp"

namespace grit {
namespace {

auto key(const auto& t) { return std::tuple(t.wall, t.body, t.feature); }

/// Gaps between walls below this width over the radius count as closed.
constexpr double no_gap = 1e-8;
/// Maximum tilt of the normal at an edge in such a gap [rad].
constexpr double tilted_by_rounding = 4 * no_gap;
/// Minimum cosine between normals of a surface that continues on another wall or face.
constexpr double goes_on = 0.9;

/// A law interprets a change of the normal as a rotation of the surface, as of a sphere that pivots about an edge or is
/// carried along, and adds the surface velocity (overlap / dt) (normal − normal_before). When a body moves across a
/// valley its contact continues on a face with another normal, although neither face rotates relative to the wall. This
/// subtracts the term in advance; it would act as an impulse.
void stand_still_in_valley(WallContact& contact, const Row& body, const Row& body_velocity, double dt) {
  // Both relative to the wall at the body's centre.
  const Vec3 turned = contact.normal - contact.normal_before - dt * contact.spin.cross(contact.normal);
  const Vec3 passes =
      xyz(body_velocity) - contact.velocity + contact.spin.cross((body.w - contact.overlap) * contact.normal);
  if (dt > 0 && turned.dot(passes) > 0) contact.velocity -= contact.overlap / dt * turned;
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

/// Of two contacts with equal overlaps, rounding decides which is deeper. Next to the joint of two faces it may be an
/// edge, whose normal, however little tilted, would push the sphere aside. This takes the face.
void straighten(WallContact& contact, std::span<const WallSurface> walls) {
  const WallSurface& wall = walls[contact.wall];
  if (!wall.geometry->flat()) return;
  const Vec3 normal = wall.pose.turn * wall.geometry->normal();
  const Vec3 into = std::copysign(1.0, contact.normal.dot(normal)) * normal;
  if ((contact.normal - into).norm() <= tilted_by_rounding) contact.normal = into;
}

}  // namespace

void WallContacts::rebuild(const Bodies& bodies, std::span<const std::uint16_t> group,
                           std::span<const WallSurface> walls, const Skins& skins, std::span<const StateField> fields,
                           const Renumbering& now, Ranks& ranks, Team& team) {
  set_fields(fields);
  if (now.changes()) place(taken(now, ranks), bodies.count());
  share(ranks);
  chunks_.resize(chunks_of(bodies.count()));
  for (Chunk& chunk : chunks_) chunk.candidate.clear(), chunk.candidate_start.assign(walls.size() + 1, 0);
  team.each(ranks.last() - ranks.first(),
            [&](std::size_t k) { find_candidates(ranks.first() + k, bodies, group, walls, skins); });
}

WallContacts::Contacts WallContacts::taken(const Renumbering& now, Ranks& ranks) {
  struct Sent {
    WallContact contact;
    std::uint8_t crossed;
  };
  const std::size_t fields = fields_.size();
  std::vector<std::vector<Sent>> to(ranks.count());
  std::vector<std::vector<double>> states(ranks.count());
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    Chunk chunk;
    std::swap(chunk, chunks_[c]);
    if (!whole_ && !cuts_.owns(ranks.rank(), c)) continue;
    for (std::size_t i = 0; i < chunk.contact.size(); ++i) {
      WallContact contact = chunk.contact[i];
      contact.body = now(contact.body);
      if (contact.body == body_gone) continue;
      const unsigned rank = whole_ ? ranks.rank() : ranks.cuts().owner_of_body(contact.body);
      to[rank].push_back({contact, chunk.crossed[i]});
      const auto first = chunk.state.begin() + static_cast<std::ptrdiff_t>(i * fields);
      states[rank].insert(states[rank].end(), first, first + static_cast<std::ptrdiff_t>(fields));
    }
  }
  if (!whole_) to = ranks.exchange(to), states = ranks.exchange(states);
  Contacts all;
  for (unsigned r = 0; r < ranks.count(); ++r) {
    for (const Sent& one : to[r]) all.contact.push_back(one.contact), all.crossed.push_back(one.crossed);
    all.state.insert(all.state.end(), states[r].begin(), states[r].end());
  }
  return all;
}

void WallContacts::place(const Contacts& all, std::size_t bodies) {
  const std::size_t fields = fields_.size();
  chunks_.resize(chunks_of(bodies));
  std::vector<std::size_t> order(all.contact.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t p) { return key(all.contact[p]); });
  for (const std::size_t p : order) {
    Chunk& chunk = chunks_[all.contact[p].body / chunk_bodies];
    chunk.contact.push_back(all.contact[p]);
    chunk.crossed.push_back(all.crossed[p]);
    const auto first = all.state.begin() + static_cast<std::ptrdiff_t>(p * fields);
    chunk.state.insert(chunk.state.end(), first, first + static_cast<std::ptrdiff_t>(fields));
    chunk.row.emplace_back();
  }
}

void WallContacts::complete(Ranks& ranks) {
  if (!ranks.several()) return;
  Archive own;
  // Bodies may have been appended since the last rebuild.
  for (std::size_t c = ranks.first(); c < std::min(ranks.last(), chunks_.size()); ++c) own(chunks_[c], chunks_[c].row);
  Archive all(ranks.all(own.bytes()));
  for (Chunk& chunk : chunks_) all(chunk, chunk.row);
}

void WallContacts::find_candidates(std::size_t c, const Bodies& bodies, std::span<const std::uint16_t> group,
                                   std::span<const WallSurface> walls, const Skins& skins) {
  Chunk& chunk = chunks_[c];
  chunk.candidate.clear();
  chunk.candidate_start.assign(1, 0);
  const std::size_t first = c * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  const double skin = skins.at_walls(c) + skins.of_walls() + skins.reach();
  // Sphere that encloses all bodies of the chunk: most walls are far from most chunks.
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  for (std::size_t i = first; i < last; ++i)
    low = low.cwiseMin(xyz(bodies.position[i])), high = high.cwiseMax(xyz(bodies.position[i]));
  const Vec3 middle = 0.5 * (low + high);
  double around = 0;
  for (std::size_t i = first; i < last; ++i)
    around = std::max(around, (xyz(bodies.position[i]) - middle).norm() + bodies.position[i].w + skin);
  around *= 1 + 1e-12;
  for (const WallSurface& wall : walls) {
    const bool repeated = !wall.period.isZero(0.0);  // then bodies of a chunk may be at both of its ends
    const bool close = repeated || !middle.allFinite() || wall.geometry->near(wall.pose, middle, around);
    for (std::size_t i = first; close && i < last; ++i)
      if (wall.acts_on(group, i) &&
          wall.geometry->near(wall.pose, wall.within(xyz(bodies.position[i])), bodies.position[i].w + skin))
        chunk.candidate.push_back(static_cast<std::uint32_t>(i));
    chunk.candidate_start.push_back(static_cast<std::uint32_t>(chunk.candidate.size()));
  }
}

void WallContacts::set_fields(std::span<const StateField> fields) {
  const std::size_t before = fields_.size(), after = fields.size();
  const std::vector<FieldMove> moves = moves_of_fields(fields_, fields);
  const bool same = same_fields(fields_, fields);
  fields_.assign(fields.begin(), fields.end());
  if (same) return;
  for (Chunk& chunk : chunks_) {
    std::vector<double> state(chunk.contact.size() * after);
    for (std::size_t i = 0; i < chunk.contact.size(); ++i)
      for (const auto& [from, to] : moves) state[i * after + to] = chunk.state[i * before + from];
    chunk.state.swap(state);
  }
}

void WallContacts::renumber_walls(std::span<const std::uint32_t> now) {
  const std::size_t fields = fields_.size();
  for (Chunk& chunk : chunks_) {
    Chunk before;
    before.contact.swap(chunk.contact), before.crossed.swap(chunk.crossed), before.state.swap(chunk.state);
    chunk.row.clear(), chunk.candidate.clear();
    for (WallContact& contact : before.contact) contact.wall = now[contact.wall];
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < before.contact.size(); ++i)
      if (before.contact[i].wall != no_wall) order.push_back(i);
    std::ranges::sort(order, {}, [&](std::size_t i) { return key(before.contact[i]); });
    for (const std::size_t i : order) {
      chunk.contact.push_back(before.contact[i]);
      chunk.crossed.push_back(before.crossed[i]);
      const auto first = before.state.begin() + static_cast<std::ptrdiff_t>(i * fields);
      chunk.state.insert(chunk.state.end(), first, first + static_cast<std::ptrdiff_t>(fields));
      chunk.row.emplace_back();
    }
  }
}

double WallContacts::evaluate(std::size_t c, const ContactLaw& law, const Bodies& bodies, bool one_material,
                              std::span<const WallSurface> walls, double dt, bool again, BodySum* sum, Losses* losses) {
  static thread_local Workspace work;
  Chunk& chunk = chunks_[c];
  chunk.load.resize(walls.size());
  if (chunk.candidate.empty()) {
    chunk.contact.clear(), chunk.crossed.clear(), chunk.state.clear(), chunk.row.clear();
    return 0;
  }
  // The buffers change places: copying contacts takes longer than finding them.
  work.before.swap(chunk.contact), work.crossed_before.swap(chunk.crossed);
  chunk.contact.clear();
  const bool at_a_distance = law.has_reach();
  for (std::uint32_t w = 0; w < walls.size(); ++w) {
    const WallSurface& wall = walls[w];
    const std::span<const std::uint32_t> candidates(chunk.candidate.data() + chunk.candidate_start[w],
                                                    chunk.candidate.data() + chunk.candidate_start[w + 1]);
    if (candidates.empty()) continue;
    chunk.load[w] = {};
    work.spheres.resize(candidates.size()), work.found.clear();
    for (std::size_t n = 0; n < candidates.size(); ++n) {
      // All components at once: reading a vector directly after writing its components one by one stalls.
      std::memcpy(work.spheres[n].centre.data(), &bodies.position[candidates[n]], sizeof(Row));
      work.spheres[n].body = candidates[n];
    }
    const auto reach = [&](std::uint32_t body) {
      return law.reach(at_wall(bodies, body, 0), bodies.material[body], wall.material);
    };
    if (at_a_distance)
      for (Sphere& sphere : work.spheres) sphere.radius += reach(sphere.body);
    if (!wall.period.isZero(0.0))
      for (Sphere& sphere : work.spheres) sphere.centre = wall.within(sphere.centre);
    wall.geometry->find_contacts(wall.pose, work.spheres, work.found);
    const bool turns = !wall.spin.isZero(0);
    for (const SurfaceContact& t : work.found) {
      WallContact& contact = chunk.contact.emplace_back();
      contact.normal = contact.normal_before = t.normal;
      contact.velocity = wall.velocity, contact.spin = wall.spin;
      contact.overlap = at_a_distance ? t.overlap - reach(t.body) : t.overlap, contact.body = t.body;
      contact.wall = w, contact.feature = t.feature, contact.material = wall.material;
      if (!turns) continue;
      const Row& x = bodies.position[t.body];
      contact.velocity = wall.point_velocity(xyz(x) + (x.w - contact.overlap) * t.normal);
    }
  }

  leave_out_hidden(chunk, work, bodies, walls);
  carry_histories(chunk, work, bodies, dt, again);
  if (std::ranges::any_of(walls, &WallSurface::surface_moves)) carry_along(chunk, bodies, walls);
  if (losses != nullptr) part(work, law, bodies, *losses);
  chunk.row.resize(chunk.contact.size());
  WallBatch batch{.position = bodies.position.data(),
                  .velocity = bodies.velocity.data(),
                  .spin = bodies.spin.data(),
                  .material = one_material ? nullptr : bodies.material.data(),
                  .count = chunk.contact.size(),
                  .contact = chunk.contact.data(),
                  .dt = dt,
                  .again = again,
                  .state = chunk.state.data(),
                  .row = chunk.row.data(),
                  .sum = sum,
                  .largest_overlap = 0,
                  .losses = losses};
  law.evaluate_walls(batch);

  for (std::size_t i = 0; i < chunk.contact.size(); ++i) {
    const WallContact& t = chunk.contact[i];
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
    load.contacts += acts(t, chunk.row[i]);
    if (walls[t.wall].surface_moves) {
      const Vec3 shear = xyz(force) - force.w * t.normal;
      load.surface_force += shear;
      load.surface_moment += Vec3(px, py, pz).cross(shear) + xyz(moment);
    }
    if (!walls[t.wall].gives_way) continue;
    const PairSize size = at_wall(bodies, t.body, std::max(t.overlap, 0.0));
    const Stiffness k = law.stiffness(size, bodies.material[t.body], t.material);
    load.stiffness += k.normal;
    const double spring = std::max(k.normal, k.shear),
                 dashpot = 2 * std::max(k.damping_ratio * std::sqrt(k.normal / size.inverse_mass_a),
                                        k.shear_damping_ratio * std::sqrt(k.shear / (3.5 * size.inverse_mass_a)));
    load.spring += spring, load.dashpot += dashpot;
    const Vec3& axis = walls[t.wall].free_axis;
    if (axis.isZero(0.0)) continue;
    // Shear acts one overlap behind the surface of the wall.
    const double arm = axis.cross(Vec3(px, py, pz)).norm() + std::max(t.overlap, 0.0);
    load.turning_spring += arm * arm * spring + std::max(k.rolling, k.twisting);
    load.turning_dashpot += arm * arm * dashpot;
  }
  return batch.largest_overlap;
}

void WallContacts::leave_out_hidden(Chunk& chunk, Workspace& work, const Bodies& bodies,
                                    std::span<const WallSurface> walls) {
  if (chunk.contact.size() < 2) return;
  constexpr std::uint32_t none = ~0u;
  std::array<std::uint32_t, chunk_bodies> latest;  // contact of each body
  latest.fill(none);
  auto& before = work.same_body_before;
  auto& hide = work.hide;
  before.assign(chunk.contact.size(), none), hide.assign(chunk.contact.size(), false);
  bool any = false;
  for (std::uint32_t i = 0; i < chunk.contact.size(); ++i) {
    const WallContact& t = chunk.contact[i];
    before[i] = std::exchange(latest[t.body % chunk_bodies], i);
    const Row& body = bodies.position[t.body];
    for (std::uint32_t j = before[i]; j != none; j = before[j]) {
      // A wall returns each of its own contact points once. A hidden contact also hides those behind it.
      if (chunk.contact[j].wall == t.wall) continue;
      const bool later_is_lesser = t.overlap <= chunk.contact[j].overlap;
      const std::uint32_t lesser = later_is_lesser ? i : j, deeper = later_is_lesser ? j : i;
      const auto hides = [&](std::uint32_t one, std::uint32_t other) {
        return !hide[other] && hidden(chunk.contact[other], chunk.contact[one], body, walls, work);
      };
      const double deeper_by = chunk.contact[deeper].overlap - chunk.contact[lesser].overlap;
      const bool alike = deeper_by <= no_gap * body.w;
      if (hides(deeper, lesser)) {
        any = hide[lesser] = true;
        if (alike) straighten(chunk.contact[deeper], walls);
      } else if (alike && !hide[lesser] && hides(lesser, deeper)) {
        any = hide[deeper] = true;
        straighten(chunk.contact[lesser], walls);
      }
    }
  }
  if (!any) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chunk.contact.size(); ++i)
    if (!hide[i]) chunk.contact[kept++] = chunk.contact[i];
  chunk.contact.resize(kept);
}

bool WallContacts::hidden(const WallContact& lesser, const WallContact& deeper, const Row& body,
                          std::span<const WallSurface> walls, Workspace& work) {
  const Vec3 place = xyz(body) + (body.w - lesser.overlap) * lesser.normal;
  const double close = no_gap * body.w;
  const WallSurface& wall = walls[deeper.wall];
  const Sphere probe{wall.within(place - close * deeper.normal), 2 * close, deeper.body};
  work.found.clear();
  wall.geometry->find_contacts(wall.pose, {&probe, 1}, work.found);
  return !work.found.empty();
}

void WallContacts::carry_along(Chunk& chunk, const Bodies& bodies, std::span<const WallSurface> walls) {
  for (WallContact& t : chunk.contact) {
    const WallSurface& wall = walls[t.wall];
    if (!wall.surface_moves) continue;
    const Row& x = bodies.position[t.body];
    const Vec3 point = xyz(x) + (x.w - t.overlap) * t.normal;
    const Vec3 moves = wall.surface_velocity + wall.surface_spin.cross(point - wall.reference());
    t.velocity += moves - moves.dot(t.normal) * t.normal;
    t.spin += wall.surface_spin;
  }
}

void WallContacts::carry_histories(Chunk& chunk, Workspace& work, const Bodies& bodies, double dt, bool again) const {
  // In nearly all steps contacts persist.
  const auto same = [](const WallContact& now, const WallContact& before) { return key(now) == key(before); };
  chunk.crossed.assign(chunk.contact.size(), 0);
  const auto cross = [&](std::uint32_t i) {
    const WallContact& t = chunk.contact[i];
    stand_still_in_valley(chunk.contact[i], bodies.position[t.body], bodies.velocity[t.body], dt);
    chunk.crossed[i] = 1;
  };
  const auto continue_from = [&](std::uint32_t from, std::uint32_t to) {
    const WallContact& before = work.before[from];
    chunk.contact[to].normal_before = again ? before.normal_before : before.normal;
    if (again && work.crossed_before[from] != 0) cross(to);
  };
  work.gone.clear();
  if (std::ranges::equal(chunk.contact, work.before, same)) {
    for (std::uint32_t i = 0; i < chunk.contact.size(); ++i) continue_from(i, i);
    return;
  }
  const std::size_t fields = fields_.size();
  work.state_before.swap(chunk.state);
  chunk.state.assign(chunk.contact.size() * fields, 0.0);
  const auto hand_on = [&](std::uint32_t from, std::uint32_t to) {
    for (std::size_t f = 0; f < fields; ++f) chunk.state[to * fields + f] = work.state_before[from * fields + f];
  };
  auto &fresh = work.fresh, &gone = work.gone;
  fresh.clear();
  std::uint32_t old = 0;
  for (std::uint32_t i = 0; i < chunk.contact.size(); ++i) {
    const auto own = key(chunk.contact[i]);
    for (; old < work.before.size() && key(work.before[old]) < own; ++old) gone.push_back(old);
    if (old < work.before.size() && key(work.before[old]) == own) {
      hand_on(old, i);
      continue_from(old++, i);
    } else {
      fresh.push_back(i);
    }
  }
  for (; old < work.before.size(); ++old) gone.push_back(old);
  // A contact that continues on another wall's surface keeps its history.
  for (const std::uint32_t i : fresh) {
    const WallContact& t = chunk.contact[i];
    auto best = gone.end();
    double nearest = goes_on;
    for (auto g = gone.begin(); g != gone.end(); ++g) {
      const WallContact& left = work.before[*g];
      const double cosine = left.normal.dot(t.normal);
      if (left.body == t.body && left.material == t.material && cosine > nearest) best = g, nearest = cosine;
    }
    if (best == gone.end()) continue;
    hand_on(*best, i);
    chunk.contact[i].normal_before = work.before[*best].normal;
    cross(i);
    gone.erase(best);
  }
}

void WallContacts::part(const Workspace& work, const ContactLaw& law, const Bodies& bodies, Losses& losses) const {
  const std::size_t fields = fields_.size();
  for (const std::uint32_t g : work.gone) {
    const WallContact& left = work.before[g];
    const ElasticEnergy held = law.energy(at_wall(bodies, left.body, left.overlap), bodies.material[left.body],
                                          left.material, std::span(work.state_before).subspan(g * fields, fields));
    losses.friction += held.shear, losses.rolling += held.rolling;
    if (left.overlap < 0) losses.viscosity += held.normal;
  }
}

void WallContacts::grow(const Bodies& bodies, double factor) {
  const double share = 1 - 1 / factor;
  for (Chunk& chunk : chunks_)
    for (WallContact& contact : chunk.contact) {
      contact.overlap += share * bodies.position[contact.body].w;
      // The centres of spheres of clumps move closer, too.
      if (const std::uint32_t c = bodies.clumps.clump_of(contact.body); c != no_clump)
        contact.overlap +=
            share * contact.normal.dot(bodies.clumps.clump[c].axes * bodies.clumps.of_body[contact.body].place);
    }
}

void WallContacts::loads(std::span<WallLoad> loads, Ranks& ranks) const {
  std::fill(loads.begin(), loads.end(), WallLoad{});
  const auto add = [&](std::size_t w, const WallLoad& one) {
    loads[w].force += one.force, loads[w].moment += one.moment;
    loads[w].stiffness += one.stiffness, loads[w].contacts += one.contacts;
    loads[w].spring += one.spring, loads[w].dashpot += one.dashpot;
    loads[w].surface_force += one.surface_force, loads[w].surface_moment += one.surface_moment;
    loads[w].turning_spring += one.turning_spring, loads[w].turning_dashpot += one.turning_dashpot;
    loads[w].near += one.near;
  };
  struct Part {
    std::size_t wall;
    WallLoad load;
  };
  std::vector<Part> parts;  // in the order of chunks
  for (std::size_t c = ranks.first(); c < ranks.last(); ++c) {
    const Chunk& chunk = chunks_[c];
    for (std::size_t w = 0; w < chunk.load.size(); ++w) {
      const std::uint32_t near = chunk.candidate_start[w + 1] - chunk.candidate_start[w];
      if (near == 0) continue;
      if (ranks.several()) parts.push_back({w, chunk.load[w]}), parts.back().load.near = near;
      else add(w, chunk.load[w]), loads[w].near += near;
    }
  }
  if (ranks.several())
    for (const Part& part : ranks.all(parts)) add(part.wall, part.load);
}

double WallContacts::force_ahead(std::size_t wall, const WallSurface& surface, const Pose& there, const Vec3& velocity,
                                 const ContactLaw& law, const Bodies& bodies, std::span<const std::uint16_t> group,
                                 bool all, Ranks& ranks) const {
  std::vector<Sphere> spheres;
  std::vector<SurfaceContact> found;
  WallSurface at = surface;
  at.pose = there;
  const auto inspect = [&](std::uint32_t body) {
    const Row& x = bodies.position[body];
    spheres.push_back({at.within(xyz(x)), x.w, body});
  };
  for (std::size_t c = ranks.first(); c < ranks.last(); ++c) {
    const Chunk& chunk = chunks_[c];
    const ChunkRange range(c, bodies.count());
    if (all)
      for (std::size_t body = range.first; body < range.last; ++body) {
        if (surface.acts_on(group, body)) inspect(static_cast<std::uint32_t>(body));
      }
    else
      for (std::uint32_t n = chunk.candidate_start[wall]; n < chunk.candidate_start[wall + 1]; ++n)
        inspect(chunk.candidate[n]);
  }
  if (!spheres.empty()) surface.geometry->find_contacts(there, spheres, found);
  std::vector<double> forces;
  for (const SurfaceContact& contact : found) {
    const PairSize size = at_wall(bodies, contact.body, contact.overlap);
    const Stiffness k = law.stiffness(size, bodies.material[contact.body], surface.material);
    const double dashpot = 2 * k.damping_ratio * std::sqrt(k.normal / size.inverse_mass_a),
                 closing = contact.normal.dot(xyz(bodies.velocity[contact.body]) - velocity);
    // Attraction is left out: contacts to come, which it would draw in, count with their repulsion alone, so that a
    // servo approaches more slowly. Where contacts in tension close, the force passes the target by their pull at most.
    forces.push_back(std::max(0.0, k.normal * contact.overlap + dashpot * closing));
  }
  double sum = 0;
  for (const double force : ranks.all(forces)) sum += force;
  return sum;
}

void WallContacts::check_restored(std::size_t bodies, std::size_t walls, std::size_t materials) const {
  expect_restored(chunks_.size() == chunks_of(bodies), "contacts with walls are of another number of bodies");
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Chunk& chunk = chunks_[c];
    const std::size_t first = c * chunk_bodies, last = std::min(bodies, first + chunk_bodies);
    const auto is_here = [&](std::uint32_t body) { return body >= first && body < last; };
    expect_restored(chunk.candidate_start.size() == walls + 1 && chunk.candidate_start.front() == 0 &&
                        chunk.candidate_start.back() == chunk.candidate.size() &&
                        std::ranges::is_sorted(chunk.candidate_start),
                    "bodies near walls are of other walls");
    expect_restored(std::ranges::all_of(chunk.candidate, is_here), "a body that is not there is near a wall");
    expect_restored(
        chunk.crossed.size() == chunk.contact.size() && chunk.state.size() == chunk.contact.size() * fields_.size(),
        "lists of contacts with walls have different lengths");
    for (const WallContact& contact : chunk.contact)
      expect_restored(is_here(contact.body) && contact.wall < walls && contact.material < materials,
                      "a contact with a wall is of a body, a wall or a material that is not there");
  }
}

std::size_t WallContacts::touching_count() const {
  std::size_t count = 0;
  each([&](const Touching& t) { count += t.acts(); });
  return count;
}

}  // namespace grit
