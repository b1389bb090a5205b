// The groups of a scene to which the bodies of a sample belong.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "bodies/group_builder.hpp"
#include "simulation/live_scene.hpp"
#include "simulation/sample_checks.hpp"

namespace grit {

/// A sphere of a clump of a sample [m].
struct SampleSphere {
  double distance;  ///< from the centre of mass of the clump
  double radius;
};

/// Finds bodies whose kind or shape is not that of their group: a fault for each group.
class SampleGroups {
 public:
  /// `sample`: its name in messages.
  SampleGroups(const LiveScene& live, std::string sample) : live_(live), sample_(std::move(sample)) {}

  const GroupBuilder& builder_of(const std::string& group);
  bool takes_sphere(const std::string& group);
  /// `radius`: of the sphere that encloses the clump [m].
  bool takes_clump(const std::string& group, double radius, std::span<const SampleSphere> spheres);
  const SampleFaults& faults() const { return faults_; }

 private:
  bool refuse(const std::string& group, std::size_t spheres);

  const LiveScene& live_;
  std::string sample_;
  std::map<std::string, GroupBuilder> builders_;
  std::set<std::string> refused_;
  SampleFaults faults_;
};

}  // namespace grit
