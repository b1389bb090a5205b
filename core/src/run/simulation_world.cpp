// The world as probes see it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engines/clump_motion.hpp"
#include "grit/error.hpp"
#include "run/simulation.hpp"

namespace grit {

std::span<const Row> Simulation::forces() const {
  if (net_step_ != clock_.step) {
    net_force_.resize(bodies_.count()), net_moment_.resize(bodies_.count());
    const auto find = [this](std::size_t i) {
      const bool alone = bodies_.clumps.clump_of(i) == no_clump;
      const Vec3 weight = alone ? Vec3(settings_.gravity / bodies_.velocity[i].w) : Vec3(Vec3::Zero());
      net_force_[i] = sum_[i].force, net_moment_[i] = sum_[i].moment;
      net_force_[i] += Row{weight.x(), weight.y(), weight.z(), 0};
      net_force_[i].w = net_moment_[i].w = 0;
      if (settings_.flat) {
        Vec3 force = xyz(net_force_[i]);
        force[*settings_.flat] = 0;
        const Vec3 moment = xyz(net_moment_[i]).cwiseProduct(Vec3::Unit(*settings_.flat));
        net_force_[i] = {force.x(), force.y(), force.z(), 0}, net_moment_[i] = {moment.x(), moment.y(), moment.z(), 0};
      }
    };
    team_.each(chunk_.size(), [&](std::size_t chunk) {
      const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
      for (std::size_t i = first; i < last; ++i) find(i);
    });
    net_step_ = clock_.step;
  }
  return net_force_;
}

std::span<const Row> Simulation::moments() const {
  static_cast<void>(forces());
  return net_moment_;
}

std::span<const Vec3> Simulation::displacements() const {
  if (displacement_step_ == clock_.step) return displacements_;
  displacements_.resize(bodies_.origin.size());
  for (std::size_t i = 0; i < displacements_.size(); ++i)
    displacements_[i] = xyz(bodies_.position[i]) - bodies_.origin[i];
  displacement_step_ = clock_.step;
  return displacements_;
}

std::span<const std::uint32_t> Simulation::clump_of() const {
  static_cast<void>(clumps());
  return clump_of_;
}

std::span<const Vec3> Simulation::arms() const {
  static_cast<void>(clumps());
  return arms_of_bodies_;
}

std::span<const ClumpView> Simulation::clumps() const {
  if (clump_step_ == clock_.step) return clump_views_;
  clump_views_.clear(), clump_of_.clear(), arms_of_bodies_.clear();
  clump_step_ = clock_.step;
  if (bodies_.clumps.none()) return clump_views_;
  clump_of_.resize(bodies_.count()), arms_of_bodies_.assign(bodies_.count(), Vec3::Zero());
  for (std::size_t i = 0; i < bodies_.count(); ++i) {
    const ClumpSphere& own = bodies_.clumps.of_body[i];
    clump_of_[i] = own.clump;
    if (own.clump != no_clump) arms_of_bodies_[i] = bodies_.clumps.clump[own.clump].axes * own.place;
  }
  for (const Clump& clump : bodies_.clumps.clump) {
    const ClumpLoad load = load_of(clump, bodies_, sum_.data());
    clump_views_.push_back({.id = clump.id,
                            .centre = clump.centre,
                            .velocity = clump.velocity,
                            .spin = clump.spin,
                            .momentum = clump.momentum,
                            .force = load.force + settings_.gravity / clump.inverse_mass,
                            .moment = load.moment,
                            .radius = clump.radius,
                            .mass = 1 / clump.inverse_mass,
                            .axes = clump.axes,
                            .inertia = clump.inertia});
  }
  return clump_views_;
}

std::span<const Contact> Simulation::contacts() const {
  if (contact_step_ == clock_.step) return contact_list_;
  contact_list_.clear();
  contact_list_.reserve(pairs_.touching_count() + wall_contacts_.touching_count());
  pairs_.each_touching(instant(true), [&](std::size_t c, const ContactRow& row) {
    const Vec3 branch = pairs_.branch(c, bodies_, shifts_.data());
    contact_list_.push_back({.a = pairs_.a(c),
                             .b = pairs_.b(c),
                             .with_wall = false,
                             .feature = 0,
                             .branch = branch,
                             .normal = branch.normalized(),
                             .force = xyz(row.force),
                             .moment = xyz(row.moment),
                             .normal_force = row.force.w,
                             .overlap = row.moment.w});
  });
  const auto with_walls = contacts_with_walls();
  contact_list_.insert(contact_list_.end(), with_walls.begin(), with_walls.end());
  contact_step_ = clock_.step;
  return contact_list_;
}

std::span<const Contact> Simulation::contacts_with_walls() const {
  if (wall_contact_step_ == clock_.step) return wall_contact_list_;
  wall_contact_list_.clear();
  wall_contacts_.each([&](const WallContacts::Touching& t) {
    const double arm = bodies_.position[t.touch->body].w - t.touch->overlap;
    wall_contact_list_.push_back({.a = t.touch->body,
                                  .b = t.touch->wall,
                                  .with_wall = true,
                                  .feature = t.touch->feature,
                                  .branch = arm * t.touch->normal,
                                  .normal = t.touch->normal,
                                  .force = xyz(t.row->force),
                                  .moment = xyz(t.row->moment),
                                  .normal_force = t.row->force.w,
                                  .overlap = t.touch->overlap});
  });
  wall_contact_step_ = clock_.step;
  return wall_contact_list_;
}

double Simulation::mean_contact_force() const {
  double sum = 0;
  std::size_t count = 0;
  pairs_.each_touching(instant(true),
                       [&](std::size_t, const ContactRow& row) { sum += std::abs(row.force.w), ++count; });
  wall_contacts_.each([&](const WallContacts::Touching& t) { sum += std::abs(t.row->force.w), ++count; });
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

std::span<const WallView> Simulation::walls() const {
  if (wall_step_ != clock_.step) walls_.view(wall_views_), wall_step_ = clock_.step;
  return wall_views_;
}

std::optional<Clearance> Simulation::clearance(std::size_t wall, const Vec3& point, double reach) const {
  const Sphere sphere{point, reach, 0};
  thread_local std::vector<Touch> touches;  // asked so often that to ask for memory each time took longer
  touches.clear();
  walls_.geometry(wall).touch(walls_.pose(wall), {&sphere, 1}, touches);
  // The sphere is pressed in by its radius less the distance of its centre, by more where that is behind.
  const auto deepest = std::ranges::max_element(touches, {}, &Touch::overlap);
  if (deepest == touches.end()) return {};
  return Clearance{.distance = reach - deepest->overlap, .normal = deepest->normal};
}

Region Simulation::region(double margin, Side side_of_walls) const {
  Region region{clock_.cell.low, clock_.cell.high};
  const auto wall = [&](const std::string& name) -> std::size_t {
    for (std::size_t w = 0; w < walls_.size(); ++w)
      if (walls_.name(w) == name) return w;
    throw Error("the specimen is bounded by wall \"" + name + "\", which does not exist");
  };
  const auto outer = [&](std::size_t w) { return side_of_walls == Side::far || walls_.geometry(w).hollow(); };
  for (int k = 0; k < 3; ++k) {
    const auto side = [&](const std::vector<std::string>& names) {
      return names.size() == 3 ? names[static_cast<std::size_t>(k)] : std::string();
    };
    if (const std::string name = side(scene_->specimen.low); !name.empty()) {
      const std::size_t w = wall(name);
      const Bounds bounds = walls_.geometry(w).bounds();
      region.low[k] = (outer(w) ? bounds.low : bounds.high)[k] + walls_.pose(w).shift[k] + margin;
    }
    if (const std::string name = side(scene_->specimen.high); !name.empty()) {
      const std::size_t w = wall(name);
      const Bounds bounds = walls_.geometry(w).bounds();
      region.high[k] = (outer(w) ? bounds.high : bounds.low)[k] + walls_.pose(w).shift[k] - margin;
    }
  }
  return region;
}

void Simulation::tell_walls_of_specimen() {
  if (!walls_.presses_on_specimen()) return;
  const Region specimen = region(0);
  walls_.set_specimen(specimen.high - specimen.low);
}

}  // namespace grit
