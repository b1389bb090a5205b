#include "simulation/live_scene.hpp"

#include "simulation/preflight.hpp"

namespace grit {

LiveScene::LiveScene(const Scene& scene)
    : current_(*scene.description, scene.stages), law_(*scene.description), components_{.law = law_.get()} {
  Faults faults(scene.document);
  for (const auto& [name, group] : now().bodies)
    components_.body_kinds[name] = prepared(group.kind, {"bodies", name}, faults.report_of(0));
  geometries_.follow(now(), faults.report_of(0));
  engines_.follow(now());
  for (const auto& [name, probe] : now().probes) components_.probes[name] = probe.probe.make();
  check_stages(scene, geometries_, faults);
  faults.throw_if_any();
  components_.geometries = geometries_.all(), components_.engines = engines_.all();
}

void LiveScene::begin_stage() {
  current_.begin_stage();
  bound_ = nullptr;
  follow();
}

bool LiveScene::advance_ramps(std::size_t increments) {
  const CurrentScene::Step step = current_.advance_ramps(increments);
  if (step.ramp == nullptr) return false;
  if (step.replaced || step.ramp != bound_) {
    follow();
    const auto place = NumberPointer::of(step.ramp->pointer);
    number_ = law_.number(*place);
    if (!number_) number_ = engines_.number(*place);
    bound_ = step.ramp;
  } else if (number_) {
    number_->set(step.value);
  } else if (geometries_.follow(now())) {
    components_.geometries = geometries_.all();
  }
  return true;
}

void LiveScene::apply(const SettingsChange& change) {
  current_.apply(change);
  bound_ = nullptr;
  follow();
}

void LiveScene::go_to(std::size_t stage, std::size_t increments) {
  while (current_.next_stage() <= stage) current_.begin_stage();
  current_.advance_ramps(increments);
  follow();
}

void LiveScene::follow() {
  law_.follow(now());
  engines_.follow(now());
  geometries_.follow(now());
  components_.engines = engines_.all(), components_.geometries = geometries_.all();
}

}  // namespace grit
