#include "run/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "engines/clump_motion.hpp"
#include "grit/error.hpp"
#include "run/number.hpp"
#include "run/stopwatch.hpp"
#include "scene/kinetic_energy.hpp"
#include "scene/make_bodies.hpp"

namespace grit {
namespace {

// Skins as a share of the mean diameter, and for how many steps they are to last where they are wider than the least.
// On the dense periodic box of bench/ 0.01 … 0.05 were tried: the wider, the fewer searches and the more pairs to test;
// 0.03 was best or within 3 % of it at 10 000 and 50 000 grains.
constexpr double least_skin = 0.03, most_skin = 0.4, steps_of_skin = 100;
// The time step is set anew for bodies that have gone so far, in mean diameters; pairs nearer than the other touch. Two
// bodies may close more than that unseen; docs/definitions.md says how much the step lags, and what it would cost not
// to.
constexpr double stepped_way = 0.03, as_good_as_touching = 0.015;
// A search after which bodies are put in spatial order again.
constexpr std::uint64_t reorder_every = 8;
// The time step is raised only when it could be so much larger, so that it does not follow every small change.
constexpr double raise_when = 1.1;
// Of so many chunks one is timed: a look at the clock takes some 30 ns, a chunk some 20 µs.
constexpr std::uint64_t timed_every = 8;
constexpr double not_asked = -1;  // for how far bodies reach from a wall that does not spin

/// How far the furthest body is from there [m].
double furthest_from(const Vec3& place, const Bodies& bodies) {
  double furthest = 0;
  for (std::size_t i = 0; i < bodies.count(); ++i)
    furthest = std::max(furthest, (xyz(bodies.position[i]) - place).norm());
  return furthest;
}

/// Until somebody has asked for the ledger it is nobody's, and costs nothing.
bool is_kept(const EnergyFlows& ledger, const Bodies& bodies) { return bodies.energies() && ledger.begun; }

bool same(const Bounds& a, const Bounds& b) { return a.low == b.low && a.high == b.high; }

}  // namespace

Simulation::Simulation(const SceneDescription& scene, Bodies bodies, unsigned threads)
    : material_names_(material_names(scene)), team_(threads), bodies_(std::move(bodies)), shifts_(27) {
  phases_ = {{"search", 0}, {"contacts", 0}, {"walls", 0}, {"motion", 0}};
  const Vec3 open = Vec3::Constant(std::numeric_limits<double>::infinity());
  clock_.cell = {scene.domain.low.value_or(-open), scene.domain.high.value_or(open), scene.domain.periodic,
                 Vec3::Zero()};
  periodic_ = scene.domain.periodic[0] || scene.domain.periodic[1] || scene.domain.periodic[2];
  clock_.period_before = clock_.cell.high - clock_.cell.low;

  take_stock(0, 0);
  check_periods();
  walls_.apply(scene);
  apply(scene);
}

void Simulation::begin_stage(const std::string& name, const SceneDescription& scene) {
  stage_ = name;
  bodies_.start_paths();
  walls_.apply(scene);
  apply(scene);
  admit();
}

void Simulation::end_stage() { check_energy(); }

void Simulation::change(const SceneDescription& scene) {
  walls_.change(scene);
  apply(scene);
}

void Simulation::apply(const SceneDescription& scene) {
  const double elastic_before = flows_.begun ? elastic_energy().total() : 0;
  take_settings(scene);
  if (flows_.begun) flows_.settings += elastic_energy().total() - elastic_before;
  growth_rate_ = growth_rate_of(stage_), grown_ = 0;
  const auto moving = [this] {
    net_step_ = clump_step_ = ~0ull;
    return flows_.begun ? grit::kinetic_energy(*this, 0) : 0;
  };
  const double kinetic_before = moving();
  if (settings_.flat) flatten(*settings_.flat);
  // Bodies take part in the mean flow of a deforming cell from its first instant.
  const Vec3 change_of_rate = scene.domain.strain_rate - clock_.cell.strain_rate;
  if (!change_of_rate.isZero(0.0)) {
    const auto flow = [&](const Vec3& place) -> Vec3 { return change_of_rate.cwiseProduct(place - centre()); };
    for (Clump& clump : bodies_.clumps.clump) clump.velocity += flow(clump.centre);
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
      Vec3 v = flow(xyz(bodies_.position[i]));
      if (const std::uint32_t c = bodies_.clumps.clump_of(i); c != no_clump) {
        const auto& periods = bodies_.clumps.of_body[i].periods;
        const Vec3 period = clock_.cell.high - clock_.cell.low;
        v = flow(bodies_.clumps.clump[c].centre);
        for (int k = 0; k < 3; ++k)
          if (clock_.cell.periodic[k]) v[k] -= periods[static_cast<std::size_t>(k)] * change_of_rate[k] * period[k];
      }
      bodies_.velocity[i] += Row{v.x(), v.y(), v.z(), 0};
    }
    clock_.cell.strain_rate = scene.domain.strain_rate;
    // Images change their velocities with the bodies.
    const Vec3 period = clock_.cell.high - clock_.cell.low;
    for (int k = 0; k < 3; ++k)
      if (clock_.cell.periodic[k]) clock_.period_before[k] -= clock_.last_time_step * change_of_rate[k] * period[k];
  }
  if (flows_.begun) flows_.settings += moving() - kinetic_before;
  tell_walls_of_specimen();
  energy_ = {};
  time_step_now_ = true;
  soft_until_ = overlap_of_soft_springs();
  forget_views();
}

