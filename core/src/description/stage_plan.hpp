// Changes of a description by its stages, as values: complete and checked before a run begins.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/description.hpp"

namespace grit {

/// Position of a number that a stage changes: a section, the name of its entry (empty in a section without names), and
/// the keys below.
struct NumberPointer {
  std::string section, name;
  std::vector<std::string> keys;
  /// From a JSON pointer below one of SceneDescription::changeable(); nothing if it points to a section or an entry.
  static std::optional<NumberPointer> of(const std::string& pointer);
};

/// New values of parts of a description, each complete. An entry without a value is removed.
struct SettingsChange {
  std::map<std::string, std::optional<MaterialDescription>> materials;
  std::vector<std::pair<std::string, std::optional<InterfaceDescription>>> interfaces;  ///< in written order
  std::map<std::string, std::optional<WallDescription>> walls;
  std::map<std::string, std::optional<EngineDescription>> engines;
  std::optional<DomainDescription> domain;
  std::optional<TimeStepDescription> time_step;
  std::optional<GuardsDescription> guards;

  void apply_to(SceneDescription& scene) const;
  /// The change that undoes this one in a scene to which it is not yet applied.
  SettingsChange reverse(const SceneDescription& scene) const;
  /// Adds the present values of a part of a scene; for an entry that does not exist, its removal.
  void add(const SceneDescription& scene, const std::string& section, const std::string& name);
};

/// A number that changes in equal increments.
struct RampPlan {
  std::string pointer;
  SettingsChange begin;  ///< the part that the number belongs to, with the number at `from`
  double from = 0, to = 0;
  double duration = 0;  ///< s
  std::int64_t increments = 1;

  /// After `increment` increments, from 1. Exact at the end, where (to − from) + from may not be.
  double value(std::int64_t increment) const {
    const double fraction = static_cast<double>(increment) / static_cast<double>(increments);
    return increment == increments ? to : from + (to - from) * fraction;
  }
};

/// A stage's changes, and the final values of its ramps, persist in later stages.
struct StagePlan {
  SettingsChange change;
  std::vector<RampPlan> ramps;  ///< one after the other
  std::size_t increments() const {
    std::size_t sum = 0;
    for (const RampPlan& ramp : ramps) sum += static_cast<std::size_t>(ramp.increments);
    return sum;
  }
};

}  // namespace grit
