// A world of some groups of bodies only, for probes and engines.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grit/world.hpp"

namespace grit {

/// The bodies of some groups of another world, their contacts with each other and with walls, and their loads on walls.
/// Time, cell, specimen and the energy balance are those of the other world. What is not asked for is not copied.
class GroupView final : public World {
 public:
  explicit GroupView(std::vector<std::string> groups) : groups_(std::move(groups)) {}

  /// Takes the present state of `whole`, which must outlive the use of this view, and not change during it.
  void update(const World& whole);

  double time() const override { return whole_->time(); }
  std::uint64_t step() const override { return whole_->step(); }
  double dt() const override { return whole_->dt(); }
  const std::string& stage() const override { return whole_->stage(); }
  std::span<const std::uint32_t> ids() const override { return taken(ids_, &World::ids); }
  std::span<const Row> positions() const override { return taken(positions_, &World::positions); }
  std::span<const Row> velocities() const override { return taken(velocities_, &World::velocities); }
  std::span<const Row> spins() const override { return taken(spins_, &World::spins); }
  std::span<const std::uint8_t> materials() const override { return taken(materials_, &World::materials); }
  std::span<const std::string> material_names() const override { return whole_->material_names(); }
  std::span<const BodyGroup> groups() const override { return whole_->groups(); }
  std::span<const Vec3> rotations() const override { return taken(rotations_, &World::rotations); }
  std::span<const Vec3> displacements() const override { return taken(displacements_, &World::displacements); }
  std::span<const std::uint32_t> clump_of() const override;
  std::span<const ClumpView> clumps() const override;
  std::span<const Vec3> arms() const override { return taken(arms_, &World::arms); }
  std::span<const double> volume_fractions() const override {
    return taken(volume_fractions_, &World::volume_fractions);
  }
  std::span<const double> unscaled_shares() const override { return taken(unscaled_shares_, &World::unscaled_shares); }
  std::span<const std::uint8_t> held() const override { return taken(held_, &World::held); }
  std::span<const Departure> departures() const override;
  std::span<const Row> forces() const override { return taken(forces_, &World::forces); }
  std::span<const Row> moments() const override { return taken(moments_, &World::moments); }
  std::span<const Contact> contacts() const override { return within(contacts_, &World::contacts); }
  std::span<const Contact> contacts_with_walls() const override {
    return within(wall_contacts_, &World::contacts_with_walls);
  }
  std::span<const WallView> walls() const override;
  std::optional<Clearance> clearance(std::size_t index, const Vec3& point, double reach) const override {
    return whole_->clearance(index, point, reach);
  }
  const Cell& cell() const override { return whole_->cell(); }
  Region specimen() const override { return whole_->specimen(); }
  Region envelope() const override { return whole_->envelope(); }
  Region interior(double margin) const override { return whole_->interior(margin); }
  double mean_diameter() const override;
  double solid_density() const override;
  Energies energies() const override { return whole_->energies(); }

 private:
  /// Values of an update, once they were asked for.
  template <class T>
  struct Column {
    std::vector<T> values;
    std::uint64_t update = 0;
  };
  template <class T>
  using Of = std::span<const T> (World::*)() const;

  /// Whether the values must be computed; they are then empty.
  template <class T>
  bool stale(Column<T>& column) const {
    if (column.update == update_) return false;
    column.update = update_;
    column.values.clear();
    return true;
  }
  /// One value per body of the groups; none if the whole world has none.
  template <class T>
  std::span<const T> taken(Column<T>& column, Of<T> of) const {
    if (stale(column))
      if (const auto all = (whole_->*of)(); !all.empty())
        for (const std::uint32_t i : bodies_) column.values.push_back(all[i]);
    return column.values;
  }
  /// Contacts between bodies of the groups, and of these with walls.
  std::span<const Contact> within(Column<Contact>& column, Of<Contact> of) const;
  bool has(std::uint32_t id) const;
  void average() const;

  std::vector<std::string> groups_;
  const World* whole_ = nullptr;
  std::uint64_t update_ = 0;           // number of updates
  std::vector<bool> chosen_;           // by entry of groups()
  std::vector<std::uint32_t> bodies_;  // indices in the whole world

  mutable Column<std::uint32_t> index_;  // here, of each body of the whole world
  mutable Column<std::uint32_t> ids_, clump_of_;
  mutable Column<Row> positions_, velocities_, spins_, forces_, moments_;
  mutable Column<std::uint8_t> materials_, held_;
  mutable Column<Vec3> rotations_, displacements_, arms_;
  mutable Column<double> volume_fractions_, unscaled_shares_, averages_;  // the mean diameter and the solid density
  mutable Column<ClumpView> clumps_;
  mutable Column<Departure> departures_;
  mutable Column<Contact> contacts_, wall_contacts_;
  mutable Column<WallView> walls_;
};

}  // namespace grit
