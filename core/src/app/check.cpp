#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <optional>
#include <thread>
#include <utility>

#include "app/estimate.hpp"
#include "app/options.hpp"
#include "app/progress_bar.hpp"
#include "app/run_setup.hpp"
#include "bodies/body_memory.hpp"
#include "bodies/make_bodies.hpp"
#include "description/current_scene.hpp"
#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/resources.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"
#include "input/scene.hpp"
#include "kernel/device_obstacles.hpp"
#include "kernel/kernel.hpp"
#include "lint/doubtful_targets.hpp"
#include "lint/endless_fall.hpp"
#include "lint/excess_depth.hpp"
#include "lint/fast_walls.hpp"
#include "lint/installed_studies.hpp"
#include "lint/missed_floor.hpp"
#include "lint/odd_densities.hpp"
#include "lint/short_reach.hpp"
#include "lint/soft_contacts.hpp"
#include "lint/turned_walls.hpp"
#include "lint/unmoved_bodies.hpp"
#include "lint/without_effect.hpp"
#include "output/frame_size.hpp"
#include "output/frame_space.hpp"
#include "output/named_fields.hpp"
#include "output/plugins_used.hpp"
#include "output/reference_curve.hpp"
#include "output/single_channels.hpp"
#include "run/observer.hpp"
#include "simulation/expected_frames.hpp"
#include "simulation/expected_stages.hpp"
#include "simulation/first_instant.hpp"
#include "simulation/live_scene.hpp"
#include "simulation/no_recorder.hpp"
#include "simulation/prepared_sample.hpp"

