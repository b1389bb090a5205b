// What a run and the sample from which it begins must have in common.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "description/description.hpp"
#include "description/placed_error.hpp"

namespace grit {

using SampleFaults = std::vector<PlacedError::Fault>;

/// For messages.
std::string name_of_sample(const BeginDescription& begin);

/// The groups of the sample, `has`, and those of the scene must be the same.
void check_groups(const SceneDescription& scene, const std::set<std::string>& has, const std::string& sample,
                  SampleFaults& faults);

void check_domain(const DomainDescription& now, const DomainDescription& before, const std::string& sample,
                  SampleFaults& faults);

std::vector<std::string> walls_with_other_geometry(const SceneDescription& now, const SceneDescription& before);

}  // namespace grit
