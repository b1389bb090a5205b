// Who is in the domain: bodies that come, that leave, and that go on at the other side of a period.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "grit/error.hpp"
#include "run/number.hpp"
#include "run/simulation.hpp"

namespace grit {

Vec3 Clock::growth_of_period() const {
  Vec3 growth = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (!cell.periodic[k]) continue;
    const double period = cell.high[k] - cell.low[k];
    growth[k] = last_time_step == 0 ? period * cell.strain_rate[k] : (period - period_before[k]) / last_time_step;
  }
  return growth;
}

void Simulation::take_stock(std::size_t first, std::size_t first_clump) {
  for (std::size_t i = first; i < bodies_.count(); ++i) {
    const double r = bodies_.position[i].w;
    stock_.largest_radius = std::max(stock_.largest_radius, r);
    stock_.smallest_radius = stock_.smallest_radius == 0 ? r : std::min(stock_.smallest_radius, r);
    if (const double per_mass = bodies_.velocity[i].w; per_mass > 0)
      stock_.heaviest = std::max(stock_.heaviest, 1 / (per_mass * r * r * r));
    stock_.one_material = stock_.one_material && bodies_.material[i] == 0;
    if (bodies_.clumps.clump_of(i) != no_clump) continue;
    ++stock_.grains;
    stock_.diameters += 2 * r, stock_.mass += 1 / bodies_.velocity[i].w,
        stock_.solids += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  }
  for (std::size_t c = first_clump; c < bodies_.clumps.clump.size(); ++c) {
    const Clump& clump = bodies_.clumps.clump[c];
    ++stock_.grains;
    stock_.diameters += 2 * clump.radius, stock_.mass += 1 / clump.inverse_mass, stock_.solids += clump.volume;
  }
  if (stock_.grains > 0)
    stock_.mean_diameter = stock_.diameters / static_cast<double>(stock_.grains),
    stock_.solid_density = stock_.mass / stock_.solids;
  sum_.resize(bodies_.count() + 1);
  std::fill(sum_.begin() + static_cast<std::ptrdiff_t>(first), sum_.end(), BodySum{});
  chunk_.resize(chunks_of(bodies_.count()));
}

void Simulation::admit() {
  Newcomers newcomers;
  try {
    newcomers = make_newcomers(*scene_, stage_, clock_.cell, positions(), bodies_.state);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    fail(error.what());
  }
  Bodies& bodies = newcomers.bodies;
  if (bodies.count() == 0) return;
  // They take part in the mean flow of a deforming cell, and velocities are those of half a step ago.
  const Vec3 fall = 0.5 * clock_.last_time_step * next_motion().free_translation().cwiseProduct(settings_.gravity);
  const auto change = [&](const Vec3& place) -> Vec3 {
    return clock_.cell.strain_rate.isZero(0.0) ? Vec3(-fall)
                                               : Vec3(clock_.cell.strain_rate.cwiseProduct(place - centre()) - fall);
  };
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    const std::uint32_t c = bodies.clumps.clump_of(i);
    const Vec3 v = change(c == no_clump ? xyz(bodies.position[i]) : bodies.clumps.clump[c].centre);
    bodies.velocity[i] += Row{v.x(), v.y(), v.z(), 0};
  }
  for (Clump& clump : bodies.clumps.clump) clump.velocity += change(clump.centre);

  const auto stored = [this] {
    if (!flows_.begun) return 0.0;
    const EnergyLedger now = energies();
    return now.kinetic + now.elastic() - now.walls - now.cell - now.engines - (now.settings - flows_.settings);
  };
  const double put_in = flows_.settings - stored();  // but for what is stored; bodies may also leave in a search
  const std::size_t first = bodies_.count(), first_clump = bodies_.clumps.clump.size();
  const Bodies bodies_before = bodies_;
  const Stock stock_before = stock_;
  newcomers_ = std::move(newcomers.groups);
  for (auto& group : newcomers_) group.first_id += bodies_.ids_given;
  bodies_.append(bodies);
  take_stock(first, first_clump);
  if (settings_.flat) flatten(*settings_.flat);
  soft_until_ = overlap_of_soft_springs();
  search_now_ = true;
  try {
    find_forces();
  } catch (const NumericsError&) {
    if (newcomers_.empty()) {  // they are there, and a guard tripped
      show_forces();
      flows_.settings = put_in + stored();
    } else {  // they were turned away, and what is there shall be whole
      bodies_ = bodies_before, stock_ = stock_before;
      sum_.resize(bodies_.count() + 1), chunk_.resize(chunks_of(bodies_.count()));
      soft_until_ = overlap_of_soft_springs();
      newcomers_.clear();
    }
    throw;
  }
  flows_.settings = put_in + stored();
}

