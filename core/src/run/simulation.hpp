// The world while it moves: forces at an instant, then a step.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "contact/contact_table.hpp"
#include "contact/critical_step.hpp"
#include "contact/readiness.hpp"
#include "contact/search.hpp"
#include "contact/skins.hpp"
#include "contact/team.hpp"
#include "contact/wall_contacts.hpp"
#include "engines/motion.hpp"
#include "engines/walls.hpp"
#include "grit/memory.hpp"
#include "grit/world.hpp"
#include "run/recorder.hpp"
#include "run/stopwatch.hpp"
#include "scene/bodies.hpp"
#include "scene/description.hpp"
#include "scene/make_bodies.hpp"

namespace grit {

/// Everything that goes from one step to the next, apart from bodies, contacts and walls, which keep their own.
struct Clock {
  double time = 0;  ///< s
  std::uint64_t step = 0;
  double time_step = 0;       ///< of the next step, s
  double last_time_step = 0;  ///< of the one before; 0 at the start
  double critical_time_step = 0;
  Demand contact_demand, wall_demand;  ///< that it follows from
  std::uint64_t forces_step = ~0ull;   ///< at which contacts were last brought up to date
  Cell cell;
  Vec3 period_before = Vec3::Zero();  ///< of the cell, one step ago
  std::uint64_t rebuilds = 0;
  Skins skins;               ///< of the present candidates
  double strain_travel = 0;  ///< what the mean flow of the cell, and growth, brought two surfaces closer since the last
                             ///< search, at most [m]
  double wall_speed = 0;     ///< of the fastest point of a wall near bodies, at most, in the last step [m/s]
  double wall_closing = 0;   ///< the same, but for flat walls that slide along themselves
  double last_approach = 0;  ///< by how much the last step let bodies come closer at most, m
  double overlap = 0;        ///< largest one over a radius
  double pressed_overlap = 0;  ///< the largest when the time step was set, or until which springs are soft; only where
                               ///< springs stiffen
  double stepped_overlap = 0;  ///< the one that the time step was set for; only where springs stiffen
  double stepped_speed = 0;    ///< at which something may come closer before it must be set anew [m/s]; the same

  bool cell_deforms() const { return !cell.strain_rate.isZero(0.0); }
  /// How fast the cell's periods change, half a step ago as the velocities; 0 along axes that are not periodic [m/s].
  Vec3 growth_of_period() const;

  void remember(Memory& memory);
};

/// Energies and work, for the guard against energy from nowhere.
struct EnergyBook {
  bool begins = true;          ///< at the next forces
  std::uint64_t first = 0;     ///< step at which it began
  double stored_at_start = 0;  ///< J, kinetic, elastic and gravitational, when the present settings began
  double work = 0;             ///< J, done by walls since then, but for half of the last step
  double largest = 0;          ///< J, largest kinetic and elastic energy since then
  double closure_at_start = 0, dissipated_at_start = 0;  ///< J, of a ledger that was kept then

  void remember(Memory& memory) {
    memory(begins, first, stored_at_start, work, largest, closure_at_start, dissipated_at_start);
  }
};

/// What has gone in and out since a component first asked [J].
struct EnergyFlows {
  bool begun = false;
  double at_start = 0;
  Losses lost;
  double damped = 0, fallen = 0;
  double walls = 0, cell = 0, engines = 0;  ///< but for half of the last step
  double settings = 0;                      ///< but for half of what bodies grew by in the last step
  double grown = 0;                         ///< logarithm of that

  void remember(Memory& memory) {
    memory(begun, at_start, lost.friction, lost.rolling, lost.viscosity, damped, fallen, walls, cell, engines, settings,
           grown);
  }
};

/// What is known of all bodies that have come.
struct Stock {
  std::size_t grains = 0;                          ///< spheres by themselves and clumps
  double mass = 0, diameters = 0, solids = 0;      ///< of grains, summed up: kg, m, m³
  double mean_diameter = 0, solid_density = 0;     ///< that follow: m, kg/m³
  double largest_radius = 0, smallest_radius = 0;  ///< of spheres, m
  double heaviest = 0;                             ///< of all that a sphere moves, its mass over its radius³, kg/m³
  bool one_material = true;

