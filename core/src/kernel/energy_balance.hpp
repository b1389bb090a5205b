// Energy balance: stored energies, work and dissipation.
#pragma once

#include "grit/world.hpp"
#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Energies of a state, and the balance of work and dissipation since a component first requested it. Until then the
/// balance costs nothing. All energies in J, all powers in W.
class EnergyBalance {
 public:
  EnergyBalance(const State& state, const World& world, Passes& passes)
      : state_(state), world_(world), passes_(passes) {}

  /// Elastic energy of contacts with bodies `factor` times as large.
  ElasticEnergy elastic(double factor = 1) const;
  /// Kinetic energy at the present instant, from the velocities of half a step ago and the present forces.
  double kinetic() const;
  double gravitational() const;
  /// Power of the walls, from the forces on them and their last velocities.
  double power_of_walls() const;
  /// All terms. The first call starts the balance.
  Energies terms();

  bool begun() const { return flows_.begun; }
  /// Whether the balance has started.
  bool is_kept() const { return state_.bodies.energies() && flows_.begun; }
  double dissipated_by_dashpots() const { return flows_.lost.viscosity; }

  /// Runs `change`, which changes settings, and books the change of elastic or kinetic energy as work of settings.
  template <class Change>
  void book_elastic(Change change) {
    const double before = flows_.begun ? elastic().total() : 0;
    change();
    if (flows_.begun) flows_.settings += elastic().total() - before;
  }
  void add_settings(double energy) {
    if (flows_.begun) flows_.settings += energy;
  }
  void add_cell(double energy) {
    if (flows_.begun) flows_.cell += energy;
  }
  /// Work of settings less all stored energy: used to book the energy of bodies that enter.
  double settings_less_stored();
  void set_settings_less_stored(double value);

  /// After an evaluation, while contacts across periodic boundaries are available.
  void find_crossing();
  void add_losses();
  /// Before bodies grow by the factor exp(grown) in this step.
  void before_growth(double grown);
  bool has_growth() const { return flows_.grown > 0; }
  /// Work of engines and of the cell in a step: half by the forces at its start, half by those at its end. Call before
  /// and after bodies move.
  void before_motion(const MotionStep& step);
  void after_motion(const MotionStep& step);
  /// After walls were driven: `work` of the walls in the step, and the energies of the motion by chunks.
  void add_step(double work_of_walls);

  void serialize(Archive& archive);

 private:
  struct Flows {
    bool begun = false;
    double at_start = 0;
    Losses lost;
    double damped = 0, fallen = 0;
    double walls = 0, cell = 0, engines = 0;  // without half of the last step
    double settings = 0;                      // without half of the growth in the last step
    double grown = 0;                         // logarithm of that
  };
  ElasticEnergy elastic(std::size_t chunk, double factor) const;
  /// Change of elastic energy with the logarithm of the growth factor.
  double elastic_by_growth() const;
  double power_of_engines(std::size_t chunk) const;
  double power_of_engines() const;
  /// With the rates of periods and tilt in the last step, or with these [m/s].
  double power_of_cell() const;
  double power_of_cell(const Vec3& growth, const Vec3& tilt_growth) const;
  double power_of_flow() const;

  const State& state_;
  const World& world_;
  Passes& passes_;
  Flows flows_;
  double engines_in_step_ = 0, cell_in_step_ = 0;
  /// Sum over contacts across periodic boundaries: components of the force on the far end in rows, periods along each
  /// axis in columns [N].
  Mat3 crossing_ = Mat3::Zero();
};

}  // namespace grit
