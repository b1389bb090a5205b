// From a file to the typed description of a run and the changes of its stages.
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

/// A description that was read and checked.
struct Scene {
  Document document;                                    ///< plain: extended, set, and expanded if it was a scenario
  std::shared_ptr<const SceneDescription> description;  ///< before the changes of any stage
  std::vector<StagePlan> stages;                        ///< one for each of description->stages
};

/// Type of the scenario of a description; empty if it is plain.
std::string scenario_type(const Document& document);

/// Reads a description with the files it extends, applies `sets` ("/pointer=value") in order, and expands its scenario
/// if it has one; its other keys are merged onto the expansion. The result is plain and not yet checked. `sets_by`: the
/// source of `sets` in messages. Throws FileError, DescriptionError, PluginError.
Document load_document(const std::filesystem::path& path, const std::vector<std::string>& sets,
                       const Registry& registry, const std::string& sets_by = "--set");

/// The same for a document already read.
Document expanded_document(Document document, const std::vector<std::string>& sets, const Registry& registry,
                           const std::string& sets_by = "--set");

/// load_document(), then reads the description and the changes of its stages. Throws DescriptionError with every
/// problem of the description and of its stages' changes and ramps. The result keeps a pointer to the registry. Faults
/// that show only when components are made are found by `simulation`.
Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& sets, const Registry& registry);

/// The same for a plain document.
Scene read_scene(Document document, const Registry& registry);

/// The change that setting one value makes to a scene: the value at `pointer`, as in the change of a stage. Throws
/// DescriptionError.
SettingsChange change_of(const SceneDescription& now, const std::string& pointer, const Description& value);

/// All values of a scene, in SI, as in run.json.
Description resolved(const SceneDescription& scene);

}  // namespace grit