  void remember(Memory& memory) {
    memory(grains, mass, diameters, solids, mean_diameter, solid_density, largest_radius, smallest_radius, heaviest,
           one_material);
  }
};

class Simulation final : public World {
 public:
  /// Bodies as made for this scene; `state` is what its components ask for.
  Simulation(const SceneDescription& scene, Bodies bodies, unsigned threads);

  /// Begins a stage with the settings of `scene`, which has the same materials, walls and bodies as the first, and lets
  /// the bodies in that appear in it. Throws NumericsError where they cannot: no room, or deeper in others or in walls
  /// than they may; then they are not there.
  void begin_stage(const std::string& name, const SceneDescription& scene);
  /// Has guards look that look but now and then, at forces of this instant. Throws NumericsError if one trips.
  void end_stage();
  /// Changes settings within a stage.
  void change(const SceneDescription& scene);
  /// Saves all that there is, between two steps.
  void save(Memory& memory);
  /// Goes on, to the same bits, where a simulation of the same scene was saved, `scene` being its settings then.
  void restore(const SceneDescription& scene, Memory& memory);

  /// Has find_forces() look for neighbours anew, whether or not it is due.
  void search_next() { search_now_ = true; }
  /// Forces at time(), searching neighbours first if need be. Throws NumericsError if a guard trips.
  void find_forces();
  /// One step; find_forces() must have been called at this instant. Throws NumericsError if a guard trips.
  void advance();
  /// find_forces() and advance(), to the same bits, in one pass over the bodies where nothing else hinders it. Nobody
  /// may ask for forces until find_forces() is called again; contacts remember theirs. Throws NumericsError if a guard
  /// trips, and has the forces of where it stopped.
  void step_on();

  /// Kinetic over elastic energy; infinite where nothing is stored.
  double kinetic_energy_ratio() const;

  const Clock& clock() const { return clock_; }
  unsigned threads() const { return team_.threads(); }
  std::size_t pair_count() const { return pairs_.touching_count(); }
  /// Share of all mass that has come that has left.
  double share_left() const { return stock_.mass > 0 ? mass_left_ / stock_.mass : 0; }
  std::size_t candidate_count() const { return pairs_.candidates(); }
  std::vector<PhaseTime> phases() const;
  const Walls& wall_states() const { return walls_; }
  Model model() const;
  /// Steps of bodies, summed over all.
  double body_steps() const { return body_steps_; }
  /// Bytes held by bodies and contacts.
  std::size_t memory() const;
  const WallContacts& wall_contacts() const { return wall_contacts_; }
  const ContactTable& pairs() const { return pairs_; }

  // World
  double time() const override { return clock_.time; }
  std::uint64_t step() const override { return clock_.step; }
  double dt() const override { return clock_.time_step; }
  const std::string& stage() const override { return stage_; }
  std::span<const std::uint32_t> ids() const override { return bodies_.id; }
  std::span<const Row> positions() const override { return {bodies_.position.data(), bodies_.count()}; }
  std::span<const Row> velocities() const override { return {bodies_.velocity.data(), bodies_.count()}; }
  std::span<const Row> spins() const override { return {bodies_.spin.data(), bodies_.count()}; }
  std::span<const std::uint8_t> materials() const override { return {bodies_.material.data(), bodies_.count()}; }
  std::span<const Vec3> rotations() const override { return bodies_.rotation; }
  std::span<const Vec3> displacements() const override;
  std::span<const std::uint32_t> clump_of() const override;
  std::span<const ClumpView> clumps() const override;
  std::span<const Vec3> arms() const override;
  std::span<const double> volume_shares() const override { return bodies_.clumps.volume_share; }
  std::span<const Departure> departures() const override { return departures_; }
  std::span<const Row> forces() const override;
  std::span<const Row> moments() const override;
  std::span<const Contact> contacts() const override;
  std::span<const Contact> contacts_with_walls() const override;
  double mean_contact_force() const override;
  std::span<const WallView> walls() const override;
  std::optional<Clearance> clearance(std::size_t wall, const Vec3& point, double reach) const override;
  const Cell& cell() const override { return clock_.cell; }
  Region specimen() const override { return region(0); }
  Region envelope() const override { return region(0, Side::far); }
  Region interior(double margin) const override { return region(margin); }
  double mean_diameter() const override { return stock_.mean_diameter; }
  double solid_density() const override { return stock_.solid_density; }
  EnergyLedger energies() const override;