void Simulation::check_newcomers() const {
  struct Overlap {
    double share = 0;
    std::uint32_t newcomer = 0, other = 0;
    bool with_wall = false;
  } deepest;
  std::size_t count = 0;
  const auto is_new = [this](std::uint32_t body) { return bodies_.id[body] >= newcomers_.front().first_id; };
  const auto group_of = [this](std::uint32_t body) -> const std::string& {
    const auto next = std::ranges::upper_bound(newcomers_, bodies_.id[body], {}, &Newcomers::Group::first_id);
    return std::prev(next)->name;
  };
  const auto allowed = [&](std::uint32_t body) { return scene_->bodies.at(group_of(body)).overlap; };
  const auto look = [&](const Overlap& one) {
    if (!(one.share > allowed(one.newcomer))) return;
    ++count;
    if (one.share > deepest.share) deepest = one;
  };
  Skins skins;
  skins.lay_on(std::vector<double>(chunk_.size(), 0.0), 0);
  NeighbourSearch touching;
  touching.build(bodies_, clock_.cell, skins);
  std::vector<Candidate> found;
  for (std::uint32_t body = 0; body < bodies_.count(); ++body) {
    found.clear();
    touching.neighbours(bodies_, body, found);
    for (const Candidate& c : found) {
      if (!c.touching() || is_new(c.a) == is_new(c.b)) continue;
      const Row &a = bodies_.position[c.a], &b = bodies_.position[c.b];
      const double distance = (xyz(b) - xyz(a) + xyz(shifts_[c.image].position)).norm();
      const double share = (a.w + b.w - distance) / std::min(a.w, b.w);
      look({share, is_new(c.a) ? c.a : c.b, is_new(c.a) ? c.b : c.a, false});
    }
    if (!is_new(body)) continue;
    const Row& x = bodies_.position[body];
    for (std::uint32_t wall = 0; wall < walls_.size(); ++wall)
      if (const auto near = clearance(wall, xyz(x), x.w)) look({(x.w - near->distance) / x.w, body, wall, true});
  }
  if (count == 0) return;
  const std::string& group = group_of(deepest.newcomer);
  fail_at_body(deepest.newcomer,
               "of the group \"" + group + "\" appears inside " +
                   (deepest.with_wall ? "wall \"" + walls_.name(deepest.other) + "\""
                                      : "body " + std::to_string(bodies_.id[deepest.other])) +
                   ": they overlap by " + number(deepest.share) + " of " + (deepest.with_wall ? "its" : "the smaller") +
                   " radius, more than /bodies/" + group + "/overlap " + number(allowed(deepest.newcomer)) +
                   (count > 1 ? ", the deepest of " + std::to_string(count) + " such pairs" : ""),
               deepest.with_wall
                   ? "place it in front of the wall; the box of a cloud must be clear of walls"
                   : "place it where nothing is, let it come in another stage, or take a cloud, which keeps clear");
}

void Simulation::update_shifts() {
  const Vec3 period = clock_.cell.high - clock_.cell.low, growth = clock_.growth_of_period();
  for (std::uint8_t image = 0; image < 27; ++image) {
    const auto shift = image_shift(image);
    double position[3], velocity[3];
    for (int k = 0; k < 3; ++k) {
      position[k] = shift[k] != 0 ? shift[k] * period[k] : 0;
      velocity[k] = shift[k] != 0 ? shift[k] * growth[k] : 0;
    }
    shifts_[image] = {{position[0], position[1], position[2], 0}, {velocity[0], velocity[1], velocity[2], 0}};
  }
}

bool Simulation::may_leave(int axis, bool high) const {
  const std::string side = std::string(high ? "+" : "-") + "xyz"[axis];
  return std::ranges::find(scene_->domain.open_sides, side) != scene_->domain.open_sides.end();
}

