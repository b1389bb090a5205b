// When a stage ends.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "description/description.hpp"
#include "kernel/kernel.hpp"

namespace grit {

/// Where a stage began.
struct StageStart {
  double time = 0;
  std::uint64_t step = 0;
  double share_left = 0;
};

/// Conditions that need a pass over all bodies or contacts are looked at every so many steps.
inline constexpr std::uint64_t slow_conditions_every = 100;
/// The mean stress is looked at oftener: where bodies grow it rises fast once they touch.
inline constexpr std::uint64_t stress_condition_every = 10;

/// Whether the condition holds. Between looks, slow conditions count as not met.
bool is_met(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// The same without looking at forces: false where the condition surely does not hold.
bool may_be_met(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// Which of several conditions ended a stage whose condition holds, "any" at any depth opened: "left", or "time and
/// unbalanced-force"; "" where there was no choice.
std::string ended_by(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// What a condition that did not hold has come to, and what it waits for, part by part. Looks at slow ones, too.
std::string still_wanting(const Condition& condition, const Kernel& kernel, const StageStart& start);

/// How long a stage lasts that time ends before its first step, less than half a step; nothing of another.
std::optional<double> time_without_a_step(const Condition& condition, const Kernel& kernel);

/// How far on the way the stage is, 0 … 1, where the condition tells: not where all that can be told has come true and
/// it waits for something else.
std::optional<double> progress(const Condition& condition, const Kernel& kernel, const StageStart& start);

}  // namespace grit