void Simulation::take_settings(const SceneDescription& scene) {
  scene_ = &scene;
  law_ = scene.contacts.get();
  law_->mix(materials_in_use(scene, material_names_), materials_of_bodies(scene));
  fields_ = law_->state();
  pairs_.set_fields(fields_), wall_contacts_.set_fields(fields_);
  settings_ = {};
  force_engines_.clear();
  for (const auto& [name, engine] : scene.engines) {
    if (engine.engine->phase() == Phase::settings) engine.engine->settings(settings_);
    else force_engines_.push_back(engine.engine.get());
  }
  loads_.resize(walls_.size());
  surfaces_.resize(walls_.size()), arms_.resize(walls_.size(), not_asked);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const WallDescription& wall = scene.walls.at(walls_.name(w));
    // Candidates stay what they are, unless a wall has become another.
    if (surfaces_[w].geometry == nullptr || !same(surfaces_[w].geometry->bounds(), wall.geometry.get()->bounds()))
      search_now_ = true;
    surfaces_[w].geometry = wall.geometry.get();
    surfaces_[w].gives_way = wall.motion.servo || wall.motion.free;
    surfaces_[w].free = bool(wall.motion.free);
    surfaces_[w].material = static_cast<std::uint32_t>(
        std::find(material_names_.begin(), material_names_.end(), wall.material) - material_names_.begin());
  }
}

void Simulation::flatten(int axis) {
  // Those that come later as well.
  if (std::ranges::any_of(scene_->bodies, [](const auto& group) { return group.second.kind->clump() != nullptr; }))
    throw Error("clumps turn about all axes, so that they cannot move in a plane; leave out the engine \"planar\"");
  for (std::size_t i = 0; i < bodies_.count(); ++i) {
    Vec3 v = xyz(bodies_.velocity[i]), w = xyz(bodies_.spin[i]);
    v[axis] = 0, w = w.cwiseProduct(Vec3::Unit(axis));
    bodies_.velocity[i] = {v.x(), v.y(), v.z(), bodies_.velocity[i].w};
    bodies_.spin[i] = {w.x(), w.y(), w.z(), bodies_.spin[i].w};
  }
}

void Simulation::update_surfaces() {
  for (std::size_t w = 0; w < surfaces_.size(); ++w) {
    const WallState& state = walls_.states()[w];
    surfaces_[w].pose = state.pose;
    surfaces_[w].velocity = state.velocity, surfaces_[w].spin = state.spin;
  }
}

