// Simulations on several ranks have the same bits as on one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string_view>

#include "input/scene.hpp"
#include "simulation/parts.hpp"
#include "simulation/standard_registry.hpp"
#include "support/scene.hpp"
#include "support/thread_ranks.hpp"

namespace grit::test {
namespace {

using Bytes = std::vector<std::byte>;

/// A saved state without computing times, which differ from run to run.
Bytes without_times(Bytes state) {
  const auto part = [&](std::string_view name) {
    const auto found = std::ranges::search(state, std::as_bytes(std::span(name)));
    EXPECT_FALSE(found.empty()) << name;
    return found.begin();
  };
  const auto times = part("run time");
  state.erase(times, part("bodies"));
  return state;
}

const std::shared_ptr<const Registry>& registry() {
  static const std::shared_ptr<const Registry> all = standard_registry({}, "test");
  return all;
}

Document of_sims(const std::string& file) {
  return load_document(std::filesystem::path(GRIT_SOURCE_DIR) / "sims" / file, {}, *registry(), "test");
}

struct SharedRun {
  explicit SharedRun(const Document& document, Communicator* ranks = nullptr) {
    const auto opened = std::make_shared<OpenedScene>(registry(), read_scene(document, *registry()));
    parts = std::make_unique<Simulation::Parts>(opened, opened->prepare(BodyState::displacement), 1, nullptr, ranks);
    parts->progress.set([this](const Progress& now) { progress = now; }, 0);  // at each report
  }
  explicit SharedRun(const std::string& file, Communicator* ranks = nullptr) : SharedRun(of_sims(file), ranks) {}
  /// `search_every`: 0: where one is due.
  void steps(std::size_t count, std::size_t search_every = 0) {
    parts->start();
    for (; count > 0 && !parts->runner.done(); --count) {
      if (search_every > 0 && count % search_every == 0) parts->kernel.request_rebuild();
      static_cast<void>(parts->next(false));
    }
  }
  /// Of the first rank; nothing on others, which must call it, too.
  Bytes state() {
    Archive archive;
    parts->kernel.save(archive);
    return parts->kernel.is_first_rank() ? without_times(archive.bytes()) : Bytes();
  }
  std::unique_ptr<Simulation::Parts> parts;
  Progress progress;
};

// Clocks differ, so that a rank reports while others do not; so does one that fails alone.
TEST(SharedRun, EachRankReportsAlone) {
  on_ranks(2, [](Communicator& all) {
    SharedRun shared("column/quick.json", &all);
    shared.steps(9);
    EXPECT_GT(shared.progress.particle_steps_per_second, 0);
    if (all.rank() == 0) {
      const auto alone = shared.parts->kernel.alone();
      RunSummary summary;
      shared.parts->runner.fill(summary);
      EXPECT_EQ(summary.bodies, 1500u);
    }
  });
}

void expect_state(SharedRun& run, const Bytes& expected) {
  const Bytes found = run.state();
  if (run.parts->kernel.is_first_rank()) EXPECT_TRUE(found == expected);
}

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
    expect_state(shared, expected);
    const auto found = shared.parts->kernel.world().contacts();
    ASSERT_EQ(found.size(), contacts.size());
    for (std::size_t c = 0; c < found.size(); ++c)
      ASSERT_TRUE(found[c].a == contacts[c].a && found[c].b == contacts[c].b && found[c].force == contacts[c].force);
  });
}

// Every eighth search sorts bodies and divides them among the ranks again, by measured times.
TEST_P(SameBits, WhenBodiesMigrate) {
  constexpr std::size_t steps = 90, search_every = 2;
  SharedRun alone(GetParam());
  alone.steps(steps, search_every);
  const Bytes expected = alone.state();
  on_ranks(4, [&](Communicator& all) {
    SharedRun shared(GetParam(), &all);
    shared.steps(steps, search_every);
    expect_state(shared, expected);
  });
}

