// When a stage ends.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "description/description.hpp"
#include "kernel/kernel.hpp"

namespace grit {

/// State at the start of a stage.
struct StageStart {
  double time = 0;
  std::uint64_t step = 0;
  double discharged_fraction = 0;
};

/// Interval in steps at which conditions that need a pass over all bodies or contacts are evaluated.
inline constexpr std::uint64_t slow_conditions_every = 100;
/// The same for the mean stress: it increases fast when growing bodies touch.
inline constexpr std::uint64_t stress_condition_every = 10;

/// Whether the condition holds. Between evaluations, slow conditions count as not met.
bool is_met(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// The same without forces: false if the condition cannot hold.
bool may_be_met(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// Whether the condition holds only once contacts carry forces.
bool waits_for_contacts(const Condition& condition);

/// Which of several conditions ended a stage, with "any" resolved at all levels: "discharged", or "time and
/// unbalanced-force"; "" if there was no alternative. Requires that the condition holds.
std::string ended_by(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// A warning if the unbalanced force ended a stage, although contacts carry less than half of the load; else empty.
std::string in_flight(const Condition& condition, const World& world);

/// Present and required values of each unmet part of a condition. Evaluates slow ones, too.
std::string still_wanting(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// Duration of a stage that ends by time [s]; empty for others.
std::optional<double> duration(const Condition& condition);

/// Progress of the stage, 0 … 1. Empty if the condition does not define it, or if all parts that do are met and others
/// are not.
std::optional<double> progress(const Condition& condition, const Kernel& kernel, const StageStart& start);

}  // namespace grit
