#include "description/current_scene.hpp"

#include "grit/error.hpp"

namespace grit {

void CurrentScene::begin_stage() {
  if (next_ > 0) advance_ramps(plan(next_ - 1).increments());
  plan(next_).change.apply_to(now_);
  ++next_, done_ = 0, ramp_ = 0;
  number_.reset();
}

CurrentScene::Step CurrentScene::advance_ramps(std::size_t increments) {
  Step step;
  if (increments <= done_) return step;
  const auto& ramps = plan(next_ - 1).ramps;
  std::size_t before = 0;  // increments of the ramps that have ended
  for (std::size_t i = 0; i < ramp_; ++i) before += static_cast<std::size_t>(ramps[i].increments);
  for (; ramp_ < ramps.size(); ++ramp_, number_.reset()) {
    const RampPlan& ramp = ramps[ramp_];
    const auto own = static_cast<std::size_t>(ramp.increments);
    if (increments <= before) break;
    const std::size_t due = std::min(increments - before, own);
    if (before + due > done_) set(ramp, ramp.value(static_cast<std::int64_t>(due)), step);
    if (increments - before < own) break;
    before += own;
  }
  done_ = increments;
  return step;
}

bool CurrentScene::declare(const NumberPointer& place, ContactLaw* law, Parameters& parameters) {
  return now_.has_unit(place.section, place.name) && now_.declare_unit(place.section, place.name, law, parameters);
}

void CurrentScene::bind(const RampPlan& ramp) {
  const auto number = NumberPointer::of(ramp.pointer);
  Parameters parameters;
  if (number && declare(*number, nullptr, parameters)) number_ = find_number(parameters, number->keys);
  if (!number_) throw Error("there is no number at " + ramp.pointer);
}

void CurrentScene::apply(const SettingsChange& change) {
  change.apply_to(now_);
  if (number_) bind(plan(next_ - 1).ramps[ramp_]);
}

void CurrentScene::set(const RampPlan& ramp, double value, Step& step) {
  if (!number_) {
    ramp.begin.apply_to(now_);
    step.replaced = true;
    bind(ramp);
  }
  number_->set(value);
  step.ramp = &ramp, step.value = value;
}

bool through_stages(const SceneDescription& described, const std::vector<StagePlan>& stages,
                    const std::function<bool(const SceneDescription&, std::optional<std::size_t>)>& visit) {
  CurrentScene scene(described, stages);
  if (!visit(scene.now(), std::nullopt)) return false;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    scene.begin_stage();
    if (!visit(scene.now(), i)) return false;
    std::size_t before = 0;
    for (const RampPlan& ramp : stages[i].ramps) {
      const auto increments = static_cast<std::size_t>(ramp.increments);
      for (const std::size_t at : {std::size_t{1}, increments}) {
        if (before + at <= scene.increments_done()) continue;
        scene.advance_ramps(before + at);
        if (!visit(scene.now(), i)) return false;
      }
      before += increments;
    }
  }
  return true;
}

}  // namespace grit
