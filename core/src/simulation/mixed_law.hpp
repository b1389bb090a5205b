// A contact law that follows a description, mixed for its materials.
#pragma once

#include <string>
#include <vector>

#include "bodies/make_bodies.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// The contact law of a scene, with the materials in use mixed.
class MixedLaw {
 public:
  explicit MixedLaw(const SceneDescription& described) : law_(described) {}
  /// Returns whether the mixed values may have changed.
  bool follow(const SceneDescription& now) {
    const bool changed = law_.follow(now);
    auto in_use = materials_in_use(now, material_names(now));
    if (!changed && in_use == in_use_) return false;
    in_use_ = std::move(in_use);
    law_->mix(in_use_, materials_of_bodies(now));
    return true;
  }
  ContactLaw& law() const { return *law_; }

 private:
  LiveLaw law_;
  std::vector<std::string> in_use_;
};

}  // namespace grit
