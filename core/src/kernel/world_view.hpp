// The World that probes, engines and conditions read.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "grit/world.hpp"
#include "kernel/completion.hpp"
#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

class EnergyBalance;

/// A const view of a state. Derived quantities are computed on demand, at most once per instant.
class WorldView final : public World {
 public:
  WorldView(State& state, Passes& passes) : state_(state), passes_(passes) {}
  void set_balance(EnergyBalance& balance) { balance_ = &balance; }

  /// After a change of state: everything is recomputed on demand.
  void invalidate();
  /// The same for forces and quantities that depend on them, and for settings.
  void invalidate_forces() { net_step_ = clump_step_ = held_step_ = never; }

  /// Completes bodies and clumps with values of other ranks, which then need not take part until the next step.
  void complete() const;
  /// The same of contacts, on the first rank only.
  void collect_contacts() const;
  /// As Simulation::keep(), of arrays that are computed on demand.
  std::shared_ptr<const void> keep(WorldArray array);

  double time() const override { return state_.time.time; }
  std::uint64_t step() const override { return state_.time.step; }
  double dt() const override { return state_.time.dt; }
  const std::string& stage() const override { return state_.stage; }
  std::span<const std::uint32_t> ids() const override { return bodies().id; }
  std::span<const Row> positions() const override { return {bodies().position.data(), count()}; }
  std::span<const Row> velocities() const override { return {bodies().velocity.data(), count()}; }
  std::span<const Row> spins() const override { return {bodies().spin.data(), count()}; }
  std::span<const std::uint8_t> materials() const override { return {bodies().material.data(), count()}; }
  std::span<const std::string> material_names() const override { return state_.materials; }
  std::span<const BodyGroup> groups() const override { return state_.bodies.groups; }
  std::span<const Vec3> rotations() const override { return bodies().rotation; }
  std::span<const Vec3> displacements() const override;
  std::span<const std::uint32_t> clump_of() const override;
  std::span<const ClumpView> clumps() const override;
  std::span<const Vec3> arms() const override;
  std::span<const double> volume_fractions() const override { return state_.bodies.clumps.volume_fraction; }
  std::span<const double> unscaled_shares() const override;
  std::span<const std::uint8_t> held() const override;
  std::span<const Departure> departures() const override { return state_.departures; }
  std::span<const Row> forces() const override;
  std::span<const Row> moments() const override;
  std::span<const Contact> contacts() const override;
  std::span<const Contact> contacts_with_walls() const override;
  double mean_contact_force() const override;
  std::span<const WallView> walls() const override;
  std::optional<Clearance> clearance(std::size_t wall, const Vec3& point, double reach) const override;
  const Cell& cell() const override { return state_.cell.cell(); }
  Region specimen() const override;
  Region envelope() const override;
  Region interior(double margin) const override;
  double mean_diameter() const override { return state_.statistics.mean_diameter; }
  double solid_density() const override { return state_.statistics.solid_density; }
  Energies energies() const override;

 private:
  static constexpr std::uint64_t never = ~0ull;
  std::size_t count() const { return state_.bodies.count(); }
  /// With those of other ranks up to date.
  const Bodies& bodies() const {
    complete_bodies(state_, passes_);
    return state_.bodies;
  }
  void find_net_forces(std::size_t chunk) const;
  /// `join(list)`: the lists of ranks one after the other.
  template <class Join>
  void find_contacts(Join join) const;

  State& state_;
  Passes& passes_;
  EnergyBalance* balance_ = nullptr;

  mutable std::vector<Row> net_force_, net_moment_;
  mutable std::vector<std::uint32_t> clump_of_;
  mutable std::vector<std::uint8_t> held_;
  mutable std::vector<ClumpView> clumps_;
  mutable std::vector<Vec3> arms_, displacements_;
  mutable std::vector<double> unscaled_shares_;
  mutable std::vector<Contact> contacts_, wall_contacts_;
  mutable std::vector<WallView> walls_;
  // Step at which each was computed.
  mutable std::uint64_t net_step_ = never, contact_step_ = never, wall_contact_step_ = never, wall_step_ = never,
                        clump_step_ = never, displacement_step_ = never, held_step_ = never;
  mutable std::uint64_t collected_step_ = never;  // that of contacts on the first rank only
};

}  // namespace grit