 private:
  enum Part { searching, pair_contacts, wall_touches, motion, part_count };

  void apply(const SceneDescription& scene);
  /// What of a scene is not in the memory.
  void take_settings(const SceneDescription& scene);
  void remember(Memory& memory);
  /// Lets bodies in that appear in this stage.
  void admit();
  /// Reckons with bodies that have come, from this one on, and from this clump on.
  void take_stock(std::size_t first, std::size_t first_clump);
  /// Throws for newcomers that overlap others or walls by more than they may.
  void check_newcomers() const;
  ContactTable::Instant instant(bool again) const {
    return {*law_, bodies_, stock_.one_material, shifts_.data(), clock_.last_time_step, clock_.skins, again};
  }
  /// All that comes before the contacts. Returns whether this instant has been evaluated before.
  bool prepare();
  /// Shares work(chunk, laps) among the threads.
  template <class Work>
  void pass(Work work);
  /// Contacts of one chunk with others and with walls.
  void evaluate(std::size_t chunk, bool again, BodySum* sum, Laps& laps);
  void move(std::size_t chunk, const BodySum* sum, const MotionStep& step);
  void sum_forces(bool again);
  /// What the chunks found, for walls and guards.
  void take_loads();
  bool in_one_pass() const;
  bool springs_stiffen() const { return std::isfinite(soft_until_); }
  /// Whether springs at this overlap, or after an impact at the present speeds, are so much stiffer than those that the
  /// time step was set for that it must be set anew.
  bool stiffer_than_stepped(double overlap) const;
  bool springs_may_stiffen() const;
  /// What to set the time step for.
  void expect_overlap();
  /// At which two surfaces came closer in the last step, at most [m/s].
  double closing_speed() const;
  /// The least speed [m/s] whose impact goes so deep, in radii.
  double speed_of_impact(double overlap) const;
  /// Of two like bodies of the smallest radius, or of one and a wall, normal, at this overlap in radii [N/m].
  double stiffness_of_smallest(std::size_t a, std::size_t b, bool wall, double overlap) const;
  /// In radii; infinite where springs do not stiffen.
  double overlap_of_soft_springs() const;
  MotionStep next_motion() const;
  /// All that comes after the motion of bodies.
  void end_step();
  /// Does what may find that the run has failed; then forces are those of where the bodies are.
  template <class Work>
  void and_show_forces(Work work);
  void show_forces();
  bool search_is_due();
  void lay_on_skins();
  void search();
  /// Puts bodies back into the periodic cell. Returns which have left through an open side.
  std::vector<bool> wrap();
  bool may_leave(int axis, bool high) const;
  void take_leave(const std::vector<bool>& leaves);
  /// Per second, of radii; 0 where bodies of that stage do not grow.
  double growth_rate_of(const std::string& stage) const;
  /// Lets bodies grow for the step that comes.
  void grow();
  /// Stops what moves out of a plane.
  void flatten(int axis);
  /// For what contacts ask now.
  void set_time_step();
  void choose_time_step(const Demand& contacts);
  CriticalStep::Instant near_contacts() const;
  void update_shifts();
  void update_surfaces();
  void check_overlap(double largest) const;
  void check_periods() const;
  /// Only gains trip. By the ledger where one is kept, else by what is stored, so that what is dissipated hides what
  /// appears. Without a ledger it does not look where work is done that is not reckoned at each step.
  void check_energy();
  bool energy_check_is_due() const;
  /// part(chunk), summed up one chunk after the other, worked out by all threads.
  template <class Part>
  auto sum_of_chunks(Part part) const;
  /// Of springs of a chunk as they stand, with bodies `factor` times as large.
  ElasticEnergy elastic_energy(std::size_t chunk, double factor) const;
  ElasticEnergy elastic_energy(double factor = 1) const;  ///< of all
  /// What springs take up for the logarithm of what bodies grow by [J].
  double elastic_by_growth() const;
  /// At time(), by the forces that act there.
  double kinetic_energy() const;
  double gravitational() const;
  /// What walls do by the forces on them as they moved last [W].
  double power_of_walls() const;
  bool bodies_are_held() const { return settings_.hold_rotation || settings_.hold_translation; }
  bool engines_do_work() const { return !force_engines_.empty() || bodies_are_held(); }
  /// What engines do to the bodies of a chunk, and to as many clumps, by the forces on them as they moved last [W].
  double power_of_engines(std::size_t chunk) const;
  double power_of_engines() const;  ///< of all
  /// What contacts take up as the cell's periods grow so fast [W].
  double power_of_cell(const Vec3& growth) const { return -crossing_.dot(growth); }
  /// What has bodies go with the mean flow of a deforming cell [W].
  double power_of_flow() const;
  void find_crossing();
  /// Which side of the surfaces of walls that bodies are not inside of the specimen ends at.
  enum class Side { near, far };
  Region region(double margin, Side side_of_walls = Side::near) const;
  void tell_walls_of_specimen();
  Vec3 centre() const { return 0.5 * (clock_.cell.low + clock_.cell.high); }
  /// Has what probes ask for be worked out anew.
  void forget_views() {
    net_step_ = contact_step_ = wall_contact_step_ = wall_step_ = clump_step_ = displacement_step_ = ~0ull;
  }
  /// `what` ends with advice.
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail(const std::string& what, const std::string& advice) const;
  [[noreturn]] void fail_at_body(std::size_t body, const std::string& what, const std::string& advice) const;

