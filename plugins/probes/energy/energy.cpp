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
    {"kinetic", "translation and rotation of all bodies", &Energies::kinetic},
    {"elastic_normal", "stored in normal springs", &Energies::elastic_normal},
    {"elastic_shear", "stored in shear springs", &Energies::elastic_shear},
    {"elastic_rolling", "stored in rolling and twisting springs", &Energies::elastic_rolling},
    {"gravitational", "against the first sample, higher is more", &Energies::gravitational},
    {"work_of_walls", "done by walls since the first sample", &Energies::walls},
    {"work_of_cell", "done by the straining of a periodic cell since the first sample", &Energies::cell},
    {"work_of_engines", "done by engines that add forces, and by what holds bodies, since the first sample",
     &Energies::engines},
    {"settings", "put in by changes of the description since the first sample", &Energies::settings},
    {"friction", "dissipated by slip since the first sample", &Energies::friction},
    {"rolling", "dissipated by rolling and twisting beyond their limits since the first sample",
     &Energies::rolling},
    {"viscosity", "dissipated by dashpots since the first sample", &Energies::viscosity},
    {"local_damping", "dissipated by local damping since the first sample", &Energies::local_damping},
    {"closure_error", "what there is and was dissipated, less what there was and was put in",
     &Energies::closure_error},
};

}  // namespace

std::vector<Channel> EnergyProbe::channels() const {
  std::vector<Channel> channels;
  for (const Entry& entry : entries) channels.push_back({entry.name, "J", entry.doc, {}});
  channels.push_back({"closure_fraction",
                      "1",
                      "closure error over all that was stored, put in or dissipated; 0 where that is nothing",
                      {}});
  return channels;
}

void EnergyProbe::sample(const World& world, ChannelValues& values) {
  const Energies energies = world.energies();
  for (const Entry& entry : entries) values[entry.name] = energies.*entry.member;
  const double turnover = energies.kinetic + energies.elastic() + std::abs(energies.gravitational) + std::abs(energies.walls) +
                          std::abs(energies.cell) + std::abs(energies.engines) + std::abs(energies.settings) +
                          energies.dissipated();
  values["closure_fraction"] = turnover > 0 ? energies.closure_error / turnover : 0;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "probe",
      .name = "energy",
      .version = "1.0.0",
      .doc = "energy balance: stored, put in, dissipated, and the error of its closure",
      .make_probe = []() -> grit::Probe* { return new grit::EnergyProbe; }};
  return &info;
}
