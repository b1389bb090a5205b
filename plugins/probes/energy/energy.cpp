// One channel an entry of the energy balance. See README.md.
#include "energy.hpp"

#include <cmath>

#include "grit/plugin.hpp"

namespace grit {
namespace {

struct Entry {
  const char *name, *doc;
  double Energies::*member;
};

constexpr Entry entries[] = {
    {"kinetic", "kinetic energy of translation and rotation of all bodies", &Energies::kinetic},
    {"elastic_normal", "elastic energy of normal springs", &Energies::elastic_normal},
    {"elastic_shear", "elastic energy of shear springs", &Energies::elastic_shear},
    {"elastic_rolling", "elastic energy of rolling and twisting springs", &Energies::elastic_rolling},
    {"gravitational", "potential energy relative to the first sample", &Energies::gravitational},
    {"work_of_walls", "work of walls since the first sample", &Energies::walls},
    {"work_of_cell", "work of the deforming cell since the first sample", &Energies::cell},
    {"work_of_engines", "work of engines that add forces or hold bodies, since the first sample", &Energies::engines},
    {"settings", "energy added by changes of the description since the first sample", &Energies::settings},
    {"friction", "energy dissipated by slip since the first sample", &Energies::friction},
    {"rolling", "energy dissipated by rolling and twisting at their limits since the first sample", &Energies::rolling},
    {"viscosity", "energy dissipated by dashpots and by bonds that break since the first sample", &Energies::viscosity},
    {"local_damping", "energy dissipated by local damping since the first sample", &Energies::local_damping},
    {"closure_error", "stored and dissipated energy, less initial energy and work", &Energies::closure_error},
};

}  // namespace

std::vector<Channel> EnergyProbe::channels() const {
  std::vector<Channel> channels;
  for (const Entry& entry : entries) channels.push_back({entry.name, "J", entry.doc, {}});
  channels.push_back(
      {"closure_fraction", "1", "closure error over all stored, added and dissipated energy; 0 if there is none", {}});
  return channels;
}

void EnergyProbe::sample(const World& world, ChannelValues& values) {
  const Energies energies = world.energies();
  for (const Entry& entry : entries) values[entry.name] = energies.*entry.member;
  const double turnover = energies.kinetic + energies.elastic() + std::abs(energies.gravitational) +
                          std::abs(energies.walls) + std::abs(energies.cell) + std::abs(energies.engines) +
                          std::abs(energies.settings) + energies.dissipated();
  values["closure_fraction"] = turnover > 0 ? energies.closure_error / turnover : 0;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "energy",
                                     .version = "1.0.0",
                                     .doc = "energy balance: stored, put in, dissipated, and the error of its closure",
                                     .make_probe = []() -> grit::Probe* { return new grit::EnergyProbe; }};
  return &info;
}
