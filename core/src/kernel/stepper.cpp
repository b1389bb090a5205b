#include "kernel/stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "contact/migration.hpp"
#include "domain/boundaries.hpp"
#include "kernel/arrivals.hpp"
#include "kernel/body_groups.hpp"
#include "kernel/completion.hpp"
#include "kernel/device_obstacles.hpp"
#include "kernel/failure.hpp"
#include "kernel/guards.hpp"
#include "kernel/periodic_walls.hpp"
#include "kernel/specimen.hpp"
#include "motion/clump_motion.hpp"
#include "motion/growth.hpp"

namespace grit {

void Stepper::settings_changed() {
  loads_.resize(state_.walls.size());
  bounds_.reset_walls(state_.walls.size());
  bounds_.grown(0);
  if (state_.device) state_.device->request();
  time_step_.request();
  time_step_.update_stiffening(state_);
}

void Stepper::update_surfaces() {
  for (std::size_t w = 0; w < state_.surfaces.size(); ++w) {
    const WallState& wall = state_.walls.states()[w];
    state_.surfaces[w].pose = wall.pose;
    state_.surfaces[w].velocity = wall.velocity, state_.surfaces[w].spin = wall.spin;
    state_.surfaces[w].surface_moves = state_.walls.surface_moves(w);
    state_.surfaces[w].surface_velocity = wall.surface_velocity, state_.surfaces[w].surface_spin = wall.surface_spin;
  }
}

void Stepper::mark_removed(std::vector<bool>& leaves) const {
  const Bodies& bodies = state_.bodies;
  for (const ActingEngine& one : state_.settings.removal_engines)
    for (std::size_t i = 0; i < bodies.count(); ++i) {
      if (!one.groups.empty() && !one.groups[state_.group[i]]) continue;
      const std::uint32_t c = bodies.clumps.clump_of(i);
      const Vec3 centre = c == no_clump ? xyz(bodies.position[i]) : bodies.clumps.clump[c].centre;
      if (one.engine->removes(view_, centre)) leaves[i] = true;
    }
}

bool Stepper::rebuilds_whole() const {
  return !passes_.ranks().several() || state_.pairs.is_whole() || !state_.bodies.clumps.none() || !arrivals_.empty() ||
         !state_.settings.removal_engines.empty();
}

std::vector<bool> Stepper::wrap_bodies(bool whole) {
  Ranks& ranks = passes_.ranks();
  state_.complete.bodies = whole;
  Wrapped wrapped =
      wrap(state_.bodies, whole ? 0 : ranks.first(), whole ? passes_.chunks().size() : ranks.last(), state_.cell.cell(),
           state_.cell.image_velocities(state_.time.previous_dt), state_.settings.open_sides, passes_.team());
  std::vector<Escape> escapes(wrapped.escaped ? 1 : 0, wrapped.escaped.value_or(Escape{}));
  if (!whole) escapes = ranks.all(escapes), wrapped.gained = ranks.all(wrapped.gained);
  if (!escapes.empty()) {
    const auto [body, axis, high] = escapes.front();
    complete_bodies(state_, passes_);
    fail_at_body(state_, Guard::domain, group_keys(state_, body), body,
                 "left the domain through its " + std::string(high ? "upper" : "lower") + " " + "xyz"[axis] + " side",
                 "close the domain there with a wall, make it larger, or name the side in /domain/open_sides");
  }
  balance_.add_cell(std::accumulate(wrapped.gained.begin(), wrapped.gained.end(), 0.0));
  return std::move(wrapped.leaves);
}

void Stepper::discharge(const std::vector<bool>& leaves, bool whole) {
  std::vector<Leaving> all =
      leaving(state_.bodies, leaves, state_.time.time,
              [this](std::size_t body) -> const MotionSettings& { return state_.motion_of(body); });
  if (!whole) {
    all = passes_.ranks().all(all);
    std::ranges::sort(all, {}, [](const Leaving& one) { return one.departure.id; });
  }
  for (Leaving& one : all) {
    state_.departures.push_back(one.departure);
    state_.discharged_mass += one.departure.mass;
    balance_.add_settings(-one.kinetic);
    guard_.discharged(one.kinetic + one.potential);
  }
}

Renumbering Stepper::sort_bodies(const std::vector<bool>& leaves, bool some_leave, bool whole) {
  Bodies& bodies = state_.bodies;
  Ranks& ranks = passes_.ranks();
  Renumbering now;
  if (whole) {
    std::vector<std::uint32_t> order = spatial_order(bodies, state_.cell.cell(), passes_.team());
    if (some_leave) discharge(leaves, whole), std::erase_if(order, [&](std::uint32_t i) { return leaves[i]; });
    now = Renumbering(order, bodies.count());
    bodies.reorder(order, passes_.team());
    passes_.resize(bodies.count());
    passes_.divide();
  } else {
    Migration migration(bodies, leaves, state_.cell.cell(), ranks, passes_.team());
    if (some_leave) discharge(leaves, whole);
    passes_.resize(migration.count());
    passes_.divide();
    now = migration.move(bodies, ranks);
    state_.halo.exchange(now, ranks);
    state_.complete.identities = false;
  }
  find_groups(state_);
  state_.sum.resize(bodies.count() + 1);
  return now;
}

void Stepper::rebuild() {
  Ranks& ranks = passes_.ranks();
  sharing_.steps_end(ranks, state_.time.step);
  check_periods(state_);
  repeat_walls(state_);
  const bool whole = rebuilds_whole();
  if (whole) complete_bodies(state_, passes_);
  Bodies& bodies = state_.bodies;
  DeformingCell& cell = state_.cell;
  if (const Eigen::Matrix3i moved = cell.reduce_tilt(); !moved.isIdentity()) {
    change_periods(bodies, moved);
    cell.update_images(state_.time.previous_dt);
  }
  std::vector<bool> leaves = wrap_bodies(whole);
  mark_removed(leaves);
  if (!arrivals_.empty()) check_arrivals(state_, view_, arrivals_);
  const bool leaves_here = std::ranges::find(leaves, true) != leaves.end();
  const bool some_leave = whole ? leaves_here : ranks.any(leaves_here);
  Renumbering now;
  if (state_.lists.sorts() || some_leave || !arrivals_.empty()) now = sort_bodies(leaves, some_leave, whole);
  state_.lists.rebuild(bodies, cell, state_.statistics, state_.reaches(), state_.time.dt, bounds_.wall_speed(),
                       passes_);
  state_.pairs.rebuild(bodies, state_.lists.search(), cell.periodic(), state_.settings.fields, now,
                       state_.lists.surroundings().boxes(), ranks, passes_.team());
  state_.lists.compare_velocities(state_.pairs.reached(), ranks);
  state_.halo.build(state_.pairs, ranks);
  readiness_.build(state_.pairs.reached());
  state_.wall_contacts.rebuild(bodies, state_.group, state_.surfaces, state_.lists.skins(), state_.settings.fields, now,
                               ranks, passes_.team());
  bounds_.rebuild(state_, passes_);
  arrivals_.clear();
  view_.invalidate();  // engines may have read bodies in their former order
  time_step_.search_ends(state_, view_, bounds_, passes_);
  sharing_.search_ends(ranks, state_.halo, bodies.count());
  if (state_.device) state_.device->request();
}

void Stepper::collect_sharing() {
  sharing_.steps_end(passes_.ranks(), state_.time.step);
  passes_.collect_times();
}

void Stepper::search_at_walls() {
  repeat_walls(state_);
  state_.lists.begin_search_at_walls(state_.cell, state_.statistics, state_.time.dt, bounds_.wall_speed());
  passes_.each_own([&](std::size_t chunk) {
    state_.wall_contacts.find_candidates(chunk, state_.bodies, state_.group, state_.surfaces, state_.lists.skins());
  });
  bounds_.rebuild(state_, passes_);
}

void Stepper::follow_bodies() {
  Ranks& ranks = passes_.ranks();
  bool search = state_.lists.requested(), renew = false;
  if (!search) {
    const bool at_walls = state_.lists.due_at_walls();
    const auto [may_search, may_renew] =
        ranks.any(std::array{state_.lists.may_be_due(ranks), !at_walls && time_step_.due(state_, passes_)});
    if (may_search) fetch_bodies(state_, passes_);
    search = may_search && state_.lists.due(state_.bodies, state_.cell, ranks), renew = may_renew;
    if (!search && at_walls) {
      search_at_walls();
      renew = ranks.any(time_step_.due(state_, passes_));
    }
  }
  if (search || renew || time_step_.requested()) {
    take_halo(state_, passes_);
    fetch_from_device();
  }
  if (search) rebuild();
  else time_step_.follow(renew, state_, view_, bounds_, passes_);
}

void Stepper::prepare() {
  view_.invalidate();
  state_.cell.update_images(state_.time.previous_dt);
  update_surfaces();
  {
    const PhaseWatch watch = passes_.watch(StepPhase::search);
    follow_bodies();
  }
  state_.complete.sums = !passes_.ranks().several();
}

bool Stepper::evaluated_before() { return std::exchange(forces_step_, state_.time.step) == state_.time.step; }

void Stepper::evaluate_within(std::size_t chunk, bool again, BodySum* sum, Laps& laps) {
  const ChunkRange range(chunk, state_.bodies.count());
  std::fill(sum + range.first, sum + range.last, BodySum{});
  if (!passes_.ranks().owns(chunk)) return;  // has no such pairs here
  ChunkResult& own = passes_.chunks()[chunk];
  own.losses = {};
  own.overlap = state_.pairs.evaluate(ContactTable::Kind::within, chunk, state_.instant(again), sum,
                                      balance_.is_kept() ? &own.losses : nullptr);
  laps(own.time_of(StepPhase::contacts));
}

void Stepper::evaluate_across(std::size_t chunk, bool again, BodySum* sum, Laps& laps) {
  ChunkResult& own = passes_.chunks()[chunk];
  const bool owned = passes_.ranks().owns(chunk);
  Losses* const losses = owned && balance_.is_kept() ? &own.losses : nullptr;
  const double overlap = state_.pairs.evaluate(ContactTable::Kind::across, chunk, state_.instant(again), sum, losses);
  laps(own.time_of(StepPhase::contacts));
  if (!owned) return;
  own.overlap = std::max(own.overlap, overlap);
  if (state_.surfaces.empty()) return;
  own.overlap = std::max(own.overlap, state_.wall_contacts.evaluate(chunk, *state_.settings.law, state_.bodies,
                                                                    state_.statistics.one_material, state_.surfaces,
                                                                    state_.time.previous_dt, again, sum, losses));
  laps(own.time_of(StepPhase::walls));
}

void Stepper::move(std::size_t chunk, const BodySum* sum, const MotionStep& step) {
  ChunkResult& own = passes_.chunks()[chunk];
  own.motion = move_bodies(chunk, state_.bodies, sum, step);
  own.relative_speed = state_.lists.skins().relative_speed(chunk, own.motion.velocities);
}

void Stepper::sum_forces(bool again) {
  take_halo(state_, passes_);
  BodySum* const sum = state_.sum.data();
  passes_.each(state_.time.step, state_.pairs.evaluated(), [&](std::size_t chunk, Laps& laps) {
    evaluate_within(chunk, again, sum, laps), evaluate_across(chunk, again, sum, laps);
  });
  passes_.each(state_.time.step, [&](std::size_t chunk, Laps& laps) {
    state_.pairs.gather(chunk, sum);
    laps(passes_.chunks()[chunk].time_of(StepPhase::motion));
  });
}

/// Throws for the first body whose force or moment is not finite since `one` added to it.
void Stepper::check_finite(const ActingEngine& one, std::span<const Row> force, std::span<const Row> moment) const {
  // 0 times infinity is not a number.
  double nothing = 0;
  for (std::size_t i = 0; i < force.size(); ++i)
    nothing += 0 * (force[i].x + force[i].y + force[i].z + moment[i].x + moment[i].y + moment[i].z);
  if (nothing == 0) return;
  std::string name;
  for (const auto& [known, engine] : state_.settings.engines)
    if (engine.get() == one.engine) name = known;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (const bool pushes = xyz(force[i]).allFinite(); !pushes || !xyz(moment[i]).allFinite())
      fail_at_body(
          state_, Guard::finite, {"engines", name}, i,
          std::string("gets a ") + (pushes ? "moment" : "force") + " of the engine \"" + name + "\" that is not finite",
          "this engine needs a finite value wherever bodies are, at every velocity and time");
}

void Stepper::add_forces_of_engines() {
  state_.added_force.clear(), state_.added_moment.clear();
  if (state_.settings.force_engines.empty()) return;
  const std::size_t count = state_.bodies.count();
  std::vector<Row> force(count), moment(count);
  for (const ActingEngine& one : state_.settings.force_engines) {
    if (one.groups.empty()) {
      one.engine->forces(view_, force, moment);
    } else {
      std::vector<Row> own_force(count), own_moment(count);
      one.engine->forces(view_, own_force, own_moment);
      for (std::size_t i = 0; i < count; ++i)
        if (one.groups[state_.group[i]]) force[i] += own_force[i], moment[i] += own_moment[i];
    }
    check_finite(one, force, moment);
  }
  for (std::size_t i = 0; i < count; ++i) state_.sum[i].force += force[i], state_.sum[i].moment += moment[i];
  state_.added_force.swap(force), state_.added_moment.swap(moment);
  view_.invalidate_forces();  // engines may have read forces without their own
}

void Stepper::find_extremes() {
  passes_.find_extremes(state_.lists.furthest_here(passes_, state_.time.dt), balance_.is_kept());
}

void Stepper::take_loads(bool for_time_step) {
  find_extremes();
  if (passes_.extremes().overlap > state_.settings.guards.overlap) fetch_from_device();  // for the report
  if (!state_.surfaces.empty()) {
    state_.wall_contacts.loads(loads_, passes_.ranks());
    state_.walls.clear_forces();
    for (std::size_t w = 0; w < loads_.size(); ++w) state_.walls.add(w, loads_[w]);
  }
  state_.overlap = passes_.extremes().overlap;
  for (std::size_t chunk = passes_.ranks().first(); for_time_step && chunk < passes_.ranks().last(); ++chunk)
    time_step_.touched(chunk, passes_.chunks()[chunk].overlap);
  balance_.add_losses();
  check_overlap(state_, view_);
}

void Stepper::find_forces() {
  const bool may_stiffen = time_step_.may_stiffen(state_, bounds_);
  fetch_from_device();
  prepare();
  send_to_device();  // before histories advance here
  sum_forces(evaluated_before());
  add_forces_of_engines();
  balance_.find_crossing();
  take_loads(!state_.device || may_stiffen);  // the step of bodies on a device follows from what it finds itself
  time_step_.react(may_stiffen, state_, view_, bounds_, passes_);
  if (guard_.due(state_.time.step)) guard_.check(state_, balance_);
}

template <class Work>
void Stepper::and_show_forces(Work work) {
  try {
    work();
  } catch (const NumericsError&) {
    show_forces();
    throw;
  }
}

void Stepper::grow() {
  const double grows = state_.settings.growth_rate * state_.time.dt;
  balance_.before_growth(grows);
  if (grows == 0 || state_.bodies.count() == 0) return;
  const double factor = std::exp(grows);
  double furthest = state_.statistics.largest_radius;
  for (const Clump& clump : state_.bodies.clumps.clump) furthest = std::max(furthest, clump.furthest);
  const double distance = (factor - 1) * (furthest + state_.lists.skins().reach());
  bounds_.grown(distance);
  check_growth(state_, distance);
  const double kinetic_before = balance_.begun() ? balance_.kinetic() : 0;
  {
    const PhaseWatch watch = passes_.watch(StepPhase::motion);
    passes_.team().each(passes_.chunks().size(), [&](std::size_t chunk) { grow_bodies(chunk, state_.bodies, factor); });
    grow_clumps(state_.bodies, factor);
    state_.wall_contacts.grow(state_.bodies, factor);
  }
  const double mass_before = state_.statistics.mass;
  state_.statistics.grow(factor, mass_before - state_.discharged_mass);
  view_.invalidate();
  balance_.add_settings((balance_.begun() ? balance_.kinetic() : 0) - kinetic_before);
}

void Stepper::move_clumps_of_chunks(const MotionStep& step) {
  const std::size_t clumps = state_.bodies.clumps.clump.size();
  if (clumps == 0) return;
  complete_sums(state_, passes_);
  passes_.each_on_all_ranks(state_.time.step, [&](std::size_t chunk, Laps& laps) {
    const ChunkRange range(chunk, clumps);
    ChunkResult& own = passes_.chunks()[chunk];
    own.clumps = move_clumps(range.first, range.last, state_.bodies, state_.sum.data(), step);
    laps(own.time_of(StepPhase::motion));
  });
}

void Stepper::drive_cell() {
  const PhaseWatch watch = passes_.watch(StepPhase::contacts);
  const CellRates rates = cell_servo_.rates(state_, passes_);
  const double kinetic_before = balance_.is_kept() ? balance_.kinetic() : 0;
  change_rates(state_, rates);
  view_.invalidate_forces();
  balance_.add_cell((balance_.is_kept() ? balance_.kinetic() : 0) - kinetic_before);
}

void Stepper::advance() {
  if (state_.device) return step_on_device();
  MotionStep step = state_.next_motion(balance_.is_kept());
  balance_.before_motion(step);
  if (CellServo::due(state_)) {
    drive_cell();
    step = state_.next_motion(balance_.is_kept());
  }
  if (state_.settings.growth_rate > 0 || balance_.has_growth()) grow();
  move_clumps_of_chunks(step);
  passes_.each(state_.time.step, [&](std::size_t chunk, Laps& laps) {
    move(chunk, state_.sum.data(), step);
    laps(passes_.chunks()[chunk].time_of(StepPhase::motion));
  });
  bodies_moved();
  find_extremes();
  balance_.after_motion(step);
  and_show_forces([this] { end_step(); });
}

/// Whether bodies may move before the forces on others are known: neither time step nor engines depend on all forces,
/// and the energy balance does not need the power of forces before and after the motion.
bool Stepper::can_move_at_once() const {
  const Settings& settings = state_.settings;
  const bool free_walls = std::ranges::any_of(state_.surfaces, &WallSurface::free);
  const bool power_of_forces = balance_.is_kept() && (state_.deforms() || settings.holds_bodies());
  return settings.growth_rate == 0 && !balance_.has_growth() && settings.force_engines.empty() &&
         state_.bodies.clumps.none() && !free_walls && !power_of_forces && !guard_.due(state_.time.step) &&
         !CellServo::due(state_) && !time_step_.may_stiffen(state_, bounds_);
}

void Stepper::step_on() {
  if (!can_move_at_once()) {
    find_forces();
    advance();
    return;
  }
  prepare();
  if (state_.device) return step_on_device();
  const bool again = evaluated_before();
  const MotionStep step = state_.next_motion(balance_.is_kept());
  readiness_.restart();
  const auto gather_and_move = [&](std::size_t chunk, BodySum* sum) {
    state_.pairs.gather(chunk, sum);
    move(chunk, sum, step);
  };
  // What needs no bodies of other ranks is evaluated while these are on their way.
  passes_.each(state_.time.step, [&](std::size_t chunk, Laps& laps) {
    ChunkResult& result = passes_.chunks()[chunk];
    result.moved = false;
    if (state_.pairs.is_shared(chunk)) return evaluate_within(chunk, again, state_.sum.data(), laps);
    // Sums of a chunk that moves at once stay in the cache. The pointer is offset so that it is indexed by body: its
    // start lies before the array, but only valid elements are accessed.
    alignas(64) thread_local std::array<BodySum, chunk_bodies> here;
    const ChunkRange range(chunk, state_.bodies.count());
    const std::uintptr_t of_body_0 = reinterpret_cast<std::uintptr_t>(here.data()) - range.first * sizeof(BodySum);
    BodySum* const own = reinterpret_cast<BodySum*>(of_body_0);
    evaluate_within(chunk, again, own, laps), evaluate_across(chunk, again, own, laps);
    result.moved = readiness_.evaluated(chunk);
    if (result.moved) gather_and_move(chunk, own);
    else std::copy(own + range.first, own + range.last, state_.sum.data() + range.first);
    laps(result.time_of(StepPhase::motion));
  });
  take_halo(state_, passes_);
  passes_.each(state_.time.step, state_.pairs.shared(), [&](std::size_t chunk, Laps& laps) {
    BodySum* const sum = state_.sum.data();
    if (!passes_.ranks().owns(chunk)) evaluate_within(chunk, again, sum, laps);
    evaluate_across(chunk, again, sum, laps);
    if (!readiness_.evaluated(chunk) || !passes_.ranks().owns(chunk)) return;
    ChunkResult& result = passes_.chunks()[chunk];
    gather_and_move(chunk, sum);
    result.moved = true;
    laps(result.time_of(StepPhase::motion));
  });
  late_.clear();
  for (std::size_t chunk = passes_.ranks().first(); chunk < passes_.ranks().last(); ++chunk)
    if (!passes_.chunks()[chunk].moved) late_.push_back(chunk);
  if (!late_.empty()) {
    const PhaseWatch watch = passes_.watch(StepPhase::motion);
    passes_.team().each(late_.size(), [&](std::size_t k) { gather_and_move(late_[k], state_.sum.data()); });
  }
  bodies_moved();
  and_show_forces([this] { take_loads(true), end_step(); });
}

void Stepper::fetch_from_device() {
  if (!device_is_ahead_) return;
  complete_bodies(state_, passes_);
  state_.device->fetch(state_.pairs);
  forces_step_ = never;
  device_is_ahead_ = false;
}

std::optional<ContactTable> Stepper::recall() {
  if (!state_.device || state_.device->requested()) return {};
  fetch_from_device();
  if (forces_step_ != state_.time.step || state_.device->advanced()) return {};
  ContactTable evaluated = state_.pairs;
  state_.device->fetch(state_.pairs);
  forces_step_ = never;
  return evaluated;
}

void Stepper::take_back(ContactTable evaluated) {
  state_.pairs = std::move(evaluated);
  forces_step_ = state_.time.step;
}

void Stepper::send_to_device() {
  if (!state_.device || !state_.device->requested()) return;
  refuse_obstacles(state_);
  state_.device->take(state_.bodies, state_.pairs, state_.settings.law, state_.statistics.one_material,
                      forces_step_ == state_.time.step);
}

void Stepper::step_on_device() {
  send_to_device();
  {
    const PhaseWatch watch = passes_.watch(StepPhase::contacts);
    const auto chunks = state_.device->step(state_.cell.images(), state_.time.previous_dt, state_.next_motion(false));
    for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk) {
      const DeviceChunk& found = chunks[chunk];
      ChunkResult& own = passes_.chunks()[chunk];
      own.overlap = found.deepest;
      own.motion = {.velocities = {std::to_array(found.low), std::to_array(found.high)}, .finite = found.poison == 0};
      own.relative_speed = state_.lists.skins().relative_speed(chunk, own.motion.velocities);
    }
  }
  device_is_ahead_ = true, forces_step_ = never;
  state_.complete.bodies = false;
  view_.invalidate();
  and_show_forces([this] { take_loads(true), end_step(); });
}

