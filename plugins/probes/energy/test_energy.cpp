#include "energy.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

class LedgerWorld : public FakeWorld {
 public:
  EnergyLedger ledger;
  EnergyLedger energies() const override { return ledger; }
};

std::map<std::string, double> sampled(const World& world) {
  EnergyProbe probe;
  const auto channels = probe.channels();
  std::vector<double> numbers(channels.size());
  std::vector<std::span<double>> spans;
  for (double& number : numbers) spans.emplace_back(&number, 1);
  probe.sample(world, spans);
  std::map<std::string, double> named;
  for (std::size_t i = 0; i < channels.size(); ++i) named[channels[i].name] = numbers[i];
  return named;
}

TEST(EnergyProbe, SaysEveryEntryOfTheLedger) {
  LedgerWorld world;
  world.ledger = {.kinetic = 1,
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
      {"kinetic", 1},        {"elastic_normal", 2}, {"elastic_shear", 3},    {"elastic_rolling", 4},
      {"gravitational", -5}, {"work_of_walls", 6},  {"work_of_cell", -12},   {"work_of_engines", 22},
      {"settings", -7},      {"friction", 8},       {"rolling", 9},          {"viscosity", 10},
      {"local_damping", 11}, {"closure_error", -1}, {"closure_share", -0.01}};
  EXPECT_EQ(sampled(world), expected);
}

TEST(EnergyProbe, AsksForTheLedger) {
  EXPECT_TRUE(EnergyProbe().needs().has(BodyState::energy));
  EXPECT_EQ(sampled(LedgerWorld()).at("closure_share"), 0) << "of nothing";
}

INSTANTIATE_TEST_SUITE_P(Energy, ProbeContract,
                         testing::Values(ProbeCase{"all", [] { return std::make_shared<EnergyProbe>(); }}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace grit
