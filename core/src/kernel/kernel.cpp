#include "kernel/kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "bodies/kinetic_energy.hpp"
#include "bodies/make_bodies.hpp"
#include "description/placed_error.hpp"
#include "device/open_device.hpp"
#include "format/names.hpp"
#include "grit/error.hpp"
#include "kernel/arrivals.hpp"
#include "kernel/body_groups.hpp"
#include "kernel/cell_servo.hpp"
#include "kernel/completion.hpp"
#include "kernel/device_obstacles.hpp"
#include "kernel/failure.hpp"
#include "kernel/guards.hpp"
#include "kernel/scaled_masses.hpp"
#include "kernel/specimen.hpp"
#include "plugins/component_archive.hpp"

namespace grit {

namespace {

Cell cell_of(const DomainDescription& domain) {
  const Vec3 open = Vec3::Constant(std::numeric_limits<double>::infinity());
  return {domain.low.value_or(-open), domain.high.value_or(open), domain.periodic, Vec3::Zero()};
}

/// Groups whose bodies appear during the run.
std::vector<std::string> later_groups(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const auto& [name, group] : scene.bodies)
    if (!group.stage.empty() || std::holds_alternative<StreamSource>(group.source.value())) names.push_back(name);
  return names;
}

bool same(const Bounds& a, const Bounds& b) { return a.low == b.low && a.high == b.high; }

}  // namespace

Kernel::Kernel(const SceneDescription& scene, const Components& components, Prepared prepared, unsigned threads,
               Communicator* ranks)
    : state_(cell_of(scene.domain)),
      passes_(threads, ranks),
      view_(state_, passes_),
      balance_(state_, view_, passes_),
      stepper_(state_, passes_, view_, balance_, guard_),
      smallest_bodies_(smallest_bodies(scene, components, later_groups(scene))),
      inflow_(scene, components) {
  view_.set_balance(balance_);
  state_.materials = material_names(scene);
  state_.bodies = std::move(prepared.bodies);
  if (prepared.sample) take_sample(scene, components, *prepared.sample);
  count_in(0, 0);
  state_.walls.apply(scene, components);
  apply(scene, components);
  check_periods(state_);
}

void Kernel::take_sample(const SceneDescription& scene, const Components& components, SampleState& sample) {
  sample.cell.set_open_sides(state_.cell.cell());
  state_.cell = sample.cell;
  state_.walls = std::move(sample.walls);
  std::vector<std::string> before;
  for (std::size_t w = 0; w < state_.walls.size(); ++w) before.push_back(state_.walls.name(w));
  state_.walls.apply(scene, components);
  std::map<std::string, std::uint32_t> now;
  for (std::size_t w = 0; w < state_.walls.size(); ++w) now[state_.walls.name(w)] = static_cast<std::uint32_t>(w);
  std::vector<std::uint32_t> renumbered;
  for (const std::string& name : before)
    renumbered.push_back(now.contains(name) ? now.at(name) : WallContacts::no_wall);
  sample.wall_contacts.renumber_walls(renumbered);
  state_.pairs = std::move(sample.pairs), state_.wall_contacts = std::move(sample.wall_contacts);
}

void Kernel::synchronise_velocities() {
  const double half = 0.5 * state_.time.previous_dt;
  if (half == 0) return;
  Bodies& bodies = state_.bodies;
  const auto forces = view_.forces(), moments = view_.moments();
  const auto clumps = view_.clumps();
  const Cell& cell = state_.cell.cell();
  const MeanFlow flow{cell.strain_rate, cell.shear_rate};
  for (std::size_t c = 0; c < clumps.size(); ++c) {
    Clump& clump = bodies.clumps.clump[c];
    clump.velocity = flow.carried(clump.velocity, half) + half * clump.inverse_mass * clumps[c].force;
    clump.momentum += half * clumps[c].moment;
    clump.spin = clump.spin_of(clump.momentum);
  }
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    Row &velocity = bodies.velocity[i], &spin = bodies.spin[i];
    Vec3 v, w;
    if (const std::uint32_t c = bodies.clumps.clump_of(i); c != no_clump) {
      const Clump& clump = bodies.clumps.clump[c];
      const ClumpSphere& own = bodies.clumps.of_body[i];
      const Vec3 periods(own.periods[0], own.periods[1], own.periods[2]);
      w = clump.spin;
      v = clump.velocity + w.cross(clump.axes * own.place) -
          state_.cell.image_velocities(state_.time.previous_dt) * periods;
    } else {
      v = flow.carried(xyz(velocity), half) + half * velocity.w * xyz(forces[i]);
      w = xyz(spin) + half * spin.w * xyz(moments[i]);
    }
    velocity = {v.x(), v.y(), v.z(), velocity.w}, spin = {w.x(), w.y(), w.z(), spin.w};
  }
}