std::vector<bool> Simulation::wrap() {
  const Cell& cell = clock_.cell;
  const Vec3 period = cell.high - cell.low, growth = clock_.growth_of_period();
  std::vector<bool> leaves(bodies_.count(), false);
  const auto outside = [&](const Vec3& x, int k) { return x[k] < cell.low[k] || x[k] > cell.high[k]; };
  const auto periods_off = [&](const Vec3& x, int k) { return std::floor((x[k] - cell.low[k]) / period[k]); };
  // What goes on at the other side goes with the mean flow there.
  double gained = 0;
  const auto jump = [](double& speed, double by, double inverse_mass) {
    const double before = speed;
    speed -= by;
    return 0.5 / inverse_mass * (speed * speed - before * before);
  };
  // A clump leaves as a whole, by its centre.
  for (Clump& clump : bodies_.clumps.clump)
    for (int k = 0; k < 3; ++k) {
      if (!cell.periodic[k]) {
        if (!outside(clump.centre, k) || !may_leave(k, clump.centre[k] > cell.high[k])) continue;
        for (std::uint32_t s = clump.first; s < clump.last; ++s) leaves[bodies_.clumps.spheres[s]] = true;
        continue;
      }
      const double periods = periods_off(clump.centre, k);
      if (periods == 0) continue;
      clump.centre[k] -= periods * period[k];
      gained += jump(clump.velocity[k], periods * growth[k], clump.inverse_mass);
      for (std::uint32_t s = clump.first; s < clump.last; ++s)
        bodies_.clumps.of_body[bodies_.clumps.spheres[s]].periods[static_cast<std::size_t>(k)] -=
            static_cast<std::int8_t>(periods);
    }
  for (std::size_t i = 0; i < bodies_.count(); ++i) {
    Vec3 x = xyz(bodies_.position[i]), v = xyz(bodies_.velocity[i]);
    const bool in_clump = bodies_.clumps.clump_of(i) != no_clump;
    bool moved = false;
    for (int k = 0; k < 3; ++k) {
      if (!cell.periodic[k]) {
        const bool high = x[k] > cell.high[k];
        if (!outside(x, k)) continue;
        if (!may_leave(k, high))
          fail_at_body(
              i, "left the domain through its " + std::string(high ? "upper" : "lower") + " " + "xyz"[k] + " side",
              "close the domain there with a wall, make it larger, or name the side in /domain/open_sides");
        if (!in_clump) leaves[i] = true;
        continue;
      }
      const double periods = periods_off(x, k);
      if (periods == 0) continue;
      x[k] -= periods * period[k];
      if (!bodies_.origin.empty()) bodies_.origin[i][k] -= periods * period[k];
      const double own = jump(v[k], periods * growth[k], bodies_.velocity[i].w);
      if (!in_clump) gained += own;
      if (in_clump) bodies_.clumps.of_body[i].periods[static_cast<std::size_t>(k)] += static_cast<std::int8_t>(periods);
      else if (x[k] >= cell.high[k]) x[k] = cell.low[k];
      moved = true;
    }
    if (!moved) continue;
    bodies_.position[i] = {x.x(), x.y(), x.z(), bodies_.position[i].w};
    bodies_.velocity[i] = {v.x(), v.y(), v.z(), bodies_.velocity[i].w};
  }
  if (flows_.begun) flows_.cell += gained;
  return leaves;
}

void Simulation::take_leave(const std::vector<bool>& leaves) {
  const auto depart = [&](std::size_t i, const Vec3& x, const Vec3& v, double inverse_mass, double turning) {
    departures_.push_back({.id = bodies_.id[i],
                           .material = bodies_.material[i],
                           .time = clock_.time,
                           .mass = 1 / inverse_mass,
                           .position = x});
    mass_left_ += 1 / inverse_mass;
    const double kinetic = 0.5 / inverse_mass * v.squaredNorm() + turning;
    if (flows_.begun) flows_.settings -= kinetic;
    // The guard goes on with what stays.
    energy_.stored_at_start -= kinetic - settings_.gravity.dot(x) / inverse_mass;
  };
  std::vector<std::size_t> leaving;
  for (std::size_t i = 0; i < bodies_.count(); ++i)
    if (leaves[i]) leaving.push_back(i);
  std::ranges::sort(leaving, {}, [this](std::size_t i) { return bodies_.id[i]; });
  for (const std::size_t i : leaving) {
    const std::uint32_t c = bodies_.clumps.clump_of(i);
    if (c == no_clump) {
      depart(i, xyz(bodies_.position[i]), xyz(bodies_.velocity[i]), bodies_.velocity[i].w,
             0.5 / bodies_.spin[i].w * xyz(bodies_.spin[i]).squaredNorm());
    } else if (const Clump& clump = bodies_.clumps.clump[c]; bodies_.clumps.spheres[clump.first] == i) {
      depart(i, clump.centre, clump.velocity, clump.inverse_mass, 0.5 * clump.momentum.dot(clump.spin));
    }
  }
}

}  // namespace grit