bool Simulation::search_is_due() {
  if (search_now_) return true;
  Skins& skins = clock_.skins;
  if (skins.walls_gone() > skins.of_walls()) return true;
  const auto worn = [&](std::size_t chunk) {
    return skins.gone(chunk) + 0.5 * clock_.strain_travel > skins.of_chunk(chunk);
  };
  // The sum of the largest speeds is a bound; the true way is often far less and worth a look.
  // In a cell that deforms it is what a body goes apart from the mean flow.
  Vec3 stretch = Vec3::Ones(), from = Vec3::Zero(), to = Vec3::Zero();
  if (!clock_.cell.strain_rate.isZero(0.0)) {
    from = 0.5 * (reference_cell_.low + reference_cell_.high), to = centre();
    for (int k = 0; k < 3; ++k)
      if (clock_.cell.periodic[k])
        stretch[k] = (clock_.cell.high[k] - clock_.cell.low[k]) / (reference_cell_.high[k] - reference_cell_.low[k]);
      else from[k] = to[k] = 0;
  }
  for (std::size_t chunk = 0; chunk < chunk_.size(); ++chunk) {
    if (!worn(chunk)) continue;
    const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
    double largest = 0;
    for (std::size_t i = first; i < last; ++i) {
      const Vec3 away = xyz(bodies_.position[i]) - to - stretch.cwiseProduct(xyz(reference_[i]) - from);
      largest = std::max(largest, away.squaredNorm());
    }
    skins.found(chunk, std::sqrt(largest));
    if (skins.gone(chunk) + 0.5 * clock_.strain_travel > 0.95 * skins.of_chunk(chunk)) return true;
  }
  return false;
}

/// By speeds alone, so that a run is the same on every machine.
void Simulation::lay_on_skins() {
  const double least = least_skin * stock_.mean_diameter;
  double most = most_skin * stock_.mean_diameter;
  for (int k = 0; k < 3; ++k)
    if (clock_.cell.periodic[k])
      most = std::min(most, 0.25 * (clock_.cell.high[k] - clock_.cell.low[k]) - stock_.largest_radius);
  const auto skin = [&](double speed) {
    return std::max(least, std::min(most, steps_of_skin * clock_.time_step * speed));
  };
  const Vec3 rate = clock_.cell.strain_rate, middle = rate.isZero(0.0) ? Vec3::Zero() : centre();
  std::vector<double> skins(chunk_.size());
  team_.each(chunk_.size(), [&](std::size_t chunk) {
    const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
    double fastest = 0;
    for (std::size_t i = first; i < last; ++i) {
      const Vec3 flow = rate.cwiseProduct(xyz(bodies_.position[i]) - middle);
      fastest = std::max(fastest, (xyz(bodies_.velocity[i]) - flow).squaredNorm());
    }
    skins[chunk] = skin(std::sqrt(fastest));
  });
  clock_.skins.lay_on(skins, skin(clock_.wall_speed));
  clock_.strain_travel = 0;
}

/// Skins are no wider than periods allow, but never narrower than the least.
void Simulation::check_periods() const {
  double shortest = NeighbourSearch::shortest_period(stock_.largest_radius, least_skin * stock_.mean_diameter);
  double furthest = 0;
  for (const Clump& clump : bodies_.clumps.clump) furthest = std::max(furthest, clump.furthest);
  shortest += 2 * furthest;  // a clump shall not meet itself
  for (int k = 0; k < 3; ++k)
    if (const double period = clock_.cell.high[k] - clock_.cell.low[k]; clock_.cell.periodic[k] && period < shortest)
      fail("/domain is " + number(period) + " m long along " + "xyz"[k] +
               ", where it repeats; a body would meet another one twice in less than " + number(shortest) +
               " m, twice the reach of the largest",
           "make the domain longer along this axis, bound it by walls, or compress it less");
}

