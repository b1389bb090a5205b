// Values that plugins must not return: the message names the plugin, the function, the value and what is allowed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "grit/error.hpp"
#include "grit/testing/fake_world.hpp"
#include "plugins/guarded.hpp"
#include "plugins/returned.hpp"

namespace grit {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr double infinity = std::numeric_limits<double>::infinity();
const double unknown = std::nan("");

/// Expects that `call` throws a PluginError with this fault of the plugin "it".
template <class Call>
void expect_fault(const std::string& fault, Call call) {
  EXPECT_THAT(call, testing::ThrowsMessage<PluginError>(
                        testing::AllOf(StartsWith("it: its " + fault), HasSubstr("\n  fix the plugin"))));
}

struct AnyBody final : BodyKind {
  void declare(Parameters&) override {}
  const ClumpShape* clump() const override { return &shape; }
  double volume(double) const override { return number; }
  double inertia(double, double) const override { return number; }

  ClumpShape shape{.spheres = {{0, 0, 0, 1}}, .volume_fractions = {1}, .volume = 4, .inertia = Vec3::Ones()};
  double number = 1;
};

TEST(ReturnedByABody, IsAClumpThatCanBe) {
  EXPECT_EQ(guarded(std::shared_ptr<BodyKind>(std::make_shared<AnyBody>()), "it")->clump()->spheres.size(), 1u);
  const auto refuse = [](const std::string& fault, auto spoil) {
    const auto body = std::make_shared<AnyBody>();
    spoil(body->shape);
    expect_fault("clump() returned a clump " + fault, [&] { guarded(std::shared_ptr<BodyKind>(body), "it")->clump(); });
  };
  refuse("without spheres", [](ClumpShape& s) { s.spheres.clear(); });
  refuse("of 1 spheres with 0 volume fractions", [](ClumpShape& s) { s.volume_fractions.clear(); });
  refuse("whose sphere 1 has the radius -1", [](ClumpShape& s) { s.spheres[0].w = -1; });
  refuse("whose sphere 1 has the radius inf", [](ClumpShape& s) { s.spheres[0].w = infinity; });
  refuse("whose sphere 1 has points nan away", [](ClumpShape& s) { s.spheres[0].x = unknown; });
  refuse("whose sphere 1 has points 2 away", [](ClumpShape& s) { s.spheres[0].x = 1; });
  refuse("whose sphere 1 has the volume fraction 2", [](ClumpShape& s) { s.volume_fractions[0] = 2; });
  refuse("whose middle is not finite", [](ClumpShape& s) { s.middle[0] = unknown; });
  refuse("whose axes", [](ClumpShape& s) { s.axes(0, 1) = 1; });
  refuse("of the volume 0", [](ClumpShape& s) { s.volume = 0; });
  refuse("with the moment of inertia nan", [](ClumpShape& s) { s.inertia[1] = unknown; });
  refuse("of the given radius -1", [](ClumpShape& s) { s.given_radius = -1; });
}

TEST(ReturnedByABody, IsReadOnce) {
  const auto body = std::make_shared<AnyBody>();
  const auto kind = guarded(std::shared_ptr<BodyKind>(body), "it");
  EXPECT_EQ(kind->clump()->spheres.size(), 1u);
  body->shape.spheres.clear();
  EXPECT_EQ(kind->clump()->spheres.size(), 1u);
}

TEST(ReturnedByABody, HasMass) {
  const auto body = std::make_shared<AnyBody>();
  const auto kind = guarded(std::shared_ptr<BodyKind>(body), "it");
  for (const double wrong : {0.0, -1.0, unknown, infinity}) {
    body->number = wrong;
    expect_fault("volume() returned ", [&] { kind->volume(1); });
    expect_fault("inertia() returned ", [&] { kind->inertia(1, 1); });
  }
}

struct AnyShape final : Geometry {
  void declare(Parameters&) override {}
  Bounds bounds() const override { return box; }
  double area() const override { return number; }
  Vec3 normal() const override { return direction; }
  void find_contacts(const Pose&, std::span<const Sphere>, std::vector<SurfaceContact>& contacts) const override {
    if (removes) contacts.clear();
    for (const std::uint32_t body : bodies) contacts.push_back({Vec3::UnitX(), 1, body, 0});
  }
  bool near(const Pose&, const Vec3&, double) const override { return true; }
  std::vector<Vec3> triangles() const override { return corners; }
  std::optional<std::uint32_t> triangle_of(std::uint32_t feature) const override { return feature; }

