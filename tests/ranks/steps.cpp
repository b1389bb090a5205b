// Simulations on several ranks have the same bits as on one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "input/scene.hpp"
#include "simulation/parts.hpp"
#include "simulation/standard_registry.hpp"
#include "support/thread_ranks.hpp"

namespace grit::test {
namespace {

using Bytes = std::vector<std::byte>;

/// A saved state up to computing times, which differ from run to run.
Bytes without_times(Bytes state) {
  constexpr std::string_view times = "run time";
  const auto found = std::ranges::search(state, std::as_bytes(std::span(times)));
  EXPECT_FALSE(found.empty());
  state.erase(found.begin(), state.end());
  return state;
}

/// A simulation of a description of sims/.
struct SharedRun {
  explicit SharedRun(const std::string& file, Communicator* ranks = nullptr) {
    const std::shared_ptr<const Registry> registry = standard_registry({}, "test");
    const auto path = std::filesystem::path(GRIT_SOURCE_DIR) / "sims" / file;
    const auto opened =
        std::make_shared<OpenedScene>(registry, read_scene(load_document(path, {}, *registry, "test"), *registry));
    parts = std::make_unique<Simulation::Parts>(opened, opened->prepare({}), 1, nullptr, ranks);
  }
  void steps(std::size_t count) {
    parts->start();
    for (; count > 0 && !parts->runner.done(); --count) static_cast<void>(parts->next(false));
  }
  Bytes state() {
    Archive archive;
    parts->kernel.save(archive);
    return without_times(archive.bytes());
  }
  std::unique_ptr<Simulation::Parts> parts;
};

class SameBits : public testing::TestWithParam<const char*> {};

TEST_P(SameBits, OnThreeRanks) {
  constexpr std::size_t steps = 60;
  SharedRun alone(GetParam());
  alone.steps(steps);
  const Bytes expected = alone.state();
  const auto contacts = alone.parts->kernel.world().contacts();
  on_ranks(3, [&](Communicator& all) {
    SharedRun shared(GetParam(), &all);
    shared.steps(steps);
    EXPECT_TRUE(shared.state() == expected) << "rank " << all.rank();
    const auto found = shared.parts->kernel.world().contacts();
    ASSERT_EQ(found.size(), contacts.size());
    for (std::size_t c = 0; c < found.size(); ++c)
      ASSERT_TRUE(found[c].a == contacts[c].a && found[c].b == contacts[c].b && found[c].force == contacts[c].force);
  });
}

// Walls with servos; a periodic cell that deforms by its stresses; clumps; gravity and an outlet.
INSTANTIATE_TEST_SUITE_P(Scenes, SameBits,
                         testing::Values("direct-shear/quick.json", "simple-shear/quick.json",
                                         "interface-shear/quick-clumps-rn-050.json", "silo-discharge/quick.json"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::erase_if(name, [](char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

// What a rank saves is the whole state, from which any number of ranks goes on.
TEST(SavedOnRanks, GoesOnWithAnotherNumber) {
  const std::string file = "simple-shear/quick.json";
  SharedRun alone(file);
  alone.steps(60);
  const Bytes expected = alone.state();
  std::vector<std::byte> saved;
  on_ranks(2, [&](Communicator& all) {
    SharedRun shared(file, &all);
    shared.steps(35);
    const Checkpoint now = shared.parts->save();
    if (all.rank() == 0) saved = now.state;
  });
  on_ranks(3, [&](Communicator& all) {
    SharedRun resumed(file, &all);
    resumed.parts->resume({.stage = "", .time = 0, .step = 0, .state = saved});
    resumed.steps(25);
    EXPECT_TRUE(resumed.state() == expected) << "rank " << all.rank();
  });
}

TEST(RanksAlone, CannotAskForOthers) {
  on_ranks(2, [&](Communicator& all) {
    SharedRun shared("direct-shear/quick.json", &all);
    shared.steps(3);
    const auto alone = shared.parts->kernel.alone();
    EXPECT_THROW(static_cast<void>(shared.parts->kernel.world().positions()), std::logic_error);
  });
}

}  // namespace
}  // namespace grit::test
