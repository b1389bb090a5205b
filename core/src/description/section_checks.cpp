#include "description/section_checks.hpp"

#include <algorithm>
#include <variant>

namespace grit {

void check_growth(const SceneDescription& scene, const Complain& complain) {
  const auto grows = [](const StageDescription& stage) { return stage.growth.has_value(); };
  if (std::ranges::none_of(scene.stages, grows)) return;
  for (const auto& [name, engine] : scene.engines) {
    MotionSettings settings;
    engine.engine.make()->settings(settings);
    if (settings.scaled_radius > 0)
      complain("engines/" + name, "density scaling together with growth of bodies in a stage",
               "only one of them, as the scaled masses would not fit the new sizes; remove one");
  }
}

void check_sample(const SceneDescription& scene, const Complain& complain) {
  bool used = false;
  for (const auto& [name, group] : scene.bodies) {
    if (!group.is_from_sample()) continue;
    used = true;
    if (!scene.begin)
      complain("bodies/" + name + "/source", "a source of type sample without /begin",
               "a run that begins from a sample: add \"begin\": {\"from\": FOLDER}");
    if (!group.stage.empty())
      complain("bodies/" + name + "/stage", "a group of a sample that appears in a stage",
               "the start of the run; remove stage");
    if (!group.velocity.isZero(0.0))
      complain("bodies/" + name + "/velocity", "a velocity of bodies that come from a sample",
               "none: they keep that of the sample; remove velocity");
    if (group.overlap != BodiesDescription::usual_overlap)
      complain("bodies/" + name + "/overlap", "a maximum overlap of bodies that come from a sample",
               "none: it is for bodies that appear in a stage; remove overlap");
  }
  if (scene.begin && !used)
    complain("begin", "a sample of which no group of bodies is used",
             "a group of bodies with \"source\": {\"type\": \"sample\"}");
}

void check_shear(const SceneDescription& scene, const Complain& complain) {
  if (!scene.domain.shears()) return;
  for (const auto& [name, wall] : scene.walls)
    complain("walls/" + name, "a wall in a domain that shears", "a domain without walls; or no shear of /domain");
  for (const auto& [name, group] : scene.bodies)
    if (!group.stage.empty() || std::holds_alternative<StreamSource>(group.source.value()))
      complain("bodies/" + name, "bodies that appear during the run in a domain that shears",
               "bodies from the start; or no shear of /domain");
}

}  // namespace grit