  Bounds box{Vec3::Constant(-infinity), Vec3::Zero()};
  double number = 0;
  Vec3 direction = Vec3::Zero();
  std::vector<std::uint32_t> bodies;
  bool removes = false;
  std::vector<Vec3> corners{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
};

class ReturnedByAGeometry : public testing::Test {
 protected:
  std::shared_ptr<AnyShape> made = std::make_shared<AnyShape>();
  std::shared_ptr<Geometry> shape = guarded(std::shared_ptr<Geometry>(made), "it");
};

TEST_F(ReturnedByAGeometry, HasBounds) {
  EXPECT_NO_THROW(shape->prepare());
  for (const auto& [low, high] : {std::pair(1.0, 0.0), std::pair(unknown, 0.0), std::pair(0.0, unknown),
                                  std::pair(infinity, infinity), std::pair(-infinity, -infinity)}) {
    made->box = {Vec3(0, low, 0), Vec3(0, high, 0)};
    expect_fault("bounds() returned sides at ", [&] { guarded(std::shared_ptr<Geometry>(made), "it")->prepare(); });
  }
  EXPECT_EQ(shape->bounds().high, Vec3::Zero()) << "as they were when it was prepared";
}

TEST_F(ReturnedByAGeometry, HasAreaNormalAndTriangles) {
  made->number = -1, made->direction = Vec3::Constant(1);
  expect_fault("area() returned -1", [&] { shape->area(); });
  expect_fault("normal() returned a vector of length ", [&] { shape->normal(); });
  made->direction[2] = unknown;
  expect_fault("normal() returned a vector of length ", [&] { shape->normal(); });
  made->corners.pop_back();
  expect_fault("triangles() returned 2 corners", [&] { shape->triangles(); });
  made->corners.assign(3, Vec3::Constant(unknown));
  expect_fault("triangles() returned a corner that is not finite", [&] { shape->triangles(); });
}

TEST_F(ReturnedByAGeometry, HasContactsOfTheGivenSpheres) {
  const std::vector<Sphere> spheres{{Vec3::Zero(), 1, 4}, {Vec3::Zero(), 1, 7}};
  std::vector<SurfaceContact> contacts{{Vec3::UnitX(), 1, 9, 0}};
  made->bodies = {4, 4, 7};
  shape->find_contacts({}, spheres, contacts);
  EXPECT_EQ(contacts.size(), 4u);
  for (const std::vector<std::uint32_t>& wrong : {std::vector{5u}, {~0u}, {7u, 4u}}) {
    made->bodies = wrong;
    expect_fault("find_contacts() found a contact of the body " + std::to_string(wrong.back()),
                 [&] { shape->find_contacts({}, spheres, contacts); });
  }
  made->removes = true, made->bodies.clear();
  expect_fault("find_contacts() removed contacts", [&] { shape->find_contacts({}, spheres, contacts); });
}

TEST_F(ReturnedByAGeometry, HasFeaturesOnItsTriangles) {
  shape->prepare();
  EXPECT_EQ(shape->triangle_of(0), 0u);
  expect_fault("triangle_of() returned 1; allowed is an index of its 1 triangles", [&] { shape->triangle_of(1); });
}

struct AnyEngine final : Engine {
  void declare(Parameters&) override {}
  Phase phase() const override { return acts_in; }
  void settings(MotionSettings& motion) const override { motion = sets; }
  EngineRates rates(const World&) const override { return has; }

