// The built-in engines, and one with state.
#include "grit/testing/engine.hpp"

#include <gtest/gtest.h>

#include "motion/builtin.hpp"

namespace grit {
namespace {

EngineCase builtin(const std::string& name) {
  std::string title = name;
  for (char& letter : title) letter = letter == '-' ? '_' : letter;
  return {title, [name] {
            for (const PluginInfo& info : builtin_engines())
              if (info.name == name) return std::shared_ptr<Engine>(info.make_engine());
            return std::shared_ptr<Engine>();
          }};
}

/// Pushes bodies as in the previous step, slightly to the side, and keeps the latest forces.
class Wind final : public Engine {
 public:
  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  void forces(const World& world, std::span<Row> force, std::span<Row>) const override {
    gusts_.push_back(1e-6 * world.positions().front().x);
    if (gusts_.size() > 3) gusts_.pop_front();
    for (const double gust : gusts_) mean_ += 0.1 * (gust - mean_);
    for (Row& row : force) row.y += mean_;
  }
  void serialize(Archive& archive) override { archive(gusts_, mean_); }

 private:
  mutable std::deque<double> gusts_;
  mutable double mean_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Engines, EngineContract,
                         testing::Values(builtin("gravity"), builtin("local-damping"), builtin("hold"),
                                         builtin("planar"), builtin("prescribed-motion"), builtin("sink"),
                                         EngineCase{"with_a_memory", [] { return std::make_shared<Wind>(); }}),
                         engine_case_name);

}  // namespace
}  // namespace grit
