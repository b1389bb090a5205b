// A world of some groups of bodies only, for probes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grit/world.hpp"

namespace grit {

/// The bodies of some groups of another world, their contacts with each other and with walls, and their loads on walls.
/// Time, cell, specimen and the energy balance are those of the other world.
class GroupView final : public World {
 public:
  explicit GroupView(std::vector<std::string> groups) : groups_(std::move(groups)) {}

  /// Takes the present state of `whole`, which must outlive the use of this view.
  void update(const World& whole);

  double time() const override { return whole_->time(); }
  std::uint64_t step() const override { return whole_->step(); }
  double dt() const override { return whole_->dt(); }
  const std::string& stage() const override { return whole_->stage(); }
  std::span<const std::uint32_t> ids() const override { return ids_; }
  std::span<const Row> positions() const override { return positions_; }
  std::span<const Row> velocities() const override { return velocities_; }
  std::span<const Row> spins() const override { return spins_; }
  std::span<const std::uint8_t> materials() const override { return materials_; }
  std::span<const std::string> material_names() const override { return whole_->material_names(); }
  std::span<const BodyGroup> groups() const override { return whole_->groups(); }
  std::span<const Vec3> rotations() const override { return rotations_; }
  std::span<const Vec3> displacements() const override { return displacements_; }
  std::span<const std::uint32_t> clump_of() const override { return clump_of_; }
  std::span<const ClumpView> clumps() const override { return clumps_; }
  std::span<const Vec3> arms() const override { return arms_; }
  std::span<const double> volume_fractions() const override { return volume_fractions_; }
  std::span<const std::uint8_t> held() const override { return held_; }
  std::span<const Departure> departures() const override { return departures_; }
  std::span<const Row> forces() const override { return forces_; }
  std::span<const Row> moments() const override { return moments_; }
  std::span<const Contact> contacts() const override { return contacts_; }
  std::span<const WallView> walls() const override { return walls_; }
  std::optional<Clearance> clearance(std::size_t index, const Vec3& point, double reach) const override {
    return whole_->clearance(index, point, reach);
  }
  const Cell& cell() const override { return whole_->cell(); }
  Region specimen() const override { return whole_->specimen(); }
  Region envelope() const override { return whole_->envelope(); }
  Region interior(double margin) const override { return whole_->interior(margin); }
  double mean_diameter() const override { return mean_diameter_; }
  double solid_density() const override { return solid_density_; }
  Energies energies() const override { return whole_->energies(); }

 private:
  bool has(std::uint32_t id) const;
  void take_bodies();
  void take_clumps();
  void take_contacts();
  void take_walls();
  void average();

  std::vector<std::string> groups_;
  const World* whole_ = nullptr;
  std::vector<std::uint32_t> taken_, now_;  // indices in the whole world; and those here of all its bodies
  std::vector<std::uint32_t> ids_, clump_of_;
  std::vector<Row> positions_, velocities_, spins_, forces_, moments_;
  std::vector<std::uint8_t> materials_, held_;
  std::vector<Vec3> rotations_, displacements_, arms_;
  std::vector<double> volume_fractions_;
  std::vector<ClumpView> clumps_;
  std::vector<Departure> departures_;
  std::vector<Contact> contacts_;
  std::vector<WallView> walls_;
  double mean_diameter_ = 0, solid_density_ = 0;
};

}  // namespace grit
