// From a file to the typed description that a run needs, and what its stages change of it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "description/description.hpp"
#include "description/stage_plan.hpp"
#include "input/document.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// A description that was read and found right.
struct Scene {
  Document document;                                    ///< plain: extended, set, and expanded where it was a scenario
  std::shared_ptr<const SceneDescription> description;  ///< before any stage's change
  std::vector<StagePlan> stages;                        ///< one for each of description->stages
};

/// The scenario that a description is of; empty if it is plain.
std::string scenario_type(const Document& document);

/// Reads a description with what it extends, applies `sets` ("/pointer=value") in order, and expands its scenario if it
/// has one; its other keys are merged onto the expansion. The result is plain, and not yet checked. Throws FileError,
/// DescriptionError, PluginError.
Document load_document(const std::filesystem::path& path, const std::vector<std::string>& sets,
                       const Registry& registry);

/// The same for a document that was read.
Document expanded_document(Document document, const std::vector<std::string>& sets, const Registry& registry);

/// load_document(), then reads it and all that its stages change. Throws DescriptionError with every problem of the
/// description and of its stages' changes and ramps. What is described holds a pointer to the registry. What shows only
/// once components are made, `simulation` finds.
Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& sets, const Registry& registry);

/// The same for a plain document.
Scene read_scene(Document document, const Registry& registry);

/// What setting one value changes of a scene: the value at `pointer`, as a stage's change would have it. Throws
/// DescriptionError.
SettingsChange change_of(const SceneDescription& now, const std::string& pointer, const Description& value);

/// All values of a scene, in SI, as run.json keeps them.
Description resolved(const SceneDescription& scene);

}  // namespace grit