void Stepper::bodies_moved() {
  if (!passes_.ranks().several()) return;
  state_.complete.bodies = false;
  state_.halo.begin(
      state_.bodies, [this](std::size_t chunk) -> double& { return passes_.chunks()[chunk].relative_speed; },
      passes_.ranks());
}

void Stepper::show_forces() {
  fetch_from_device();
  state_.added_force.clear(), state_.added_moment.clear();
  if (passes_.extremes().finite) {
    update_surfaces();
    sum_forces(true);
    balance_.find_crossing();
  } else {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const Row row{unknown, unknown, unknown, unknown};
    state_.sum.assign(state_.sum.size(), {row, row});
    state_.complete.sums = true;
  }
  view_.invalidate();
}

void Stepper::end_step() {
  const double dt = state_.time.dt;
  // Work of walls in a step: half by the forces at its start, half by those at its end; a servo reacts to the former.
  const double work_at_start = 0.5 * state_.time.previous_dt * balance_.power_of_walls();
  state_.walls.drive(dt, [this](std::size_t wall, const Pose& there, const Vec3& velocity, double distance) {
    const Skins& skins = state_.lists.skins();
    const bool beyond = skins.walls_gone() + distance > skins.of_walls();
    return state_.wall_contacts.force_ahead(wall, state_.surfaces[wall], there, velocity, *state_.settings.law,
                                            state_.bodies, state_.group, beyond, passes_.ranks());
  });
  const double work = work_at_start + 0.5 * dt * balance_.power_of_walls();
  guard_.add_work_of_walls(work);
  balance_.add_step(work);
  state_.walls.move(dt);
  state_.time.time += dt;
  ++state_.time.step;
  body_steps_ += static_cast<double>(state_.bodies.count());
  state_.cell.advance(dt);
  state_.time.previous_dt = dt;
  update_cross_section(state_);
  bounds_.advance(state_, passes_);
}

void Stepper::restored() {
  time_step_.check_restored(state_);
  bounds_.check_restored(state_.walls.size());
  state_.wall_contacts.share(passes_.ranks());
  state_.halo.build(state_.pairs, passes_.ranks());
  repeat_walls(state_);
  readiness_.build(state_.pairs.reached());
}

void Stepper::serialize(SharedArchive& archive) {
  time_step_.serialize(archive, state_.pairs);
  archive(bounds_, cell_servo_, forces_step_, body_steps_);
}

}  // namespace grit
