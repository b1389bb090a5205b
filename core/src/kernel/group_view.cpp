#include "kernel/group_view.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>

namespace grit {
namespace {

constexpr std::uint32_t absent = ~0u;

}  // namespace

bool GroupView::has(std::uint32_t id) const {
  const auto all = whole_->groups();
  const auto next = std::ranges::upper_bound(all, id, {}, &BodyGroup::first_id);
  return next != all.begin() && chosen_[static_cast<std::size_t>(next - all.begin()) - 1];
}

void GroupView::update(const World& whole) {
  whole_ = &whole;
  ++update_;
  chosen_.clear();
  for (const BodyGroup& group : whole.groups())
    chosen_.push_back(std::ranges::find(groups_, group.name) != groups_.end());
  const auto ids = whole.ids();
  bodies_.clear();
  for (std::uint32_t i = 0; i < ids.size(); ++i)
    if (has(ids[i])) bodies_.push_back(i);
}

std::span<const Departure> GroupView::departures() const {
  if (stale(departures_))
    std::ranges::copy_if(whole_->departures(), std::back_inserter(departures_.values),
                         [this](const Departure& one) { return has(one.id); });
  return departures_.values;
}

std::span<const std::uint32_t> GroupView::clump_of() const {
  static_cast<void>(clumps());
  return clump_of_.values;
}

std::span<const ClumpView> GroupView::clumps() const {
  if (!stale(clumps_)) return clumps_.values;
  taken(clump_of_, &World::clump_of);
  const auto all = whole_->clumps();
  std::vector<std::uint32_t> now(all.size(), absent);
  for (const std::uint32_t clump : clump_of_.values)
    if (clump != no_clump) now[clump] = 0;
  for (std::size_t c = 0; c < all.size(); ++c)
    if (now[c] != absent) now[c] = static_cast<std::uint32_t>(clumps_.values.size()), clumps_.values.push_back(all[c]);
  for (std::uint32_t& clump : clump_of_.values)
    if (clump != no_clump) clump = now[clump];
  return clumps_.values;
}

std::span<const Contact> GroupView::within(Column<Contact>& column, Of<Contact> of) const {
  if (!stale(column)) return column.values;
  if (stale(index_)) {
    index_.values.assign(whole_->ids().size(), absent);
    for (std::uint32_t here = 0; here < bodies_.size(); ++here) index_.values[bodies_[here]] = here;
  }
  for (Contact contact : (whole_->*of)()) {
    contact.a = index_.values[contact.a];
    if (!contact.with_wall) contact.b = index_.values[contact.b];
    if (contact.a != absent && contact.b != absent) column.values.push_back(contact);
  }
  return column.values;
}

std::span<const WallView> GroupView::walls() const {
  if (!stale(walls_)) return walls_.values;
  const auto all = whole_->walls();
  walls_.values.assign(all.begin(), all.end());
  for (WallView& wall : walls_.values) wall.force = wall.moment = Vec3::Zero(), wall.contacts = 0;
  const auto centres = positions();
  for (const Contact& contact : contacts_with_walls()) {
    WallView& wall = walls_.values[contact.b];
    const Vec3 point = xyz(centres[contact.a]) + contact.branch, reference = wall.pose.about + wall.pose.shift;
    wall.force += contact.force, wall.moment += (point - reference).cross(contact.force) + contact.moment;
    ++wall.contacts;
  }
  for (WallView& wall : walls_.values) wall.pressure = wall.area > 0 ? -wall.force.dot(wall.normal) / wall.area : 0;
  return walls_.values;
}

void GroupView::average() const {
  if (!stale(averages_)) return;
  const auto own_clumps = clumps();
  const auto own_positions = positions(), own_velocities = velocities();
  const auto fractions = volume_fractions();
  const auto of = clump_of();
  double diameters = 0, mass = 0, volume = 0;
  std::size_t count = own_clumps.size();
  for (const ClumpView& clump : own_clumps) diameters += 2 * clump.radius, mass += clump.mass;
  for (std::size_t i = 0; i < own_positions.size(); ++i) {
    const double radius = own_positions[i].w, fraction = fractions.empty() ? 1 : fractions[i];
    volume += fraction * 4 / 3 * std::numbers::pi * radius * radius * radius;
    if (!of.empty() && of[i] != no_clump) continue;
    ++count, diameters += 2 * radius, mass += 1 / own_velocities[i].w;
  }
  averages_.values = {count > 0 ? diameters / static_cast<double>(count) : 0, volume > 0 ? mass / volume : 0};
}

double GroupView::mean_diameter() const {
  average();
  return averages_.values[0];
}

double GroupView::solid_density() const {
  average();
  return averages_.values[1];
}

}  // namespace grit
