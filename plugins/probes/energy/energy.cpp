// One channel an entry of the ledger. See README.md.
#include "energy.hpp"

#include <cmath>

#include "grit/plugin.hpp"

namespace grit {
namespace {

struct Entry {
  const char *name, *doc;
  double EnergyLedger::*member;
};

constexpr Entry entries[] = {
    {"kinetic", "translation and rotation of all bodies", &EnergyLedger::kinetic},
    {"elastic_normal", "stored in normal springs", &EnergyLedger::elastic_normal},
    {"elastic_shear", "stored in shear springs", &EnergyLedger::elastic_shear},
    {"elastic_rolling", "stored in rolling and twisting springs", &EnergyLedger::elastic_rolling},
    {"gravitational", "against the first sample, higher is more", &EnergyLedger::gravitational},
    {"work_of_walls", "done by walls since the first sample", &EnergyLedger::walls},
    {"work_of_cell", "done by the straining of a periodic cell since the first sample", &EnergyLedger::cell},
    {"work_of_engines", "done by engines that add forces, and by what holds bodies, since the first sample",
     &EnergyLedger::engines},
    {"settings", "put in by changes of the description since the first sample", &EnergyLedger::settings},
    {"friction", "dissipated by slip since the first sample", &EnergyLedger::friction},
    {"rolling", "dissipated by rolling and twisting beyond their limits since the first sample",
     &EnergyLedger::rolling},
    {"viscosity", "dissipated by dashpots since the first sample", &EnergyLedger::viscosity},
    {"local_damping", "dissipated by local damping since the first sample", &EnergyLedger::local_damping},
    {"closure_error", "what there is and was dissipated, less what there was and was put in",
     &EnergyLedger::closure_error},
};

}  // namespace

std::vector<Channel> EnergyProbe::channels() const {
  std::vector<Channel> channels;
  for (const Entry& entry : entries) channels.push_back({entry.name, "J", entry.doc, {}});
  channels.push_back({"closure_share",
                      "1",
                      "closure error over all that was stored, put in or dissipated; 0 where that is nothing",
                      {}});
  return channels;
}

void EnergyProbe::sample(const World& world, std::span<const std::span<double>> values) {
  const EnergyLedger ledger = world.energies();
  auto value = values.begin();
  for (const Entry& entry : entries) *(value++)->data() = ledger.*entry.member;
  const double turnover = ledger.kinetic + ledger.elastic() + std::abs(ledger.gravitational) + std::abs(ledger.walls) +
                          std::abs(ledger.cell) + std::abs(ledger.engines) + std::abs(ledger.settings) +
                          ledger.dissipated();
  *value->data() = turnover > 0 ? ledger.closure_error / turnover : 0;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "probe",
      .name = "energy",
      .version = "1.0.0",
      .doc = "ledger of energies: stored, put in, dissipated, and the error of its closure",
      .make_probe = []() -> grit::Probe* { return new grit::EnergyProbe; }};
  return &info;
}
