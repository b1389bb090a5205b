// Scenes for tests: plain descriptions made by hand, with the plugins of this build, and worlds that run step by step.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bodies/clump_body.hpp"
#include "bodies/make_bodies.hpp"
#include "bodies/sphere_body.hpp"
#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "motion/builtin.hpp"
#include "simulation/live_scene.hpp"

namespace grit::test {

/// The kernel's own components and the plugins of this build.
inline Registry& installed() {
  static Registry registry({GRIT_PLUGIN_DIR});
  static const bool filled = [] {
    registry.add(sphere_body());
    registry.add(clump_body());
    for (const PluginInfo& engine : builtin_engines()) registry.add(engine);
    return true;
  }();
  static_cast<void>(filled);
  return registry;
}

inline Description vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

struct Grain {
  Vec3 position;
  double radius;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
};

/// Grains of one material, "grain", and one stage.
inline Description description(const std::string& law, const Description& material, const std::vector<Grain>& grains) {
  Description list = Description::array();
  for (const Grain& g : grains)
    list.push_back({{"position", vector(g.position)},
                    {"radius", g.radius},
                    {"velocity", vector(g.velocity)},
                    {"spin", vector(g.spin)}});
  Description d = Description::parse(R"({
    "contacts": {}, "materials": {},
    "bodies": {"grains": {"type": "sphere", "material": "grain", "source": {"type": "list"}}},
    "stages": [{"name": "only", "until": {"type": "steps", "value": 1}, "limit": 1e9}]
  })");
  d["contacts"]["type"] = law;
  d["materials"]["grain"] = material;
  d["bodies"]["grains"]["source"]["bodies"] = std::move(list);
  return d;
}

inline Description plane(const Vec3& point, const Vec3& normal, const std::string& material = "grain") {
  return {{"type", "plane"}, {"point", vector(point)}, {"normal", vector(normal)}, {"material", material}};
}

inline Scene scene_of(const Description& plain) { return read_scene(Document(plain, "test"), installed()); }

/// What World says of one body, by its id.
inline std::size_t index_of(const World& world, std::uint32_t id) {
  const auto ids = world.ids();
  return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
}

/// A scene with its components and its kernel, as a run begins.
struct Started {
  Scene scene;
  LiveScene live;
  Kernel kernel;

  /// With the state of bodies that components ask for, or this one.
  explicit Started(Scene described, unsigned threads = 1, std::optional<StateRequest> state = {})
      : scene(std::move(described)),
        live(scene),
        kernel(live.now(), live.components(),
               make_bodies(live.now(), live.components(), state.value_or(requested_state(live.components()))),
               threads) {}
  Started(const Started&) = delete;
};

/// The first stage of a description, step by step; forces and positions always belong together.
class Trial {
 public:
  explicit Trial(const Description& plain, unsigned threads = 1, StateRequest state = {})
      : scene_(scene_of(plain)),
        live_(live_at(0)),
        kernel_(live_->now(), live_->components(), make_bodies(live_->now(), live_->components(), state), threads) {
    kernel_.find_forces();
  }
  Trial(const Trial&) = delete;

  /// Begins a stage of the description, by this name.
  void begin_stage(std::size_t stage, const std::string& name) { begin_stage(scene_, stage, name); }
  /// One of another description of the same world, which must live as long.
  void begin_stage(const Scene& scene, std::size_t stage, const std::string& name) {
    auto next = std::make_unique<LiveScene>(scene);
    next->go_to(stage, 0);
    kernel_.begin_stage(name, next->now(), next->components());
    live_ = std::move(next);
  }
  void step(std::size_t steps = 1) {
    for (; steps > 0; --steps) kernel_.advance(), kernel_.find_forces();
  }

  /// The same to the same bits, in one pass a step.
  void step_on(std::size_t steps) {
    kernel_.advance();
    for (; steps > 1; --steps) kernel_.step_on();
    kernel_.find_forces();
  }

  const World& world() const { return kernel_.world(); }
  Kernel& kernel() { return kernel_; }
  const Kernel& kernel() const { return kernel_; }
  const Scene& scene() const { return scene_; }
  const ContactLaw& law() const { return *live_->components().law; }

  Vec3 position(std::uint32_t id) const { return xyz(world().positions()[index_of(world(), id)]); }
  /// At time(), not half a step before.
  Vec3 velocity(std::uint32_t id) const { return now(world().velocities(), world().forces(), id); }
  Vec3 spin(std::uint32_t id) const { return now(world().spins(), world().moments(), id); }
  double mass(std::uint32_t id) const { return 1 / world().velocities()[index_of(world(), id)].w; }

 private:
  Vec3 now(std::span<const Row> rates, std::span<const Row> pushes, std::uint32_t id) const {
    const std::size_t i = index_of(world(), id);
    const double half = world().step() > 0 ? 0.5 * kernel_.state().time.previous_dt : 0;
    return xyz(rates[i]) + half * rates[i].w * xyz(pushes[i]);
  }

  std::unique_ptr<LiveScene> live_at(std::size_t stage) const {
    auto live = std::make_unique<LiveScene>(scene_);
    live->go_to(stage, 0);
    return live;
  }

  Scene scene_;
  std::unique_ptr<LiveScene> live_;
  Kernel kernel_;
};

}  // namespace grit::test
