// Streams: bodies that enter during a run, at their rate, without overlaps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/clump.hpp"
#include "support/notes.hpp"
#include "support/scene.hpp"

namespace grit::test::streams_tests {
namespace {

using testing::HasSubstr;

constexpr double radius = 1e-3, density = 2600;

/// A stream through a rectangle of 2 cm × 2 cm at a height of 5 cm.
Description stream(const Description& keys) {
  Description d = description("linear-frictional", {{"density", density}, {"contact_modulus", 1e6}}, {});
  Description& source = d["bodies"]["grains"]["source"];
  source = keys;
  source["type"] = "stream";
  if (!source.contains("region"))
    source["region"] = {
        {"type", "rectangle"}, {"corner", {0, 0, 0.05}}, {"edge_a", {0.02, 0, 0}}, {"edge_b", {0, 0.02, 0}}};
  if (!source.contains("sizes")) source["sizes"] = {{"type", "uniform"}, {"smallest", 1.5e-3}, {"largest", 2e-3}};
  d["bodies"]["grains"]["velocity"] = {0, 0, -0.5};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  return d;
}
void begin(Trial& t) { t.begin_stage(0, "only"); }

TEST(Stream, HasItsRateAtEveryStep) {
  Trial t(stream({{"number_rate", 200}}));
  begin(t);
  while (t.world().time() < 0.2) {
    t.step();
    const double due = std::floor(200 * t.world().time());
    ASSERT_NEAR(static_cast<double>(t.world().positions().size()), due, 1) << t.world().time();
  }
  EXPECT_GE(t.world().positions().size(), 39u);
}

TEST(Stream, ByMassHasItsRate) {
  const double mass = density * 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  Trial t(stream({{"mass_rate", 200 * mass}, {"sizes", {{"type", "list"}, {"diameters", {2e-3, 1e-3}}}}}));
  begin(t);
  while (t.world().time() < 0.1) t.step();
  double entered = 0;
  for (const Row& v : t.world().velocities()) entered += 1 / v.w;
  EXPECT_NEAR(entered, 200 * mass * t.world().time(), mass);
  EXPECT_LE(entered, 200 * mass * t.world().time() * (1 + 1e-9));
}

TEST(Stream, EndsAtItsLimits) {
  const auto entered = [](Description keys) {
    keys["number_rate"] = 1000;
    Trial t(stream(keys));
    begin(t);
    while (t.world().time() < 0.05) t.step();
    return t.world().positions().size();
  };
  EXPECT_EQ(entered({{"count", 7}}), 7u);
  EXPECT_EQ(entered({{"time", 0.0205}}), 20u);
  const double mass = density / 6 * std::numbers::pi * 8e-9;
  EXPECT_EQ(entered({{"mass", 10.5 * mass}, {"sizes", {{"type", "list"}, {"diameters", {2e-3}}}}}), 10u);
}

TEST(Stream, IsCountedBeyondAllIntegers) {
  const Scene scene = scene_of(stream({{"number_rate", 200}, {"mass", 1e300}}));
  const std::shared_ptr<const BodyKind> kind = scene.description->bodies.at("grains").kind.make();
  EXPECT_EQ(body_count(*scene.description, "grains", kind), 1'000'000'000'000'000u);
}

TEST(Stream, BodiesNeverOverlapWhenTheyEnter) {
  // A dense stream into a box that fills up: from some time on bodies wait.
  Description d = stream({{"number_rate", 20000}});
  d["walls"]["box"] = {{"type", "box"},
                       {"low", {0, 0, 0.03}},
                       {"high", {0.02, 0.02, 0.06}},
                       {"open", {"z_high"}},
                       {"material", "grain"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  Trial t(d);
  begin(t);
  std::size_t before = 0;
  while (t.world().time() < 0.1) {
    t.step();
    // At the instant at which bodies enter they touch nothing.
    for (const Contact& contact : t.world().contacts()) {
      const auto entered = [&](std::uint32_t body) { return t.world().ids()[body] >= before; };
      ASSERT_FALSE(entered(contact.a) || (!contact.with_wall && entered(contact.b))) << t.world().time();
    }
    before = t.world().positions().size();  // none leaves
  }
  EXPECT_GT(before, 500u);
  EXPECT_LT(before, 1990u);
  EXPECT_THAT(t.kernel().waiting_bodies(), HasSubstr("bodies of the stream \"grains\" wait for room"));
}

// At one neighbour search bodies enter and others leave, across the borders of chunks of bodies.
TEST(Stream, EntersWhileOthersLeave) {
  Description d = stream({{"number_rate", 40000}});
  d["engines"]["sink"] = {{"type", "sink"}, {"region", {{"type", "half-space"}, {"point", {0, 0, 0.03}}}}};
  d["walls"]["plate"] = {{"type", "rectangle"},
                         {"corner", {-0.01, -0.01, 0.035}},
                         {"edge_a", {0.02, 0, 0}},
                         {"edge_b", {0, 0.02, 0}},
                         {"material", "grain"}};
  Trial t(d);
  begin(t);
  while (t.world().time() < 0.2) t.step();
  const std::size_t there = t.world().positions().size(), left = t.world().departures().size();
  EXPECT_GT(there, 256u) << "more than a chunk";
  EXPECT_GT(left, 1000u);
  EXPECT_EQ(there + left, t.kernel().state().bodies.ids_given);
}

TEST(Stream, EntersInItsRegionAtItsVelocity) {
  const auto check = [](const Description& region, auto inside) {
    Trial t(stream({{"number_rate", 5000}, {"region", region}}));
    begin(t);
    std::size_t before = 0;
    for (int step = 0; step < 3000; ++step) {
      t.step();
      const auto ids = t.world().ids();
      for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i] < before) continue;
        const Vec3 x = t.position(ids[i]), v = t.velocity(ids[i]);
        EXPECT_TRUE(inside(x)) << x.transpose();
        EXPECT_NEAR(v.z(), -0.5, 0.03);
      }
      before = std::max<std::size_t>(before, ids.empty() ? 0 : *std::ranges::max_element(ids) + 1);
    }
    EXPECT_GT(before, 5u);
  };
  check({{"type", "disc"}, {"centre", {0, 0, 0}}, {"normal", {0, 1, 0}}, {"radius", 0.02}},
        [](const Vec3& x) { return std::hypot(x.x(), x.z()) < 0.0203 && std::abs(x.y()) < 1e-12; });
  check({{"type", "box"}, {"low", {0, 0, 0}}, {"high", {0.02, 0.01, 0.03}}}, [](const Vec3& x) {
    return x.x() > 7e-4 && x.x() < 0.0193 && x.y() > 7e-4 && x.y() < 0.0093 && x.z() > 0 && x.z() < 0.0293;
  });
}

TEST(Stream, KeepsTheEnergyBalance) {
  Description d = stream({{"number_rate", 2000}, {"count", 40}});
  Trial t(d, 1, BodyState::energy);
  begin(t);
  static_cast<void>(t.world().energies());
  while (t.world().time() < 0.04) t.step();
  const Energies now = t.world().energies();
  EXPECT_GT(now.kinetic, 0);
  EXPECT_NEAR(now.closure_error / now.kinetic, 0, 1e-9);
}

TEST(Stream, OfClumps) {
  Description d = stream({{"number_rate", 1000}, {"count", 20}});
  make_clumps(d, boomerang());
  Trial t(d);
  begin(t);
  while (t.world().time() < 0.03) t.step();
  EXPECT_EQ(t.world().clumps().size(), 20u);
}

TEST(Stream, RegionMustBeInsideTheDomain) {
  Description d = stream({{"number_rate", 1000}});
  d["domain"] = {{"low", {0, 0, 0}}, {"high", {0.01, 0.1, 0.1}}};
  EXPECT_THAT([&] { Started started(scene_of(d)); },
              testing::ThrowsMessage<Error>(HasSubstr("the region of the stream leaves the domain along x")));
}

TEST(Stream, ThatIsBlockedIsReported) {
  // A tray 1 mm below the region: it fills, and nothing else has room above.
  Description d = stream({{"number_rate", 20000}, {"sizes", {{"type", "list"}, {"diameters", {1.5e-3}}}}});
  d["walls"]["tray"] = {{"type", "rectangle"},
                        {"corner", {-0.01, -0.01, 0.049}},
                        {"edge_a", {0.04, 0, 0}},
                        {"edge_b", {0, 0.04, 0}},
                        {"material", "grain"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  d["stages"][0] = {{"name", "pour"}, {"until", {{"type", "time"}, {"value", 0.03}}}, {"limit", 1}};
  const std::string advice =
      "bodies of the stream \"grains\" find no room, the next with a diameter of 0.0015 m in a region 0.02 m wide: "
      "enlarge the region (/bodies/grains/source/region), move it away from walls and bodies, or let fewer enter";
  const Done poured = run(d);
  EXPECT_EQ(poured.summary().status, "done");
  EXPECT_THAT(poured.summary().warnings, testing::ElementsAre(HasSubstr(advice)));
  d["stages"][0]["until"] = {{"type", "steps"}, {"value", 1000000}};
  d["stages"][0]["limit"] = 0.03;
  const Done late = run(d);
  EXPECT_EQ(late.summary().status, "failed");
  EXPECT_THAT(late.summary().message,
              testing::AllOf(HasSubstr("wait for room"), HasSubstr(advice), testing::Not(HasSubstr("more time"))));
  EXPECT_THAT(late.summary().warnings, testing::IsEmpty()) << "the message has it";

  Description sparse = stream({{"number_rate", 200}});
  sparse["stages"][0] = {{"name", "pour"}, {"until", {{"type", "time"}, {"value", 0.03}}}, {"limit", 1}};
  EXPECT_THAT(run(sparse).summary().warnings, testing::IsEmpty());
}

TEST(Stream, RegionMustBeAsWideAsTheLargestBody) {
  const auto start = [](const Description& region, const Description& sizes) {
    Started started(scene_of(stream({{"number_rate", 1000}, {"region", region}, {"sizes", sizes}})));
  };
  const Description metres = {{"type", "uniform"}, {"smallest", 3}, {"largest", 5}};
  const Description disc = {{"type", "disc"}, {"centre", {0, 0, 0}}, {"radius", 0.012}},
                    slot = {{"type", "rectangle"},
                            {"corner", {0, 0, 0}},
                            {"edge_a", {0.02, 0, 0}},
                            {"edge_b", {0, 1e-4, 0}}},
                    box = {{"type", "box"}, {"low", {0, 0, 0}}, {"high", {0.01, 0.02, 0.03}}};
  const auto refusal = [](const std::string& width, const std::string& diameter) {
    return testing::ThrowsMessage<Error>(HasSubstr("found a region of a stream " + width +
                                                   " m wide, for bodies of up to " + diameter + " m in diameter"));
  };
  EXPECT_THAT([&] { start(disc, metres); }, refusal("0.024", "5"));
  EXPECT_THAT([&] { start(slot, metres); }, refusal("0.02", "5"));
  EXPECT_THAT([&] { start(box, {{"type", "list"}, {"diameters", {0.01, 0.031, 0.02}}}); }, refusal("0.03", "0.031"));
  EXPECT_NO_THROW(start(box, {{"type", "list"}, {"diameters", {0.03}}}));
  EXPECT_NO_THROW(start(slot, {{"type", "list"}, {"diameters", {0.02}}})) << "a slot for a plane scene";
}

}  // namespace
}  // namespace grit::test::streams_tests
