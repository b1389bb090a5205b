#include "energy.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

class EnergyWorld : public FakeWorld {
 public:
  Energies energy;
  Energies energies() const override { return energy; }
};

std::map<std::string, double> sampled(const World& world) {
  EnergyProbe probe;
  const ChannelValues values = sampled(probe, world);
  std::map<std::string, double> named;
  for (const Channel& channel : probe.channels()) named[channel.name] = values[channel.name];
  return named;
}

TEST(EnergyProbe, SaysEveryEntryOfTheLedger) {
  EnergyWorld world;
  world.energy = {.kinetic = 1,
                  .elastic_normal = 2,
                  .elastic_shear = 3,
                  .elastic_rolling = 4,
                  .gravitational = -5,
                  .walls = 6,
                  .cell = -12,
                  .engines = 22,
                  .settings = -7,
                  .friction = 8,
                  .rolling = 9,
                  .viscosity = 10,
                  .local_damping = 11,
                  .closure_error = -1};
  const std::map<std::string, double> expected{
      {"kinetic", 1},         {"elastic_normal", 2},   {"elastic_shear", 3},
      {"elastic_rolling", 4}, {"gravitational", -5},   {"work_of_walls", 6},
      {"work_of_cell", -12},  {"work_of_engines", 22}, {"settings", -7},
      {"friction", 8},        {"rolling", 9},          {"viscosity", 10},
      {"local_damping", 11},  {"closure_error", -1},   {"closure_fraction", -0.01}};
  EXPECT_EQ(sampled(world), expected);
}

TEST(EnergyProbe, AsksForTheLedger) {
  EXPECT_TRUE(EnergyProbe().needs().has(BodyState::energy));
  EXPECT_EQ(sampled(EnergyWorld()).at("closure_fraction"), 0) << "of nothing";
}

INSTANTIATE_TEST_SUITE_P(Energy, ProbeContract,
                         testing::Values(ProbeCase{"all", [] { return std::make_shared<EnergyProbe>(); }}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace grit