Prepared Kernel::hand_over() {
  stepper_.find_forces();
  synchronise_velocities();
  return {std::move(state_.bodies),
          SampleState{state_.cell, state_.walls, std::move(state_.pairs), std::move(state_.wall_contacts)}};
}

void Kernel::begin_stage(const std::string& name, const SceneDescription& scene, const Components& components) {
  state_.stage = name;
  complete_bodies(state_, passes_);
  state_.bodies.start_paths();
  state_.cell.begin_stage();
  state_.walls.apply(scene, components);
  apply(scene, components);
  admit(scene, components);
  inflow_.begin_stage(name, state_.time.time);
}

void Kernel::change(const SceneDescription& scene, const Components& components) {
  state_.walls.change(scene, components);
  apply(scene, components);
}

void Kernel::apply(const SceneDescription& scene, const Components& components) {
  complete_bodies(state_, passes_);
  stepper_.fetch_from_device();
  const Settings before = state_.settings;
  balance_.book_elastic([&] { take_settings(scene, components); });
  const auto kinetic = [this] {
    view_.invalidate_forces();
    return balance_.begun() ? kinetic_energy(view_, 0) : 0;
  };
  const double kinetic_before = kinetic();
  if (const double gained = scale_masses(state_.bodies, before, state_.settings); gained != 0)
    state_.statistics.scale(state_.bodies, gained);
  constrain(state_.bodies, state_.settings);
  change_rates(state_, prescribed_rates(state_));
  balance_.add_settings(kinetic() - kinetic_before);
  update_cross_section(state_);
  guard_.restart();
  if (!state_.settings.removal_engines.empty()) state_.lists.request_rebuild();
  stepper_.settings_changed();
  view_.invalidate();
}

void Kernel::take_settings(const SceneDescription& scene, const Components& components) {
  state_.settings = settings_of(scene, components, state_.stage, state_.materials);
  state_.pairs.set_fields(state_.settings.fields), state_.wall_contacts.set_fields(state_.settings.fields);
  state_.settings.of_groups = demand_without_contacts(smallest_bodies_, *state_.settings.law);
  state_.lists.expect_reaches(state_.reaches());
  take_walls(scene, components);
  find_groups(state_);
}

void Kernel::take_walls(const SceneDescription& scene, const Components& components) {
  state_.surfaces.resize(state_.walls.size());
  for (std::size_t w = 0; w < state_.walls.size(); ++w) {
    const WallDescription& wall = scene.walls.at(state_.walls.name(w));
    const auto& geometry = components.geometries.at(state_.walls.name(w));
    WallSurface& surface = state_.surfaces[w];
    // Candidates remain valid unless a wall was replaced.
    if (surface.geometry == nullptr || !same(surface.geometry->bounds(), geometry->bounds()))
      state_.lists.request_rebuild();
    const GroupMask& groups = state_.settings.groups_of_walls[w];
    if (surface.groups != groups) state_.lists.request_rebuild();
    surface.geometry = geometry, surface.groups = groups;
    const auto& rotation = wall.motion.free_rotation;
    surface.gives_way = wall.motion.servo || wall.motion.free || rotation;
    surface.free = wall.motion.free || rotation;
    surface.free_axis = rotation ? rotation->axis.normalized() : Vec3(Vec3::Zero());
    surface.material =
        static_cast<std::uint32_t>(std::ranges::find(state_.materials, wall.material) - state_.materials.begin());
  }
}

