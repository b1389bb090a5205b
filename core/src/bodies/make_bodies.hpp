// Creates bodies from the groups of a description.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bodies/bodies.hpp"
#include "description/components.hpp"
#include "description/description.hpp"
#include "grit/world.hpp"

namespace grit {

/// All state of bodies that a component, or `also`, requests.
StateRequest requested_state(const Components& components, StateRequest also = {});

/// Materials in the order of their indices in bodies and walls, also those that stages add: indices never change.
/// Materials of bodies come first, so that the index of all bodies is 0 if they have only one material.
std::vector<std::string> material_names(const SceneDescription& scene);

/// The number of materials of bodies, which are the first ones.
std::size_t materials_of_bodies(const SceneDescription& scene);

/// `names` with each material that no body and no wall uses replaced by one in use: indices stay, and unused materials
/// do not activate features of a contact law.
std::vector<std::string> materials_in_use(const SceneDescription& scene, std::vector<std::string> names);

/// The bodies of all groups at the start, in the order of group names, with consecutive ids. Throws as the sources of
/// grains do, PlacedError for files that cannot be read, also those of later groups.
Bodies make_bodies(const SceneDescription& scene, const Components& components, StateRequest state);

/// New bodies at the start of a stage, group after group; ids from 0.
struct Newcomers {
  struct Group {
    std::string name;
    std::uint32_t first_id;
    double overlap;  ///< maximum overlap with present bodies and walls, over the smaller radius
  };
  Bodies bodies;
  std::vector<Group> groups;  ///< in the order of their names
};
/// Clouds do not overlap `there` (centre, w: radius), the present spheres. Random numbers depend on the seed and on the
/// index of the stage. Throws grit::Error, naming the group, if there is no space for a cloud or a body is outside the
/// cell.
Newcomers make_newcomers(const SceneDescription& scene, const Components& components, const std::string& stage,
                         const Cell& cell, std::span<const Row> there, StateRequest state);

/// The smallest body of each of these groups, for estimates before they appear. Throws PlacedError if a file cannot
/// be read.
Bodies smallest_bodies(const SceneDescription& scene, const Components& components,
                       const std::vector<std::string>& groups);

/// Number of bodies of a group as far as the description gives it by itself: not of files, samples and streams. Each
/// sphere of a clump is one.
std::optional<std::size_t> described_count(const SceneDescription& scene, const std::string& group,
                                           const BodyKind& kind);

/// Number of bodies of a group; each sphere of a clump is one. For a stream those that its limits allow, or 0. Throws
/// PlacedError if its file cannot be read.
std::size_t body_count(const SceneDescription& scene, const std::string& group,
                       const std::shared_ptr<const BodyKind>& kind);

}  // namespace grit