/// Grains that touch, move against each other and leave through an open bottom. Some touch a wall.
Document dense_flow() {
  constexpr double radius = 1e-3, spacing = 1.96e-3;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<Grain> grains;
  for (int x = 0; x < 14; ++x)
    for (int y = 0; y < 10; ++y)
      for (int z = 0; z < 12; ++z) {
        const Vec3 place(x + 0.5 + 0.02 * share(random), y + 0.03 + 0.02 * share(random), z + 0.2);
        const Vec3 velocity(share(random), share(random), -2 - x / 7.0);
        grains.push_back({spacing * place, radius * (1 + 0.02 * share(random)), velocity, 100 * velocity});
      }
  Description flow = description("linear-rolling",
                                 {{"density", 2600},
                                  {"contact_modulus", 1e6},
                                  {"friction_angle", 0.5},
                                  {"rolling_stiffness", 0.2},
                                  {"rolling_limit", 0.2}},
                                 grains);
  flow["domain"] = {{"low", {-spacing, 0, 0}},
                    {"high", {15 * spacing, 10 * spacing, 20 * spacing}},
                    {"periodic", {false, true, false}},
                    {"open_sides", {"-z", "+x", "+z"}}};
  flow["walls"]["left"] = plane(Vec3::Zero(), Vec3::UnitX());
  flow["guards"]["overlap"] = 0.9;
  flow["stages"][0]["until"]["value"] = 1000;
  return {flow, "test"};
}

// Histories of contacts go with their bodies; some bodies leave, others re-enter at a periodic side.
TEST(DenseFlow, HasTheSameBitsWhenBodiesMigrate) {
  constexpr std::size_t search_every = 3;
  const Document flow = dense_flow();
  for (const std::size_t steps : {10u, 120u}) {  // before bodies are sorted for the second time, and later
    SharedRun alone(flow);
    alone.steps(steps, search_every);
    const Bytes expected = alone.state();
    EXPECT_EQ(alone.parts->kernel.world().ids().size() < 1600, steps > 100);
    EXPECT_GT(alone.parts->kernel.world().contacts().size(), 1600u);
    EXPECT_FALSE(alone.parts->kernel.world().contacts_with_walls().empty());
    for (const unsigned count : {2u, 5u})
      on_ranks(count, [&](Communicator& all) {
        SharedRun shared(flow, &all);
        shared.steps(steps, search_every);
        expect_state(shared, expected);
      });
  }
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

/// Bodies of a cloud that is compressed, and collide for the first time.
Document collisions() {
  const std::string until = R"(/until={"type": "steps", "value": 60, "of": null})";
  return load_document(std::filesystem::path(GRIT_SOURCE_DIR) / "sims/simple-shear/quick.json",
                       {"/stages/0" + until, "/stages/1" + until}, *registry(), "test");
}

class SavedOnRanks : public testing::TestWithParam<const char*> {};

// What the first rank saves is the whole state, from which any number of ranks goes on.
TEST_P(SavedOnRanks, GoesOnWithAnotherNumber) {
  const bool dense = std::string_view(GetParam()) == "dense flow";
  const Document document = dense ? dense_flow() : collisions();
  constexpr std::size_t all_steps = 130;
  SharedRun alone(document);
  alone.steps(all_steps);
  const Bytes expected = alone.state();
  for (const std::size_t before : {35u, 70u, 105u}) {
    std::vector<std::byte> saved;
    on_ranks(2, [&](Communicator& all) {
      SharedRun shared(document, &all);
      shared.steps(before);
      const Checkpoint now = shared.parts->save();
      if (all.rank() == 0) saved = now.state;
    });
    // Some of seven ranks have no chunk.
    for (const unsigned count : {3u, 7u})
      on_ranks(count, [&](Communicator& all) {
        SharedRun resumed(document, &all);
        resumed.parts->resume({.stage = "", .time = 0, .step = 0, .state = saved});
        resumed.steps(all_steps - before);
        expect_state(resumed, expected);
      });
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SavedOnRanks, testing::Values("collisions", "dense flow"));

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
