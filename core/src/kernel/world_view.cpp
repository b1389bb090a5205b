#include "kernel/world_view.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/energy_balance.hpp"
#include "kernel/scaled_masses.hpp"
#include "kernel/specimen.hpp"
#include "motion/clump_motion.hpp"

namespace grit {
namespace {

/// Whether a pair overlaps or has a force; otherwise it is only within the reach of the law.
bool acts(const ContactRow& row) { return row.moment.w >= 0 || row.force.w != 0; }

}  // namespace

void WorldView::invalidate() {
  net_step_ = contact_step_ = wall_contact_step_ = wall_step_ = clump_step_ = displacement_step_ = held_step_ = never;
  collected_step_ = never;
}

void WorldView::complete() const {
  if (!passes_.ranks().several()) return;
  static_cast<void>(bodies()), static_cast<void>(clumps());
}

void WorldView::collect_contacts() const {
  Ranks& ranks = passes_.ranks();
  if (!ranks.several() || contact_step_ == step()) return;
  find_contacts([&](const std::vector<Contact>& own) { return ranks.collected(own); });
  collected_step_ = step();
}

void WorldView::find_net_forces(std::size_t chunk) const {
  const Bodies& bodies = state_.bodies;
  const ChunkRange range(chunk, bodies.count());
  for (std::size_t i = range.first; i < range.last; ++i) {
    const MotionSettings& motion = state_.motion_of(i);
    const bool single = bodies.clumps.clump_of(i) == no_clump;
    const Vec3 weight =
        single ? Vec3(motion.gravity_on(bodies.position[i].w) / bodies.velocity[i].w) : Vec3(Vec3::Zero());
    net_force_[i] = state_.sum[i].force, net_moment_[i] = state_.sum[i].moment;
    net_force_[i] += Row{weight.x(), weight.y(), weight.z(), 0};
    net_force_[i].w = net_moment_[i].w = 0;
    if (single && (motion.flat || motion.holds())) {
      const Vec3 force = motion.free_translation().cwiseProduct(xyz(net_force_[i])),
                 moment = motion.free_rotation().cwiseProduct(xyz(net_moment_[i]));
      net_force_[i] = {force.x(), force.y(), force.z(), 0}, net_moment_[i] = {moment.x(), moment.y(), moment.z(), 0};
    }
  }
}

std::span<const Row> WorldView::forces() const {
  if (net_step_ != step()) {
    complete_sums(state_, passes_);
    static_cast<void>(bodies());
    net_force_.resize(count()), net_moment_.resize(count());
    passes_.team().each(passes_.chunks().size(), [this](std::size_t chunk) { find_net_forces(chunk); });
    net_step_ = step();
  }
  return net_force_;
}

std::span<const Row> WorldView::moments() const {
  static_cast<void>(forces());
  return net_moment_;
}

std::span<const double> WorldView::unscaled_shares() const {
  return unscaled_shares_ = grit::unscaled_shares(state_.bodies, state_.settings);
}

std::span<const Vec3> WorldView::displacements() const {
  if (displacement_step_ == step()) return displacements_;
  const Bodies& bodies = this->bodies();
  displacements_.resize(bodies.origin.size());
  for (std::size_t i = 0; i < displacements_.size(); ++i)
    displacements_[i] = xyz(bodies.position[i]) - bodies.origin[i];
  displacement_step_ = step();
  return displacements_;
}

std::span<const std::uint8_t> WorldView::held() const {
  if (held_step_ == step()) return held_;
  const auto held = [](const MotionSettings& motion) { return motion.constrained_translation() == Vec3::Ones(); };
  held_.clear();
  held_step_ = step();
  if (!state_.settings.any_motion(held)) return held_;
  for (std::size_t i = 0; i < count(); ++i) held_.push_back(held(state_.motion_of(i)));
  return held_;
}

std::span<const std::uint32_t> WorldView::clump_of() const {
  static_cast<void>(clumps());
  return clump_of_;
}

std::span<const Vec3> WorldView::arms() const {
  static_cast<void>(clumps());
  return arms_;
}

std::span<const ClumpView> WorldView::clumps() const {
  if (clump_step_ == step()) return clumps_;
  clumps_.clear(), clump_of_.clear(), arms_.clear();
  clump_step_ = step();
  const Bodies& bodies = state_.bodies;
  if (bodies.clumps.none()) return clumps_;
  complete_sums(state_, passes_);
  clump_of_.resize(count()), arms_.assign(count(), Vec3::Zero());
  for (std::size_t i = 0; i < count(); ++i) {
    const ClumpSphere& own = bodies.clumps.of_body[i];
    clump_of_[i] = own.clump;
    if (own.clump != no_clump) arms_[i] = bodies.clumps.clump[own.clump].axes * own.place;
  }
  for (const Clump& clump : bodies.clumps.clump) {
    const ClumpLoad load = load_of(clump, bodies, state_.sum.data());
    const MotionSettings& motion = state_.motion_of(clump);
    clumps_.push_back({.id = clump.id,
                       .centre = clump.centre,
                       .velocity = clump.velocity,
                       .spin = clump.spin,
                       .momentum = clump.momentum,
                       .force = motion.free_translation().cwiseProduct(load.force + motion.gravity_on(clump.radius) /
                                                                                        clump.inverse_mass),
                       .moment = motion.free_rotation().cwiseProduct(load.moment),
                       .radius = clump.radius,
                       .mass = 1 / clump.inverse_mass,
                       .unscaled_mass = motion.unscaled_share(clump.radius) / clump.inverse_mass,
                       .axes = clump.axes,
                       .inertia = clump.inertia});
  }
  return clumps_;
}

std::span<const Contact> WorldView::contacts() const {
  Ranks& ranks = passes_.ranks();
  if (contact_step_ == step() || (collected_step_ == step() && ranks.is_alone())) return contacts_;
  find_contacts([&](const std::vector<Contact>& own) { return ranks.all(own); });
  contact_step_ = step();
  return contacts_;
}

template <class Join>
void WorldView::find_contacts(Join join) const {
  contacts_.clear();
  contacts_.reserve(state_.pairs.touching_count() + state_.wall_contacts.touching_count());
  for (const ContactTable::Kind kind : {ContactTable::Kind::within, ContactTable::Kind::across}) {
    std::vector<Contact> of_rank;
    std::vector<Contact>& own = passes_.ranks().several() ? of_rank : contacts_;
    state_.pairs.each_touching(kind, state_.instant(true), [&](std::size_t c, const ContactRow& row) {
      if (!acts(row)) return;
      const Vec3 branch = state_.pairs.branch(c, state_.bodies, state_.cell.images());
      own.push_back({.a = state_.pairs.a(c),
                     .b = state_.pairs.b(c),
                     .with_wall = false,
                     .feature = 0,
                     .branch = branch,
                     .normal = branch.normalized(),
                     .force = xyz(row.force),
                     .moment = xyz(row.moment),
                     .normal_force = row.force.w,
                     .overlap = row.moment.w});
    });
    if (!passes_.ranks().several()) continue;
    const std::vector<Contact> found = join(of_rank);
    contacts_.insert(contacts_.end(), found.begin(), found.end());
  }
  const auto include_walls = contacts_with_walls();
  contacts_.insert(contacts_.end(), include_walls.begin(), include_walls.end());
}

std::span<const Contact> WorldView::contacts_with_walls() const {
  if (wall_contact_step_ == step()) return wall_contacts_;
  wall_contacts_.clear();
  static_cast<void>(bodies());
  state_.wall_contacts.complete(passes_.ranks());
  state_.wall_contacts.each([&](const WallContacts::Touching& t) {
    if (!t.acts()) return;
    const double arm = state_.bodies.position[t.contact->body].w - t.contact->overlap;
    wall_contacts_.push_back({.a = t.contact->body,
                              .b = t.contact->wall,
                              .with_wall = true,
                              .feature = t.contact->feature,
                              .branch = arm * t.contact->normal,
                              .normal = t.contact->normal,
                              .force = xyz(t.row->force),
                              .moment = xyz(t.row->moment),
                              .normal_force = t.row->force.w,
                              .overlap = t.contact->overlap});
  });
  wall_contact_step_ = step();
  return wall_contacts_;
}

double WorldView::mean_contact_force() const {
  struct Forces {
    double sum = 0, count = 0;
    void add(double normal, bool counts) { sum += std::abs(normal), count += counts ? 1 : 0; }
  };
  Forces all;
  for (const Forces& of_chunk : passes_.of_chunks([this](std::size_t chunk) {
         Forces own;
         if (chunk >= chunks_of(state_.pairs.bodies())) return own;  // of bodies that have just been appended
         state_.pairs.each_contact(chunk, state_.instant(true),
                                   [&](std::size_t, const ContactRow& row) { own.add(row.force.w, acts(row)); });
         state_.wall_contacts.each(chunk, [&](const WallContacts::Touching& t) { own.add(t.row->force.w, t.acts()); });
         return own;
       }))
    all.sum += of_chunk.sum, all.count += of_chunk.count;
  return all.count > 0 ? all.sum / all.count : 0;
}

std::span<const WallView> WorldView::walls() const {
  if (wall_step_ != step()) state_.walls.view(walls_), wall_step_ = step();
  return walls_;
}

std::optional<Clearance> WorldView::clearance(std::size_t wall, const Vec3& point, double reach) const {
  const Sphere sphere{point, reach, 0};
  thread_local std::vector<SurfaceContact> contacts;  // avoids an allocation per call
  contacts.clear();
  state_.walls.geometry(wall).find_contacts(state_.walls.pose(wall), {&sphere, 1}, contacts);
  // overlap = radius − distance of the centre; the distance is negative behind a face
  const auto deepest = std::ranges::max_element(contacts, {}, &SurfaceContact::overlap);
  if (deepest == contacts.end()) return {};
  return Clearance{.distance = reach - deepest->overlap, .normal = deepest->normal};
}

Region WorldView::specimen() const { return specimen_region(state_, 0); }
Region WorldView::envelope() const { return specimen_region(state_, 0, SurfaceSide::far); }
Region WorldView::interior(double margin) const { return specimen_region(state_, margin); }

Energies WorldView::energies() const { return balance_->terms(); }

}  // namespace grit
