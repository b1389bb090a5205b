#include "output/run_json.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <thread>

#include "grit/error.hpp"
#include "storage/atomic_file.hpp"
#include "storage/parsed_json.hpp"

namespace grit {
namespace {

std::string now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "unknown";
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

Description load_average() {
  std::array<double, 3> load{};
  const int count = getloadavg(load.data(), 3);
  return count == 3 ? Description(load) : Description();
}

/// CPU time of all threads of this process since its start.
double cpu_seconds() {
  timespec time{};
  return clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) == 0
             ? static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec)
             : 0;
}

Description traffic_facts(const Traffic& traffic) {
  return {{"messages", traffic.messages},
          {"bytes", traffic.bytes},
          {"gathers", traffic.gathers},
          {"gathered_bytes", traffic.gathered},
          {"seconds", traffic.seconds}};
}

}  // namespace

RunJson::RunJson(std::filesystem::path path, const RunFacts& facts) : path_(std::move(path)) {
  json_ = {{"status", "running"},
           {"message", ""},
           {"warnings", Description::array()},
           {"grit", grit_facts()},
           {"host",
            {{"name", host_name()},
             {"cpu", cpu_model()},
             {"cores", std::thread::hardware_concurrency()},
             {"load_average_at_start", load_average()}}},
           {"started", now()},
           {"resumed", 0},
           {"seed", facts.seed},
           {"threads", facts.threads},
           {"ranks", facts.ranks},
           {"engine", facts.engine},
           {"sharing", nullptr},
           {"stage", ""},
           {"time", 0.0},
           {"steps", 0},
           {"bodies", 0},
           {"clumps", Description::object()},
           {"time_step_s", nullptr},
           {"critical_time_step_s", nullptr},
           {"contacts_per_body", nullptr},
           {"wall_s", 0.0},
           {"cpu_s", 0.0},
           {"particle_steps_per_s", nullptr},
           {"rebuilds", nullptr},
           {"model", nullptr},
           {"phases_s", Description::object()},
           {"parallel_s", Description::object()},
           {"probes", Description::object()},
           {"stages", Description::array()},
           {"plugins", Description::array()},
           {"commands", facts.commands},
           {"source",
            {{"path", facts.source.path},
             {"written", facts.source.written},
             {"set", facts.source.sets},
             {"unexpanded", facts.source.unexpanded}}},
           {"references", facts.references},
           {"description", facts.description}};
  for (const auto& [group, clump] : facts.clumps)
    json_["clumps"][group] = {{"spheres", clump.spheres},
                              {"mass_error", clump.errors.mass},
                              {"centre_error", clump.errors.centre},
                              {"inertia_error", clump.errors.inertia}};
  for (const auto& used : facts.plugins) json_["plugins"].push_back(plugin_facts(used));
}

void RunJson::begin(const World& world, bool resumed) {
  if (resumed) {
    std::ifstream file(path_);
    const Description old = parsed_json({std::istreambuf_iterator<char>(file), {}});
    json_["resumed"] = (old.is_object() ? old.value("resumed", 0) : 0) + 1;
    json_["resumed_at_step"] = world.step();
  }
  progress(world);
  write();
}

void RunJson::serialize(Archive& archive) {
  std::string started = json_["started"], stages = json_["stages"].dump();
  double wall = wall_s(), cpu = cpu_s();
  archive(started, stages, wall, cpu);
  if (!archive.restoring()) return;
  json_["started"] = started, json_["stages"] = parsed_json(stages);
  if (!json_["stages"].is_array())
    throw Error("the saved state is damaged or was altered: its stages are no list; use another checkpoint");
  wall_before_ = wall, cpu_before_ = cpu;
}

void RunJson::stage_ended(const World& world, const std::string& what) {
  progress(world);
  json_["stages"].push_back({{"name", world.stage()},
                             {"reached", what},
                             {"bodies", world.ids().size()},
                             {"time", world.time()},
                             {"step", world.step()},
                             {"wall_s", json_["wall_s"]}});
  write();
}

void RunJson::finish(const World& world, const RunSummary& summary) {
  progress(world);
  json_["status"] = summary.status;
  json_["message"] = summary.message;
  json_["warnings"] = summary.warnings;
  json_["stage"] = summary.stage;
  json_["time"] = summary.time;
  json_["steps"] = summary.steps;
  json_["bodies"] = summary.bodies;
  json_["threads"] = summary.threads;
  json_["ranks"] = summary.ranks;
  if (summary.sharing)
    json_["sharing"] = {
        {"imbalance", summary.sharing->imbalance},       {"neighbours", summary.sharing->neighbours},
        {"shared_pairs", summary.sharing->shared_pairs}, {"independent_pairs", summary.sharing->independent_pairs},
        {"step", traffic_facts(summary.sharing->step)},  {"search", traffic_facts(summary.sharing->search)}};
  json_["time_step_s"] = summary.time_step;
  json_["critical_time_step_s"] = summary.critical_time_step;
  json_["contacts_per_body"] = summary.contacts_per_body;
  json_["wall_s"] = summary.wall_seconds;
  json_["particle_steps_per_s"] = summary.particle_steps_per_second;
  json_["rebuilds"] = summary.rebuilds;
  const Model& model = summary.model;
  json_["model"] = {{"lanes", model.lanes},
                    {"precision", model.precision},
                    {"law_parts", model.law_parts},
                    {"contact_state", model.contact_state},
                    {"body_state", model.body_state},
                    {"materials", model.materials},
                    {"one_material", model.one_material},
                    {"periodic", model.periodic},
                    {"walls", model.walls},
                    {"gravity", model.gravity},
                    {"local_damping", model.local_damping},
                    {"bytes", model.bytes}};
  for (const PhaseTime& phase : summary.phases) {
    json_["phases_s"][phase.name] = phase.seconds;
    json_["parallel_s"][phase.name] = phase.parallel;
  }
  for (const auto& [name, samples, seconds] : summary.probes)
    json_["probes"][name] = {{"samples", samples}, {"seconds", seconds}};
  json_["host"]["load_average_at_end"] = load_average();
  json_["ended"] = now();
  write();
}

void RunJson::progress(const World& world) {
  json_["stage"] = world.stage();
  json_["time"] = world.time();
  json_["steps"] = world.step();
  json_["time_step_s"] = world.dt();
  json_["bodies"] = world.ids().size();
  json_["wall_s"] = wall_s();
  json_["cpu_s"] = cpu_s();
}

double RunJson::wall_s() const {
  return wall_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

double RunJson::cpu_s() const { return cpu_before_ + cpu_seconds(); }

void RunJson::write() const {
  write_atomically(path_, json_.dump(2, ' ', false, Description::error_handler_t::replace) + '\n');
}

}  // namespace grit