void Kernel::count_in(std::size_t first, std::size_t first_clump) {
  state_.statistics.add(state_.bodies, first, first_clump, unscaled_shares(state_.bodies, state_.settings));
  state_.sum.resize(state_.bodies.count() + 1);
  std::fill(state_.sum.begin() + static_cast<std::ptrdiff_t>(first), state_.sum.end(), BodySum{});
  passes_.resize(state_.bodies.count());
}

void Kernel::append(const Bodies& arriving) {
  const std::size_t first = state_.bodies.count(), first_clump = state_.bodies.clumps.clump.size();
  state_.bodies.append(arriving);
  find_groups(state_);
  count_in(first, first_clump);
  stepper_.bodies_changed();
  state_.lists.request_rebuild();
}

void Kernel::admit(const SceneDescription& scene, const Components& components) {
  Newcomers arriving;
  try {
    arriving = make_newcomers(scene, components, state_.stage, view_.cell(), view_.positions(), state_.bodies.state);
  } catch (const FileError&) {
    throw;
  } catch (const PlacedError& error) {
    fail(state_, Guard::arrival, error.keys(), "group \"" + error.keys().at(1) + "\": " + error.what(), "");
  }
  if (arriving.bodies.count() == 0) return;
  scale_masses(arriving.bodies, {}, state_.settings);
  match_velocities(arriving.bodies, state_);
  constrain(arriving.bodies, state_.settings);

  const double settings_less_stored = balance_.settings_less_stored();  // bodies may also leave in a neighbour search
  const Bodies bodies_before = state_.bodies;
  const PopulationStatistics statistics_before = state_.statistics;
  for (auto& group : arriving.groups) group.first_id += state_.bodies.ids_given;
  stepper_.expect(std::move(arriving.groups));
  append(arriving.bodies);
  try {
    stepper_.find_forces();
  } catch (const NumericsError&) {
    if (!stepper_.expects_arrivals()) {  // bodies were inserted, and a guard tripped
      stepper_.show_forces();
      balance_.set_settings_less_stored(settings_less_stored);
    } else {  // bodies were rejected; the previous state is kept
      state_.bodies = bodies_before, state_.statistics = statistics_before;
      find_groups(state_);
      state_.sum.resize(state_.bodies.count() + 1), passes_.resize(state_.bodies.count());
      stepper_.bodies_changed();
      stepper_.expect({});
    }
    throw;
  }
  balance_.set_settings_less_stored(settings_less_stored);
}

void Kernel::let_in() {
  if (!inflow_.due(state_.time.time)) return;
  complete_bodies(state_, passes_);
  Bodies entering = inflow_.enter(state_, view_);
  if (entering.count() == 0) return;
  scale_masses(entering, {}, state_.settings);
  match_velocities(entering, state_);
  constrain(entering, state_.settings);
  append(entering);
  view_.invalidate();
  const EnteredEnergy energy = energy_of(entering, state_);
  balance_.add_settings(energy.kinetic);
  guard_.entered(energy.kinetic + energy.potential);
}

void Kernel::use(DeviceKind device) {
  if (device == DeviceKind::none) return;
  refuse_obstacles(state_);
  state_.device = std::make_unique<DeviceMirror>(open_device(device, passes_.team()));
}

void Kernel::find_forces() {
  let_in();
  stepper_.find_forces();
}

void Kernel::step_on() {
  let_in();
  stepper_.step_on();
}

std::string Kernel::fallen_behind() const {
  const std::string walls = state_.walls.fallen_behind(), cell = cell_servo_behind(state_, passes_);
  return walls + (walls.empty() || cell.empty() ? "" : "; ") + cell;
}

std::pair<bool, bool> Kernel::any_rank(bool one, bool other) {
  const auto [any_one, any_other] = passes_.ranks().any(std::array{one, other});
  return {any_one, any_other};
}

std::size_t Kernel::contact_count() const {
  std::size_t count = 0;
  for (const std::size_t of_rank : passes_.ranks().each(state_.pairs.touching_count())) count += of_rank;
  return count;
}