void Simulation::search() {
  check_periods();
  const std::vector<bool> leaves = wrap();
  if (!newcomers_.empty()) check_newcomers();
  const bool some_leave = std::ranges::find(leaves, true) != leaves.end();
  std::vector<std::uint32_t> order;
  if (clock_.rebuilds % reorder_every == 0 || some_leave || !newcomers_.empty()) {
    order = spatial_order(bodies_, clock_.cell);
    if (some_leave) {
      take_leave(leaves);
      std::erase_if(order, [&](std::uint32_t i) { return leaves[i]; });
    }
    bodies_.reorder(order);
    sum_.resize(bodies_.count() + 1), chunk_.resize(chunks_of(bodies_.count()));
  }
  lay_on_skins();
  search_.build(bodies_, clock_.cell, clock_.skins);
  pairs_.rebuild(bodies_, search_, periodic_, fields_, order, team_);
  readiness_.build(pairs_.reached());
  wall_contacts_.rebuild(bodies_, surfaces_, clock_.skins, fields_, order);
  reference_ = bodies_.position, reference_cell_ = clock_.cell;
  for (std::size_t w = 0; w < walls_.size(); ++w)
    arms_[w] = walls_.states()[w].spin.isZero(0.0)
                   ? not_asked
                   : furthest_from(walls_.reference(w), bodies_) + stock_.largest_radius;
  ++clock_.rebuilds;
  search_now_ = false;
  newcomers_.clear();
  set_time_step();
}

CriticalStep::Instant Simulation::near_contacts() const {
  return {.bodies = bodies_,
          .pairs = pairs_,
          .walls = wall_contacts_,
          .surfaces = surfaces_,
          .law = *law_,
          .shifts = shifts_.data(),
          .skins = clock_.skins,
          .near = as_good_as_touching * stock_.mean_diameter,
          .overlap = springs_stiffen() ? clock_.stepped_overlap : 0};
}

void Simulation::set_time_step() {
  time_step_now_ = false;
  expect_overlap();
  choose_time_step(critical_.find(near_contacts(), team_));
}

void Simulation::choose_time_step(const Demand& contacts) {
  const TimeStepDescription& wish = scene_->time_step;
  clock_.contact_demand = contacts, clock_.wall_demand = walls_.demand();
  clock_.critical_time_step =
      Demand{contacts.spring + clock_.wall_demand.spring, contacts.dashpot + clock_.wall_demand.dashpot, 0}
          .critical_time_step();
  if (wish.value) {
    clock_.time_step = *wish.value;
    if (*wish.value > clock_.critical_time_step && !wish.allow_unstable)
      fail("the time step " + number(*wish.value) + " s is above the critical one, " +
               number(clock_.critical_time_step) + " s",
           "leave out /time_step/value, or say \"allow_unstable\": true");
    check_oscillations(*scene_, clock_.time_step);
    return;
  }
  const double safe = std::min(wish.safety * clock_.critical_time_step, contacts.step_of_impact(wish.steps_per_impact));
  if (!std::isfinite(safe) && clock_.time_step > 0) return;  // all bodies have left
  if (!std::isfinite(safe))
    throw Error(bodies_.count() == 0 ? "there is no body, so that there is no time step; give /time_step/value"
                                     : "contacts have no stiffness to speak of, so that no time step is too long; make "
                                       "them stiffer, or give /time_step/value");
  if (clock_.time_step == 0 || safe < clock_.time_step || safe > raise_when * clock_.time_step) clock_.time_step = safe;
  check_oscillations(*scene_, clock_.time_step);
}

bool Simulation::prepare() {
  forget_views();
  update_shifts();
  update_surfaces();
  {
    const Stopwatch watch(phases_[searching].seconds);
    if (search_is_due()) search();
    else if (time_step_now_) set_time_step();
    // Contacts form long before the next search.
    else if (critical_.due(clock_.skins, stepped_way * stock_.mean_diameter))
      choose_time_step(critical_.renew(near_contacts(), stepped_way * stock_.mean_diameter, team_));
  }
  // What contacts remember goes with a step once, however often its forces are asked for: a stage asks again.
  const bool again = clock_.forces_step == clock_.step;
  clock_.forces_step = clock_.step;
  return again;
}

