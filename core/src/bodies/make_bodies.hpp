// From a description's groups of grains to bodies.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bodies/bodies.hpp"
#include "description/components.hpp"
#include "description/description.hpp"
#include "grit/world.hpp"

namespace grit {

/// All state of bodies that a component, or `also`, asks for.
StateRequest requested_state(const Components& components, StateRequest also = {});

/// Materials in the order of their numbers in bodies and walls: those of bodies come first, so that all bodies have
/// number 0 where they are of one, whatever else there is.
std::vector<std::string> material_names(const SceneDescription& scene);

/// How many of these bodies are of: the first so many.
std::size_t materials_of_bodies(const SceneDescription& scene);

/// `names` with one that is in use in place of each that no body and no wall of the scene is of: numbers stay, and what
/// nothing is of switches no part of a contact law on.
std::vector<std::string> materials_in_use(const SceneDescription& scene, std::vector<std::string> names);

/// The bodies of all groups that are there at the start, in the order of their names; ids count through. Throws as the
/// sources of grains do, those of later groups included where they are files.
Bodies make_bodies(const SceneDescription& scene, const Components& components, StateRequest state);

/// Bodies that appear at the begin of a stage, group after group; ids count from 0.
struct Newcomers {
  struct Group {
    std::string name;
    std::uint32_t first_id;
    double overlap;  ///< with bodies and walls that are there, at most, over the smaller radius
  };
  Bodies bodies;
  std::vector<Group> groups;  ///< in the order of their names
};
/// Clouds keep clear of `there` (centre, w: radius), the spheres that the cell holds now. What is random depends on the
/// seed and on the stage's place among all stages. Throws grit::Error, with the group, where a cloud finds no room or a
/// body lies outside the cell.
Newcomers make_newcomers(const SceneDescription& scene, const Components& components, const std::string& stage,
                         const Cell& cell, std::span<const Row> there, StateRequest state);

/// How many bodies a group has; each sphere of a clump is one. Throws where its file cannot be read.
std::size_t body_count(const BodiesDescription& group, const BodyKind& kind);

}  // namespace grit
