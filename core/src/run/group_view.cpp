#include "run/group_view.hpp"

#include <algorithm>
#include <numbers>

namespace grit {
namespace {

constexpr std::uint32_t absent = ~0u;

}  // namespace

bool GroupView::has(std::uint32_t id) const {
  return std::ranges::find(groups_, whole_->group_of(id)) != groups_.end();
}

void GroupView::update(const World& whole) {
  whole_ = &whole;
  take_bodies(), take_clumps(), take_contacts(), take_walls(), average();
}

void GroupView::take_bodies() {
  const auto ids = whole_->ids();
  taken_.clear();
  now_.assign(ids.size(), absent);
  for (std::uint32_t i = 0; i < ids.size(); ++i)
    if (has(ids[i])) now_[i] = static_cast<std::uint32_t>(taken_.size()), taken_.push_back(i);
  const auto take = [this](auto all, auto& chosen) {
    chosen.clear();
    if (all.empty()) return;
    for (const std::uint32_t i : taken_) chosen.push_back(all[i]);
  };
  take(ids, ids_), take(whole_->positions(), positions_), take(whole_->velocities(), velocities_);
  take(whole_->spins(), spins_), take(whole_->materials(), materials_), take(whole_->rotations(), rotations_);
  take(whole_->displacements(), displacements_), take(whole_->arms(), arms_), take(whole_->clump_of(), clump_of_);
  take(whole_->volume_fractions(), volume_fractions_), take(whole_->held(), held_);
  take(whole_->forces(), forces_), take(whole_->moments(), moments_);
  departures_.clear();
  std::ranges::copy_if(whole_->departures(), std::back_inserter(departures_),
                       [this](const Departure& one) { return has(one.id); });
}

void GroupView::take_clumps() {
  const auto all = whole_->clumps();
  std::vector<std::uint32_t> now(all.size(), absent);
  clumps_.clear();
  for (const std::uint32_t clump : clump_of_)
    if (clump != no_clump) now[clump] = 0;
  for (std::size_t c = 0; c < all.size(); ++c)
    if (now[c] != absent) now[c] = static_cast<std::uint32_t>(clumps_.size()), clumps_.push_back(all[c]);
  for (std::uint32_t& clump : clump_of_)
    if (clump != no_clump) clump = now[clump];
}

void GroupView::take_contacts() {
  contacts_.clear();
  for (Contact contact : whole_->contacts()) {
    contact.a = now_[contact.a];
    if (!contact.with_wall) contact.b = now_[contact.b];
    if (contact.a != absent && contact.b != absent) contacts_.push_back(contact);
  }
}

void GroupView::take_walls() {
  const auto all = whole_->walls();
  walls_.assign(all.begin(), all.end());
  for (WallView& wall : walls_) wall.force = wall.moment = Vec3::Zero(), wall.contacts = 0;
  for (const Contact& contact : contacts_with_walls()) {
    WallView& wall = walls_[contact.b];
    const Vec3 point = xyz(positions_[contact.a]) + contact.branch, reference = wall.pose.about + wall.pose.shift;
    wall.force += contact.force, wall.moment += (point - reference).cross(contact.force) + contact.moment;
    ++wall.contacts;
  }
  for (WallView& wall : walls_) wall.pressure = wall.area > 0 ? -wall.force.dot(wall.normal) / wall.area : 0;
}

void GroupView::average() {
  double diameters = 0, mass = 0, volume = 0;
  std::size_t count = clumps_.size();
  for (const ClumpView& clump : clumps_) diameters += 2 * clump.radius, mass += clump.mass;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const double radius = positions_[i].w, fraction = volume_fractions_.empty() ? 1 : volume_fractions_[i];
    volume += fraction * 4 / 3 * std::numbers::pi * radius * radius * radius;
    if (!clump_of_.empty() && clump_of_[i] != no_clump) continue;
    ++count, diameters += 2 * radius, mass += 1 / velocities_[i].w;
  }
  mean_diameter_ = count > 0 ? diameters / static_cast<double>(count) : 0;
  solid_density_ = volume > 0 ? mass / volume : 0;
}

}  // namespace grit
