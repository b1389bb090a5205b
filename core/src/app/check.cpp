#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <thread>
#include <utility>

#include "app/options.hpp"
#include "app/progress_bar.hpp"
#include "app/run_setup.hpp"
#include "bodies/make_bodies.hpp"
#include "description/current_scene.hpp"
#include "format/duration.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"
#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "lint/excess_depth.hpp"
#include "lint/installed_studies.hpp"
#include "lint/repeated_geometry.hpp"
#include "lint/unmoved_bodies.hpp"
#include "lint/unused_materials.hpp"
#include "lint/unused_motions.hpp"
#include "lint/unused_scenario_parameters.hpp"
#include "lint/unused_settings.hpp"
#include "output/named_fields.hpp"
#include "output/single_channels.hpp"
#include "run/observer.hpp"
#include "simulation/first_instant.hpp"
#include "simulation/live_scene.hpp"
#include "simulation/prepared_sample.hpp"

namespace grit {
namespace {

// Optimistic planning value: dense packings reach 4 to 5 M particle-steps/s on one core of an AMD EPYC (Zen 3).
constexpr double planning_speed = 6e6;
// A cloud has no contacts yet; in a dense packing the critical step of the same grains is about this fraction of the
// cloud's.
constexpr double dense_step_fraction = 0.6;

/// Simulated duration of a stage [s]: known from its description, or between its typical time and its limit.
struct StageTime {
  double least = 0, most = 0;
  bool known = false, usual = false;
};

StageTime stage_time(const StageDescription& stage, const SceneDescription& scene) {
  const auto& condition = stage.until.is.value();
  if (const auto* time = std::get_if<TimeCondition>(&condition)) return {time->value, time->value, true};
  if (const auto* displacement = std::get_if<DisplacementCondition>(&condition)) {
    const MotionDescription& motion = scene.walls.at(displacement->wall).motion;
    const int axis = displacement->axis[0] - 'x';
    const double speed = motion.velocity[axis];
    const bool swings = motion.oscillation && motion.oscillation->amplitude[axis] != 0;
    if (speed != 0 && !swings) {
      const double takes = std::abs(displacement->value / speed) + 0.5 * motion.ramp_time;
      return {takes, takes, true};
    }
  }
  return {stage.typical_time.value_or(0), stage.limit, false, stage.typical_time.has_value()};
}

void check_one(const std::string& file, const Scene& scene, const Options& options, const Registry& registry) {
  const SceneDescription& description = *scene.description;
  const LiveScene live(scene);
  const Components& components = live.components();
  std::cout << file << ": " << description.title << "\n\ncomponents\n";
  for (const PluginUsed& one : plugins_used(description, registry))
    std::cout << "  " << std::left << std::setw(10) << one.kind << std::setw(20) << one.name << one.version
              << (one.file.empty() ? "  built in" : "") << '\n';

  const unsigned threads = options.threads();
  Kernel kernel(at_first_instant(scene.document, [&] {
    return Kernel(description, components, prepare(live, registry, run_state(description, components)), threads);
  }));
  at_first_instant(scene.document, [&] { kernel.find_forces(); });
  std::vector<ProbeGroup> probes;
  for (const auto& [name, probe] : description.probes)
    probes.push_back(Observer(name, probe, components.probes.at(name), kernel.world()).group());
  SingleChannels(probes).check(scene.document, description.output);  // as in a run
  check_fields(scene.document, description, kernel.world());
  const std::size_t bodies = kernel.world().positions().size();

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
  std::cout << "\n\nbodies: " << bodies << ", contacts of pairs at the start: " << kernel.state().pairs.touching_count()
            << '\n';
  std::map<std::string, std::size_t> coming;  // by stage
  std::size_t all_bodies = bodies;
  for (const auto& [name, group] : description.bodies) {
    if (group.stage.empty()) continue;
    const std::size_t count = body_count(description, name, components.body_kinds.at(name));
    all_bodies += count, coming[group.stage] += count;
  }
  for (const StageDescription& stage : description.stages)
    if (coming.contains(stage.name))
      std::cout << "  " << coming[stage.name] << " more in the stage " << stage.name << '\n';
  for (const auto& [name, clump] : clumps_of(components))
    std::cout << "clumps " << name << ": "
              << body_count(description, name, components.body_kinds.at(name)) / clump.spheres << " of "
              << clump.spheres << " spheres each; errors: mass " << std::setprecision(2) << clump.errors.mass
              << ", centre " << clump.errors.centre << " of the enclosing radius, inertia " << clump.errors.inertia
              << std::setprecision(6) << '\n';
  const TimeStepDescription& wish = description.time_step;
  const double safe = wish.safety * kernel.critical_time_step();
  std::cout << "time step: " << kernel.world().dt() << " s, critical " << kernel.critical_time_step()
            << " s at the start; ";
  if (!wish.value && kernel.world().dt() < safe)
    std::cout << wish.steps_per_impact << " steps per impact of two bodies; ";
  std::cout << "updated as contacts change\n";
  std::cout << "memory: " << std::lround(1e-6 * static_cast<double>(kernel.state().bytes())) + 1 << " MB now, about "
            << std::lround(1e-6 * 700.0 * static_cast<double>(all_bodies)) + 1 << " MB when dense\n\nstages\n";

  const bool cloud = kernel.state().pairs.touching_count() * 2 < bodies;
  const double dt =
      cloud && !wish.value ? std::min(kernel.world().dt(), dense_step_fraction * safe) : kernel.world().dt();
  double least = 0, most = 0;  // s times bodies
  std::size_t present = bodies;
  std::vector<StageTime> times;
  through_stages(description, scene.stages, [&](const SceneDescription& now, std::optional<std::size_t> i) {
    if (!i) return true;
    try {
      check_oscillations(now, dt);
    } catch (PlacedError& error) {
      error.begun(*i + 1);
      throw;
    }
    if (times.size() == *i) times.push_back(stage_time(description.stages[*i], now));
    return true;
  });
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const StageDescription& stage = description.stages[i];
    const StageTime& time = times[i];
    present += coming[stage.name];
    least += time.least * static_cast<double>(present), most += time.most * static_cast<double>(present);
    const double shown = time.known || time.usual ? time.least : time.most;
    std::cout << "  " << std::setw(16) << stage.name
              << (time.known   ? ""
                  : time.usual ? "usually "
                               : "at most ")
              << shown << " s, " << std::llround(shown / dt) << " steps";
    if (!time.known)
      std::cout << " (ends by its condition" << (time.usual ? fmt::format(", {:g} s at most", time.most) : "") << ')';
    std::cout << '\n';
  }
  const double per_second = planning_speed * std::min(threads, std::max(1u, std::thread::hardware_concurrency()));
  const auto cost = [&](double body_seconds) { return body_seconds / dt / per_second; };
  std::cout << "\nestimated time on " << threads << (threads == 1 ? " thread" : " threads") << " at "
            << 1e-6 * per_second << " M particle-steps/s: " << std::fixed << std::setprecision(2) << cost(least) / 3600
            << " h (" << duration_text(cost(least)) << ')';
  if (most > least)
    std::cout << ", at most " << cost(most) / 3600 << " h (" << duration_text(cost(most))
              << ") if stages run to their limits";
  std::cout << '\n' << std::defaultfloat << std::setprecision(6);
  if (const auto warning = unmoved_bodies(scene, kernel.world()))
    std::cout << "\nwarning\n  " << warning->pointer << ": " << warning->why << '\n';
  auto idle = unused_settings(scene, components, kernel);
  std::ranges::move(unused_motions(scene), std::back_inserter(idle));
  const auto sets = options.list("set");
  const Description now = resolved(description);
  const auto same = [&](const std::vector<std::string>& more) {
    auto all = sets;
    all.insert(all.end(), more.begin(), more.end());
    return resolved(*load_scene(file, all, registry).description) == now;
  };
  Document written = Document::load(file);
  for (const std::string& set : sets) written.set(set);
  const auto is_written = [&](const std::string& pointer) {
    return written.json().contains(Description::json_pointer(pointer));
  };
  for (UnusedSetting& one : unused_materials(scene, is_written)) {
    // Skips values that are listed already, or belong to something that is.
    if (std::ranges::none_of(idle, [&](const UnusedSetting& known) {
          return known.pointer == one.pointer || one.pointer.starts_with(known.pointer + '/');
        }))
      idle.push_back(std::move(one));
  }
  std::ranges::move(repeated_geometry(scene, is_written), std::back_inserter(idle));
  std::ranges::move(unused_scenario_parameters(written, same), std::back_inserter(idle));
  const auto [studies, unreadable] = installed_studies();
  for (const std::string& why : unreadable) std::cerr << "grit: omitted: " << why << std::endl;
  if (auto depth = excess_depth(scene, components, kernel.world(), scenario_type(Document::load(file)), studies, same))
    idle.push_back(std::move(*depth));
  if (!idle.empty()) std::cout << "\nwithout effect\n";
  for (const auto& [pointer, why] : idle) std::cout << "  " << pointer << ": " << why << '\n';
}

}  // namespace

ExitStatus check_command(const std::vector<std::string>& words) {
  Options options(command("check"));
  options.add_threads("threads assumed in the estimate of the run time");
  options.add_set();
  if (!options.read(words)) return ExitStatus::done;
  if (options.words().empty()) throw UsageError("no description given; see 'grit check --help'");
  options.threads();
  const auto registry = options.registry();
  for (const std::string& file : options.words()) {
    const Scene scene = load_scene(file, options.list("set"), *registry);
    at_its_place(scene.document, [&] { check_one(file, scene, options, *registry); });
  }
  return ExitStatus::done;
}

}  // namespace grit