  Phase acts_in = Phase::settings;
  MotionSettings sets;
  EngineRates has;
};

TEST(ReturnedByAnEngine, IsCheckedAsDescriptionsAre) {
  const auto engine = std::make_shared<AnyEngine>();
  const auto guard = guarded(std::shared_ptr<Engine>(engine), "it");
  const auto refuse = [&](const std::string& fault, auto spoil) {
    engine->sets = {};
    spoil(engine->sets);
    MotionSettings motion;
    expect_fault("settings() set " + fault, [&] { guard->settings(motion); });
  };
  MotionSettings motion;
  EXPECT_NO_THROW(guard->settings(motion));
  refuse("the local damping 5; allowed is 0 or more and below 1", [](MotionSettings& m) { m.local_damping = 5; });
  refuse("the local damping -5", [](MotionSettings& m) { m.local_damping = -5; });
  refuse("the local damping nan", [](MotionSettings& m) { m.local_damping = unknown; });
  refuse("planar motion normal to the axis 7", [](MotionSettings& m) { m.flat = 7; });
  refuse("planar motion normal to the axis -1", [](MotionSettings& m) { m.flat = -1; });
  refuse("the scaled radius inf", [](MotionSettings& m) { m.scaled_radius = infinity; });
  refuse("a gravity that is not finite", [](MotionSettings& m) { m.gravity[1] = infinity; });
  refuse("a prescribed motion", [](MotionSettings& m) { m.prescribed = RigidMotion{.spin = {0, 0, unknown}}; });

  engine->acts_in = static_cast<Phase>(7);
  expect_fault("phase() returned the unknown phase 7", [&] { guard->phase(); });
  engine->has.damping = -1;
  expect_fault("rates() returned the rate -1", [&] { guard->rates(FakeWorld()); });
  engine->has.damping = unknown;
  expect_fault("rates() returned the rate nan", [&] { guard->rates(FakeWorld()); });
}

TEST(ReturnedByALaw, HasFieldsAndReachesThatCanBe) {
  const auto fault = [](const std::vector<StateField>& fields) {
    return fault_of(std::span<const StateField>(fields));
  };
  EXPECT_EQ(fault({{"shear_x", "N", "a force", -1}, {"bond", "1", "whether it holds", 1}}), "");
  EXPECT_THAT(fault({{"bond", "1", "odd", 0}}), HasSubstr("a field \"bond\" with the factor 0"));
  EXPECT_THAT(fault({{"bond", "1", "one", 1}, {"bond", "1", "other", 1}}), HasSubstr("which is taken"));
  EXPECT_EQ(fault_of_not_negative(0), "");
  for (const double wrong : {-1.0, unknown, infinity})
    EXPECT_THAT(fault_of_not_negative(wrong), HasSubstr("0 or more"));
}

struct AnyProbe final : Probe {
  void declare(Parameters&) override {}
  std::vector<Channel> channels() const override { return all; }
  void sample(const World&, ChannelValues&) override {}
  std::vector<Field> fields(const World&) override { return tables; }

  std::vector<Channel> all;
  std::vector<Field> tables;
};

TEST(ReturnedByAProbe, HasChannelsThatCanBeWritten) {
  const auto probe = std::make_shared<AnyProbe>();
  const auto guard = guarded(std::shared_ptr<Probe>(probe), "it");
  probe->all = {{"speed_x", "m/s", "a speed", {}}, {"stress", "Pa", "a stress", {3, 3}}};
  EXPECT_EQ(guard->channels().size(), 2u);
  for (const std::string name : {"", "a/b", ".", "..", "a b", "ü", "time", "step"}) {
    probe->all = {{name, "1", "odd", {}}};
    expect_fault("channels() returned a channel of the name \"" + name + '"', [&] { guard->channels(); });
  }
  probe->all = {{"twice", "1", "one", {}}, {"twice", "1", "other", {}}};
  expect_fault("channels() returned a channel of the name \"twice\", which is taken", [&] { guard->channels(); });
  const std::size_t huge = std::size_t{1} << 32;
  for (const std::vector<std::size_t>& shape : {std::vector<std::size_t>{0}, {3, 0}, {huge}, {huge, huge}}) {
    probe->all = {{"odd", "1", "odd", shape}};
    expect_fault("channels() returned a channel \"odd\" of the shape {", [&] { guard->channels(); });
  }
}

TEST(ReturnedByAProbe, HasFieldsThatCanBeWritten) {
  const auto probe = std::make_shared<AnyProbe>();
  const auto guard = guarded(std::shared_ptr<Probe>(probe), "it");
  const FakeWorld world;
  probe->tables = {{"force", "N", "a force", 3, {1, 2, 3}}};
  EXPECT_EQ(guard->fields(world).size(), 1u);
  const auto refuse = [&](const std::string& fault, Field field) {
    probe->tables = {std::move(field)};
    expect_fault("fields() returned a field " + fault, [&] { guard->fields(world); });
  };
  refuse("of the name \"a/b\"", {"a/b", "1", "odd", 1, {}});
  refuse("\"odd\" of width 0", {"odd", "1", "odd", 0, {}});
  refuse("\"odd\" of width 3 with 2 values", {"odd", "1", "odd", 3, {1, 2}});
  refuse("\"odd\" of width 1 with 2 components", {"odd", "1", "odd", 1, {1}, {"a", "b"}});
}

}  // namespace
}  // namespace grit
