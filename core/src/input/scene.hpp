// From a file to the typed scenes that a run needs.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "input/document.hpp"
#include "plugins/registry.hpp"
#include "scene/description.hpp"

namespace grit {

/// What one stage runs with. A stage's changes, and where its ramps ended, stay for the stages after it.
struct StagePlan {
  std::shared_ptr<const SceneDescription> start;  ///< with all changes up to this stage, its own included
  /// After each increment of its ramps: those of the first ramp, then, on top of its end, those of the second, …
  std::vector<std::shared_ptr<const SceneDescription>> ramp;
};

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

/// The same, then reads all that the stages will run with. Throws DescriptionError with every problem of the
/// description and of its stages' changes and ramps. Components hold a pointer to the registry.
Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& sets, const Registry& registry);

/// The same for a plain document.
Scene read_scene(Document document, const Registry& registry);

/// All values of a scene, in SI, as run.json keeps them.
Description resolved(const SceneDescription& scene);

}  // namespace grit