template <class Work>
void Simulation::pass(Work work) {
  const Stopwatch watch(passes_);
  team_.each(chunk_.size(), [&](std::size_t chunk) {
    Laps laps((chunk + clock_.step) % timed_every == 0);
    work(chunk, laps);
  });
}

void Simulation::evaluate(std::size_t chunk, bool again, BodySum* sum, Laps& laps) {
  Chunk& own = chunk_[chunk];
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
  std::fill(sum + first, sum + last, BodySum{});
  own.losses = {};
  Losses* const losses = is_kept(flows_, bodies_) ? &own.losses : nullptr;
  own.overlap = pairs_.evaluate(chunk, instant(again), sum, losses);
  laps(own.seconds[pair_contacts]);
  if (surfaces_.empty()) return;
  own.overlap = std::max(own.overlap, wall_contacts_.evaluate(chunk, *law_, bodies_, stock_.one_material, surfaces_,
                                                              again ? 0 : clock_.last_time_step, sum, losses));
  laps(own.seconds[wall_touches]);
}

void Simulation::move(std::size_t chunk, const BodySum* sum, const MotionStep& step) {
  chunk_[chunk].motion = move_bodies(chunk, bodies_, sum, step);
}

void Simulation::sum_forces(bool again) {
  pass([&](std::size_t chunk, Laps& laps) { evaluate(chunk, again, sum_.data(), laps); });
  pass([&](std::size_t chunk, Laps& laps) {
    pairs_.gather(chunk, sum_.data());
    laps(chunk_[chunk].seconds[motion]);
  });
}

void Simulation::take_loads() {
  if (!surfaces_.empty()) {
    wall_contacts_.loads(loads_);
    walls_.clear_forces();
    for (std::size_t w = 0; w < loads_.size(); ++w) walls_.add(w, loads_[w]);
  }
  clock_.overlap = 0;
  for (const Chunk& chunk : chunk_) clock_.overlap = std::max(clock_.overlap, chunk.overlap);
  if (is_kept(flows_, bodies_))
    for (const Chunk& chunk : chunk_) {
      flows_.lost.friction += chunk.losses.friction, flows_.lost.rolling += chunk.losses.rolling;
      flows_.lost.viscosity += chunk.losses.viscosity;
    }
  check_overlap(clock_.overlap);
}

void Simulation::find_forces() {
  const bool look = springs_may_stiffen();
  sum_forces(prepare());
  added_force_.clear(), added_moment_.clear();
  if (!force_engines_.empty()) {
    std::vector<Row> force(bodies_.count()), moment(bodies_.count());
    for (const auto& engine : force_engines_) engine->forces(*this, force, moment);
    for (std::size_t i = 0; i < bodies_.count(); ++i) sum_[i].force += force[i], sum_[i].moment += moment[i];
    added_force_.swap(force), added_moment_.swap(moment);
    net_step_ = clump_step_ = ~0ull;  // engines may have asked for forces, without their own
  }
  if (bodies_.energies() && clock_.cell_deforms()) find_crossing();
  take_loads();
  if (look && stiffer_than_stepped(clock_.overlap)) set_time_step();
  else if (walls_.demand().more_than(clock_.wall_demand)) choose_time_step(clock_.contact_demand);
  if (energy_check_is_due()) check_energy();
}

MotionStep Simulation::next_motion() const {
  const double dt = clock_.time_step;
  Vec3 period = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (clock_.cell.periodic[k]) period[k] = clock_.cell.high[k] - clock_.cell.low[k];
  const Vec3 growth = period.cwiseProduct(clock_.cell.strain_rate);
  return {.settings = settings_,
          .kick = clock_.last_time_step > 0 ? 0.5 * (clock_.last_time_step + dt) : 0.5 * dt,
          .drift = dt,
          .flowed = clock_.last_time_step,
          .strain_rate = clock_.cell.strain_rate,
          .centre = clock_.cell.strain_rate.isZero(0.0) ? Vec3::Zero() : centre(),
          .period = period + dt * growth,
          .period_growth = growth,
          .energies = is_kept(flows_, bodies_)};
}