double Kernel::kinetic_energy_ratio() const {
  const double elastic = std::abs(balance_.elastic().total());  // negative under attraction
  return elastic > 0 ? balance_.kinetic() / elastic : std::numeric_limits<double>::infinity();
}

Model Kernel::model() const {
  Model model;
  const Settings& settings = state_.settings;
  const Bodies& bodies = state_.bodies;
  const LawLoop loop = settings.law->loop();
  model.lanes = loop.lanes, model.precision = loop.precision, model.law_parts = loop.parts;
  for (const StateField& field : settings.fields) model.contact_state.push_back(field.name);
  const auto add = [&](bool there, const char* name) {
    if (there) model.body_state.push_back(name);
  };
  add(!bodies.rotation.empty(), "rotation"), add(!bodies.origin.empty(), "displacement");
  add(bodies.energies(), "energy"), add(!bodies.clumps.none(), "clump");
  model.materials = state_.materials;
  model.one_material = state_.statistics.one_material, model.periodic = state_.cell.periodic();
  model.walls = state_.walls.size() > 0;
  model.gravity = settings.any_motion([](const MotionSettings& one) { return !one.gravity.isZero(0.0); });
  model.local_damping = settings.any_motion([](const MotionSettings& one) { return one.local_damping > 0; });
  model.bytes = state_.bytes();
  return model;
}

void Kernel::save(Archive& archive) {
  std::optional<ContactTable> evaluated = stepper_.recall();
  archive.part("walls", 1);
  archive(state_.walls);
  serialize(archive);
  if (evaluated) stepper_.take_back(std::move(*evaluated));
}

void Kernel::restore(const SceneDescription& scene, const Components& components, Archive& archive) {
  archive.part("walls", 1);
  archive(state_.walls);
  state_.walls.change(scene, components);  // with their present poses and velocities
  take_settings(scene, components);
  serialize(archive);
  state_.check_restored();
  state_.settings.growth_rate = growth_rate(scene, state_.stage);
  find_groups(state_);
  state_.sum.assign(state_.bodies.count() + 1, {});
  stepper_.restored();
  update_cross_section(state_);
  view_.invalidate();
}

/// Names of the numbers that contacts keep, which the law declares.
void Kernel::serialize_fields(Archive& archive) {
  std::vector<std::string> names, found;
  for (const StateField& field : state_.settings.fields) names.push_back(field.name);
  found = names;
  archive(found);
  if (found == names) return;
  throw Error("contacts of the saved state keep " + listed(found, "nothing") + ", but those of this contact law keep " +
              listed(names, "nothing") + "; continue with the description that wrote it");
}

/// Without walls, which come first, and without values that each step recomputes: sums, loads, surfaces. Each part has
/// a version, which is raised with any change of its members.
void Kernel::serialize(Archive& archive) {
  SharedArchive shared(archive, passes_.ranks());
  const auto part = [&archive](const char* name, std::uint32_t version, auto&... members) {
    archive.part(name, version);
    archive(members...);
  };
  part("time", 1, state_.stage, state_.time);
  part("cell", 1, state_.cell);
  archive.part("run time", 3);  // early, as it divides the chunks among ranks
  passes_.serialize(shared);
  archive.part("bodies", 2);
  state_.bodies.serialize(shared);
  if (archive.restoring())
    expect_restored(passes_.chunks().size() == chunks_of(state_.bodies.count()),
                    "computing times are of another number of bodies");
  archive(state_.statistics);
  archive.part("neighbour lists", 3);
  state_.lists.serialize(shared);
  archive.part("contact history", 1);
  serialize_fields(archive);
  archive.part("contacts", 2);
  state_.pairs.serialize(shared);
  archive.part("wall contacts", 3);
  state_.wall_contacts.serialize(shared);
  part("departures", 1, state_.departures, state_.discharged_mass);
  part("energy", 1, state_.overlap, balance_, guard_);
  archive.part("time step", 4);
  stepper_.serialize(shared);
  part("streams", 1, inflow_);
  for (const auto& [name, engine] : state_.settings.engines)
    serialize_component("engine \"" + name + '"', *engine, archive);
}

}  // namespace grit