  const SceneDescription* scene_ = nullptr;  // the present settings; owned by the plan of the run
  std::shared_ptr<ContactLaw> law_;
  std::vector<StateField> fields_;
  std::vector<std::shared_ptr<Engine>> force_engines_;
  MotionSettings settings_;
  std::vector<std::string> material_names_;
  std::string stage_;

  mutable Team team_;  // what is asked for is shared among the threads too
  Clock clock_;
  EnergyBook energy_;
  mutable EnergyFlows flows_;
  Bodies bodies_;
  ContactTable pairs_;
  WallContacts wall_contacts_;
  Walls walls_;
  NeighbourSearch search_;
  CriticalStep critical_;

  LargeArray<BodySum> sum_;
  std::vector<Row> added_force_, added_moment_;  // by engines; empty without any
  /// Along each axis, of all that reaches over its periodic boundary, by how many periods and with what force on the
  /// far end [N]. Only where a ledger is asked for and the cell deforms.
  Vec3 crossing_ = Vec3::Zero();
  LargeArray<Row> reference_;  // positions at the last search
  Cell reference_cell_;
  std::vector<ImageShift> shifts_;
  std::vector<WallSurface> surfaces_;
  std::vector<WallLoad> loads_;
  std::vector<double>
      arms_;  // of walls that spin: how far from its reference point bodies reached at the last search [m]
  /// What was found of a chunk, and the time it took where that was taken.
  struct alignas(64) Chunk {
    double overlap = 0;
    Losses losses;
    Motion motion, clumps;
    Vec3 crossing = Vec3::Zero();
    bool moved = false;
    std::array<double, part_count> seconds{};
  };
  std::vector<Chunk> chunk_;
  Readiness readiness_;
  std::vector<std::size_t> late_;  // chunks that could not move at once
  std::vector<PhaseTime> phases_;
  std::vector<Departure> departures_;
  std::vector<Newcomers::Group> newcomers_;  // since the last search, with their first ids
  Stock stock_;
  double mass_left_ = 0;    // kg, of departures
  double growth_rate_ = 0;  // 1/s, of radii in this stage
  double grown_ = 0;        // m, by how much surfaces have moved in this step because bodies grow, at most
  double body_steps_ = 0;
  double passes_ = 0;  // s, in which the threads shared chunks
  bool periodic_ = false, search_now_ = true, time_step_now_ = true;
  double soft_until_ = 0;  // overlap, in radii, up to which springs do not stiffen

  // What probes ask for, worked out at most once an instant.
  mutable std::vector<Row> net_force_, net_moment_;
  mutable std::vector<std::uint32_t> clump_of_;
  mutable std::vector<ClumpView> clump_views_;
  mutable std::vector<Vec3> arms_of_bodies_, displacements_;
  mutable std::uint64_t clump_step_ = ~0ull, displacement_step_ = ~0ull;
  mutable std::vector<Contact> contact_list_, wall_contact_list_;
  mutable std::vector<WallView> wall_views_;
  mutable std::uint64_t net_step_ = ~0ull, contact_step_ = ~0ull, wall_contact_step_ = ~0ull, wall_step_ = ~0ull;
};

}  // namespace grit