template <class Work>
void Simulation::and_show_forces(Work work) {
  try {
    work();
  } catch (const NumericsError&) {
    show_forces();
    throw;
  }
}

void Simulation::advance() {
  const MotionStep next = next_motion();
  // Half of what the cell and engines do in a step by the forces at its start, half by those at its end.
  const bool engines = next.energies && engines_do_work(), cell = next.energies && next.flows();
  const double half_before = 0.5 * clock_.last_time_step, half_after = 0.5 * next.drift;
  const auto power = [this] {
    const Stopwatch watch(phases_[motion].seconds);
    return power_of_engines();
  };
  double by_engines = engines ? half_before * power() : 0;
  double by_cell = cell ? half_before * power_of_cell(clock_.growth_of_period()) : 0;
  if (growth_rate_ > 0 || flows_.grown > 0) grow();
  const std::size_t clumps = bodies_.clumps.clump.size();
  if (clumps > 0)
    pass([&](std::size_t chunk, Laps& laps) {
      const std::size_t first = std::min(clumps, chunk * chunk_bodies), last = std::min(clumps, first + chunk_bodies);
      chunk_[chunk].clumps = move_clumps(first, last, bodies_, sum_.data(), next);
      laps(chunk_[chunk].seconds[motion]);
    });
  pass([&](std::size_t chunk, Laps& laps) {
    move(chunk, sum_.data(), next);
    laps(chunk_[chunk].seconds[motion]);
  });
  if (engines) by_engines += half_after * power();
  if (cell) by_cell += half_after * power_of_cell(next.period_growth);
  flows_.engines += by_engines, flows_.cell += by_cell;
  and_show_forces([this] { end_step(); });
}

/// Forces decide on nothing that bodies must wait for: neither the time step, nor what engines add. Nor does the ledger
/// ask what they do to bodies before these move and after.
bool Simulation::in_one_pass() const {
  const bool free_walls = std::any_of(surfaces_.begin(), surfaces_.end(), [](const auto& wall) { return wall.free; });
  const bool work_of_forces = is_kept(flows_, bodies_) && (clock_.cell_deforms() || bodies_are_held());
  return growth_rate_ == 0 && flows_.grown == 0 && force_engines_.empty() && bodies_.clumps.none() && !free_walls &&
         !work_of_forces && !energy_check_is_due() && !springs_may_stiffen();
}

void Simulation::step_on() {
  if (!in_one_pass()) {
    find_forces();
    advance();
    return;
  }
  const bool again = prepare();
  const MotionStep next = next_motion();
  readiness_.restart();
  const auto gather_and_move = [&](std::size_t chunk, BodySum* sum) {
    pairs_.gather(chunk, sum);
    move(chunk, sum, next);
  };
  pass([&](std::size_t chunk, Laps& laps) {
    // Sums of a chunk that moves at once never leave the cache. Indexed by body, like those of all: what the pointer
    // would be for body 0 lies before the array and is never read, which no machine that grit runs on minds.
    alignas(64) thread_local std::array<BodySum, chunk_bodies> here;
    const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
    const std::uintptr_t of_body_0 = reinterpret_cast<std::uintptr_t>(here.data()) - first * sizeof(BodySum);
    BodySum* const own = reinterpret_cast<BodySum*>(of_body_0);
    evaluate(chunk, again, own, laps);
    chunk_[chunk].moved = readiness_.evaluated(chunk);
    if (chunk_[chunk].moved) gather_and_move(chunk, own);
    else std::copy(own + first, own + last, sum_.data() + first);
    laps(chunk_[chunk].seconds[motion]);
  });
  late_.clear();
  for (std::size_t chunk = 0; chunk < chunk_.size(); ++chunk)
    if (!chunk_[chunk].moved) late_.push_back(chunk);
  if (!late_.empty()) {
    const Stopwatch watch(phases_[motion].seconds);
    team_.each(late_.size(), [&](std::size_t k) { gather_and_move(late_[k], sum_.data()); });
  }
  and_show_forces([this] { take_loads(), end_step(); });
}