namespace grit {
namespace {

// Per body: a coordination number of 5, and some contacts with walls.
constexpr double dense_contacts = 2.7;

/// The fields of a probe in a frame at this instant; none if it cannot be sampled here.
std::optional<FieldGroup> fields_of(Observer& observer, const World& world) try {
  NoRecorder none;
  observer.sample(0, world, none);
  return observer.fields(world);
} catch (const PluginError&) {
  throw;
} catch (const Error&) {  // it samples in later stages
  return std::nullopt;
}

/// "0.21 h (12 min 36 s)".
std::string hours_text(double seconds) {
  constexpr double most = 1e12;
  if (!(seconds < most)) return "more than can be told";
  return fmt::format("{:.2f} h ({})", seconds / 3600, duration_text(seconds));
}

std::string steps_text(double steps) {
  constexpr double most = 1e15;
  return steps < most ? std::to_string(std::llround(steps)) : fmt::format("{:.3g}", steps);
}

/// What frames will take on the disk. Throws PlacedError if it cannot hold them.
void print_frames(const SceneDescription& description, const Kernel& kernel, const FrameContent& content,
                  const std::vector<FieldGroup>& fields, const std::vector<ExpectedStage>& stages, double dt) {
  if (description.output.frames.never()) return;
  const World& world = kernel.world();
  const ExpectedFrames frames = expected_frames(description, stages, {dt, dt});
  const double each = frame_bytes(world, content, fields, description.output.frames.formats);
  const std::filesystem::path here = ".";
  std::cout << "frames: ";
  if (frames.shown)
    std::cout << (frames.at_most ? "at most " : "about ") << steps_text(*frames.shown) << " of " << bytes_text(each)
              << " each, " << bytes_text(*frames.shown * each) << " in all; ";
  else std::cout << bytes_text(each) << " each, their number depends on the run; ";
  std::cout << bytes_text(available_disk(here)) << " are free on this disk\n";
  const auto bodies = static_cast<double>(world.positions().size());
  check_disk(frames, least_frame_bytes(bodies, kernel.state().bodies.state), here);
}

/// Throws PlacedError for what of any stage a device cannot do.
void check_stages_on_device(const Scene& scene, const State& state) {
  LiveScene live(scene);
  for (std::size_t stage = 0; stage < scene.stages.size(); ++stage) {
    live.go_to(stage, 0);
    std::vector<std::string> walls;
    for (const auto& [name, wall] : live.now().walls) walls.push_back(name);
    const Settings settings =
        settings_of(live.now(), live.components(), live.now().stages[stage].name, state.materials);
    auto found = device_obstacles(settings, walls, state.bodies.state);
    if (found.empty()) continue;
    PlacedError error(std::move(found));
    error.begun(stage + 1);
    throw error;
  }
}

void check_one(const std::string& file, const Scene& scene, const Options& options, const Registry& registry) {
  const SceneDescription& description = *scene.description;
  check_references(description.output);
  const LiveScene live(scene);
  const Components& components = live.components();
  std::cout << file << ": " << description.title << "\n\ncomponents\n";
  for (const PluginUsed& one : plugins_used(description, registry))
    std::cout << "  " << std::left << std::setw(10) << one.kind << std::setw(20) << one.name << one.version
              << (one.file.empty() ? "  built in" : "") << '\n';

  const unsigned threads = options.threads(), ranks = options.number("ranks");
  std::string note;  // of the sample
  Kernel kernel(at_first_instant(scene.document, [&] {
    Prepared prepared = prepare(live, registry, run_state(description, components));
    note = prepared.note;
    return Kernel(description, components, std::move(prepared), threads);
  }));
  if (options.device() != DeviceKind::none) check_stages_on_device(scene, kernel.state());
  at_first_instant(scene.document, [&] { kernel.find_forces(); });
  std::vector<ProbeGroup> probes;
  std::vector<FieldGroup> fields;
  for (const auto& [name, probe] : description.probes) {
    Observer observer(name, probe, components.probes.at(name), kernel.world());
    probes.push_back(observer.group());
    if (description.output.frames.never() || !observer.in_frames()) continue;
    observer.check_fields(kernel.world());
    if (auto one = fields_of(observer, kernel.world())) fields.push_back(std::move(*one));
  }
  SingleChannels(probes).check(scene.document, description.output);  // as in a run
  check_fields(scene.document, description, kernel.world());
  const std::size_t bodies = kernel.world().positions().size();

  if (!note.empty()) std::cout << "\nsample\n  " << note << '\n';
  std::cout << "\nbody state besides position, velocity and spin\n";
  for (const std::string& line : state_by_component(description, components)) std::cout << "  " << line << '\n';
  std::cout << "\norder of a step\n  neighbour search if due, contacts of pairs, wall contacts";
  for (const auto& [name, engine] : components.engines)
    if (engine->phase() == Phase::forces) std::cout << ", " << name;
  std::cout << ", probes, wall motion, integration";
  const char* before = " with ";
  for (const auto& [name, engine] : components.engines)
    if (engine->phase() == Phase::settings) std::cout << std::exchange(before, ", ") << name;
  before = "; removal by ";
  for (const auto& [name, engine] : components.engines)
    if (engine->phase() == Phase::removal) std::cout << std::exchange(before, ", ") << name;
  std::cout << "\n\nbodies: " << bodies << ", contacts of pairs at the start: " << kernel.contact_count() << '\n';
  const TimeStepDescription& wish = description.time_step;
  const double safe = wish.safety * kernel.critical_time_step();
  const Estimate expected = estimate(scene, components, kernel);
  const double dt = expected.dt, most_bodies = expected.most_bodies;
  const std::vector<ExpectedStage>& stages = expected.stages;
  at_first_instant(scene.document, [&] { check_ends(scene, dt); });
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (stages[i].arriving > 0)
      std::cout << "  " << stages[i].arriving << " more in the stage " << description.stages[i].name << '\n';
  for (const ExpectedStream& stream : expected_streams(description, components)) {
    std::cout << "  stream " << stream.name << " from the stage " << stream.stage << ": " << stream.rate << " 1/s";
    if (std::isfinite(stream.limit)) std::cout << ", " << stream.limit << " in all";
    std::cout << '\n';
  }
  for (const auto& [name, clump] : clumps_of(components))
    std::cout << "clumps " << name << ": "
              << body_count(description, name, components.body_kinds.at(name)) / clump.spheres << " of "
              << clump.spheres << " spheres each; errors: mass " << std::setprecision(2) << clump.errors.mass
              << ", centre " << clump.errors.centre << " of the enclosing radius, inertia " << clump.errors.inertia
              << std::setprecision(6) << '\n';
  std::cout << "time step: " << kernel.world().dt() << " s, critical " << kernel.critical_time_step()
            << " s at the start; ";
  if (!wish.value && kernel.world().dt() < safe)
    std::cout << wish.steps_per_impact << " steps per impact of two bodies; ";
  if (!wish.value && bodies > 0)
    std::cout << "shorter where bodies or walls are faster than "
              << number(max_displacement(wish, description.guards) * kernel.state().statistics.smallest_radius /
                        kernel.world().dt())
              << " m/s; ";
  std::cout << "updated as contacts change\n";
  const double memory_now = expected.memory_now, memory_dense = expected.memory_dense,
               memory_free = memory_now + available_memory();
  std::cout << "memory: " << bytes_text(memory_now) << " now, about " << bytes_text(memory_dense) << " when dense; "
            << bytes_text(memory_free) << " are available\n";
  if (ranks > 1)
    std::cout << "memory of each of " << ranks << " ranks: about " << bytes_text(bytes_of_rank(most_bodies, ranks))
              << " when dense\n";
  std::size_t triangles = 0;
  for (const auto& [name, geometry] : live.geometries().all()) triangles += geometry->triangles().size() / 3;
  const auto touching = static_cast<double>(kernel.world().contacts().size());
  print_frames(
      description, kernel,
      {.bodies = most_bodies, .contacts = std::max(touching, dense_contacts * most_bodies), .triangles = triangles},
      fields, stages, dt);
  std::cout << "\nstages\n";

  through_stages(description, scene.stages, [&](const SceneDescription& now, std::optional<std::size_t> i) {
    if (!i) return true;
    try {
      check_oscillations(now, now.time_step.value.value_or(dt));
    } catch (PlacedError& error) {
      error.begun(*i + 1);
      throw;
    }
    return true;
  });
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const ExpectedStage& stage = stages[i];
    std::cout << "  " << std::setw(16) << description.stages[i].name
              << (stage.known   ? ""
                  : stage.usual ? "usually "
                                : "at most ")
              << stage.shown() << " s, " << steps_text(stage.shown_steps()) << " steps";
    if (!stage.known)
      std::cout << " (ends by its condition" << (stage.usual ? fmt::format(", {:g} s at most", stage.most) : "") << ')';
    std::cout << '\n';
  }
  const double per_second =
      ranks * planning_speed(std::min(threads, std::max(1u, std::thread::hardware_concurrency())));
  const double least = expected.least_body_steps, most = expected.most_body_steps;
  const auto cost = [&](double body_steps) { return body_steps / per_second; };
  std::cout << "\nestimated time on " << (ranks > 1 ? std::to_string(ranks) + " ranks of " : "") << threads
            << (threads == 1 ? " thread" : " threads") << " at " << 1e-6 * per_second
            << " M particle-steps/s: " << hours_text(cost(least))
            << (expected.all_known ? "" : " at least (the end of a stage without typical_time is unknown)");
  if (most > least) std::cout << ", at most " << hours_text(cost(most)) << " if stages run to their limits";
  std::cout << '\n';
  std::vector<UnusedSetting> warnings;
  if (memory_dense > memory_free)
    warnings.push_back({"/bodies", "up to " + number(most_bodies) + " bodies need about " + bytes_text(memory_dense) +
                                       " of memory, and " + bytes_text(memory_free) + " are available"});
  for (const auto& warning : {unmoved_bodies(scene, kernel.world()), endless_fall(scene),
                              missed_floor(scene, kernel.world()), short_reach(kernel)})
    if (warning) warnings.push_back(*warning);
  std::ranges::move(tensile_targets(scene, live.geometries().all()), std::back_inserter(warnings));
  std::ranges::move(missed_targets(scene), std::back_inserter(warnings));
  std::ranges::move(fast_walls(scene, live.geometries().all(), kernel.state().statistics.smallest_radius),
                    std::back_inserter(warnings));
  std::ranges::move(soft_contacts(scene, kernel.world()), std::back_inserter(warnings));
  std::ranges::move(odd_densities(description), std::back_inserter(warnings));
  std::ranges::move(turned_walls(scene, kernel.world()), std::back_inserter(warnings));
  for (const auto& [pointer, why] : warnings) std::cout << "\nwarning\n  " << pointer << ": " << why << '\n';
  const SceneSource source{file, options.list("set"), registry};
  auto idle = without_effect(scene, components, kernel, source);
  const auto [studies, unreadable] = installed_studies();
  for (const std::string& why : unreadable) std::cerr << "grit: omitted: " << why << std::endl;
  const Description now = resolved(description);
  const auto same = [&](const std::vector<std::string>& more) {
    return resolved(*source.with(more).description) == now;
  };
  if (auto depth = excess_depth(scene, components, kernel.world(), scenario_type(Document::load(file)), studies, same))
    idle.push_back(std::move(*depth));
  if (!idle.empty()) std::cout << "\nwithout effect\n";
  for (const auto& [pointer, why] : idle) std::cout << "  " << pointer << ": " << why << '\n';
}

}  // namespace

void check_options(Options& options) {
  options.add_threads("threads assumed in the estimate of the run time");
  options.add()("ranks", boost::program_options::value<std::string>()->default_value("1")->value_name("N"),
                "processes assumed in the estimates, each with so many threads: see mpirun -n N grit run");
  options.add_device();
  options.add_set();
}

ExitStatus check_command(const Options& options) {
  if (options.words().empty()) throw UsageError("no description given; see 'grit check --help'");
  options.warn_of_threads();
  const auto registry = options.registry();
  for (const std::string& file : options.words()) {
    const Scene scene = load_scene(file, options.list("set"), *registry);
    at_its_place(scene.document, [&] { check_one(file, scene, options, *registry); });
  }
  return ExitStatus::done;
}

}  // namespace grit
