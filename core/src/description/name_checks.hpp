// Whether the names in a description are those of what it describes.
#pragma once

#include "description/description.hpp"

namespace grit {

/// A body keeps the index of its material in one byte, that of its group in two.
void check_number_of_materials(const SceneDescription& scene, const Complain& complain);
void check_number_of_groups(const SceneDescription& scene, const Complain& complain);
/// Reports interfaces that do not join two materials, or the same two again.
void check_interfaces(const SceneDescription& scene, const Complain& complain);
/// Report materials that do not exist.
void check_materials_of_bodies(const SceneDescription& scene, const Complain& complain);
void check_materials_of_walls(const SceneDescription& scene, const Complain& complain);
/// Reports groups of bodies that do not exist.
void check_names_of_groups(const SceneDescription& scene, const Complain& complain);
/// Reports walls that follow one that does not exist, or themselves.
void check_followers(const SceneDescription& scene, const Complain& complain);
/// Reports walls of the specimen that do not exist.
void check_specimen(const SceneDescription& scene, const Complain& complain);
/// Reports walls that do not exist in conditions of stages and in cadences.
void check_awaited_walls(const SceneDescription& scene, const Complain& complain);
/// Reports stages of the same name.
void check_unique_stages(const SceneDescription& scene, const Complain& complain);
/// Reports stages of bodies and probes that do not exist.
void check_named_stages(const SceneDescription& scene, const Complain& complain);

}  // namespace grit