void Simulation::show_forces() {
  added_force_.clear(), added_moment_.clear();
  const bool finite = std::all_of(chunk_.begin(), chunk_.end(), [](const Chunk& c) { return c.motion.finite; });
  if (finite) {
    update_surfaces();
    sum_forces(true);
    if (bodies_.energies() && clock_.cell_deforms()) find_crossing();
  } else {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const Row row{unknown, unknown, unknown, unknown};
    sum_.assign(sum_.size(), {row, row});
  }
  forget_views();
}

void Simulation::end_step() {
  const double dt = clock_.time_step;
  // Half of what the walls do in a step by the forces at its start, half by those at its end: a servo moves because of
  // the former.
  const double work_at_start = 0.5 * clock_.last_time_step * power_of_walls();
  walls_.drive(dt, [this](std::size_t wall, const Pose& there, const Vec3& velocity, double way) {
    const bool beyond = clock_.skins.walls_gone() + way > clock_.skins.of_walls();
    return wall_contacts_.force_ahead(wall, surfaces_[wall], there, velocity, *law_, bodies_, beyond);
  });
  const double work = work_at_start + 0.5 * dt * power_of_walls();
  energy_.work += work, flows_.walls += work;
  for (Chunk& chunk : chunk_) {
    const Motion of_clumps = std::exchange(chunk.clumps, {});
    flows_.damped += chunk.motion.damped + of_clumps.damped;
    flows_.fallen += chunk.motion.fallen + of_clumps.fallen;
    flows_.cell += chunk.motion.carried + of_clumps.carried;
  }
  double fastest = 0;
  bool finite = true;
  for (const Chunk& chunk : chunk_)
    fastest = std::max(fastest, chunk.motion.largest_speed), finite = finite && chunk.motion.finite;
  walls_.move(dt);
  clock_.time += dt;
  ++clock_.step;
  body_steps_ += static_cast<double>(bodies_.count());
  clock_.period_before = clock_.cell.high - clock_.cell.low;
  if (!clock_.cell.strain_rate.isZero(0.0)) {
    const Vec3 middle = centre();
    for (int k = 0; k < 3; ++k) {
      if (!clock_.cell.periodic[k]) continue;
      const double half = 0.5 * clock_.period_before[k] * (1 + dt * clock_.cell.strain_rate[k]);
      clock_.cell.low[k] = middle[k] - half, clock_.cell.high[k] = middle[k] + half;
    }
  }
  clock_.last_time_step = dt;
  tell_walls_of_specimen();

  const double strained =
      dt * clock_.cell.strain_rate.cwiseAbs().maxCoeff() * 2 * (stock_.largest_radius + clock_.skins.largest()) +
      2 * grown_;
  clock_.strain_travel += strained;
  double furthest = 0;
  for (std::size_t chunk = 0; chunk < chunk_.size(); ++chunk) {
    clock_.skins.go(chunk, dt * chunk_[chunk].motion.largest_speed, 0.5 * strained);
    furthest = std::max(furthest, clock_.skins.gone(chunk));
  }
  double wall_speed = 0, wall_closing = 0;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const WallState& wall = walls_.states()[w];
    double turning = 0;
    if (!wall.spin.isZero(0.0)) {
      if (arms_[w] == not_asked) arms_[w] = furthest_from(walls_.reference(w), bodies_) + stock_.largest_radius;
      turning = wall.spin.norm() * (arms_[w] + furthest + clock_.strain_travel + clock_.skins.walls_gone());
    }
    const double speed = wall.velocity.norm() + turning;
    // A flat wall may slide along itself as fast as it likes.
    const Vec3 normal = wall.pose.turn * walls_.geometry(w).normal();
    const double closing = (normal.isZero() ? wall.velocity.norm() : std::abs(wall.velocity.dot(normal))) + turning;
    if (!(dt * closing <= scene_->guards.travel * stock_.smallest_radius) && bodies_.count() > 0)
      fail(
          "wall \"" + walls_.name(w) + "\" moves " + number(dt * closing / stock_.smallest_radius) +
              " of the smallest radius in one step, more than /guards/travel " + number(scene_->guards.travel),
          "a wall that fast passes through bodies; make it slower, or if it is free heavier, or the time step smaller");
    wall_speed = std::max(wall_speed, speed), wall_closing = std::max(wall_closing, closing);
  }
  clock_.wall_speed = wall_speed, clock_.wall_closing = wall_closing;
  clock_.skins.walls_go(dt * wall_speed);
  clock_.last_approach = dt * std::max(2 * fastest, fastest + wall_closing) + strained;

  if (!finite || dt * fastest > scene_->guards.travel * stock_.smallest_radius) {
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
      const Vec3 v = xyz(bodies_.velocity[i]), w = xyz(bodies_.spin[i]);
      if (!v.allFinite() || !w.allFinite())
        fail_at_body(i, "has a velocity that is not a number",
                     "two bodies may have begun at one place, or the time step is too large");
      const Vec3 flow = clock_.cell.strain_rate.isZero(0.0)
                            ? Vec3::Zero()
                            : Vec3(clock_.cell.strain_rate.cwiseProduct(xyz(bodies_.position[i]) - centre()));
      const double travel = dt * (v - flow).norm(), radius = bodies_.position[i].w;
      if (travel > scene_->guards.travel * radius)
        fail_at_body(i,
                     "moves " + number(travel / radius) + " of its radius in one step, more than /guards/travel " +
                         number(scene_->guards.travel),
                     "bodies may overlap too much at the start, a wall may be too fast, or the time step too large");
    }
  }
}

std::vector<PhaseTime> Simulation::phases() const {
  std::array<double, part_count> timed{};
  for (const Chunk& chunk : chunk_)
    for (std::size_t part = 0; part < part_count; ++part) timed[part] += chunk.seconds[part];
  const double all = std::accumulate(timed.begin(), timed.end(), 0.0);
  auto phases = phases_;
  for (std::size_t part = 0; part < part_count && all > 0; ++part) phases[part].seconds += passes_ * timed[part] / all;
  return phases;
}

Model Simulation::model() const {
  Model model;
  const LawLoop loop = law_->loop();
  model.lanes = loop.lanes, model.precision = loop.precision, model.law_parts = loop.parts;
  for (const StateField& field : fields_) model.contact_state.push_back(field.name);
  const auto add = [&](bool there, const char* name) {
    if (there) model.body_state.push_back(name);
  };
  add(!bodies_.rotation.empty(), "rotation"), add(!bodies_.origin.empty(), "displacement");
  add(bodies_.energies(), "energy"), add(!bodies_.clumps.none(), "clump");
  model.materials = material_names_;
  model.one_material = stock_.one_material, model.periodic = periodic_, model.walls = walls_.size() > 0;
  model.gravity = !settings_.gravity.isZero(0.0), model.local_damping = settings_.local_damping > 0;
  model.bytes = memory();
  return model;
}

std::size_t Simulation::memory() const {
  const std::size_t bodies =
      bodies_.count() * (4 * sizeof(Row) + sizeof(BodySum) + 5 + (bodies_.rotation.empty() ? 0 : sizeof(Vec3)) +
                         (bodies_.origin.empty() ? 0 : sizeof(Vec3)));
  const Clumps& clumps = bodies_.clumps;
  return bodies + pairs_.memory() + clumps.clump.size() * sizeof(Clump) +
         clumps.of_body.size() * (sizeof(ClumpSphere) + sizeof(std::uint32_t) + sizeof(double));
}

}  // namespace grit
