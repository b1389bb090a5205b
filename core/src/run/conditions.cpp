#include "run/conditions.hpp"

#include <algorithm>
#include <cmath>

#include "format/number.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

const WallView& wall(const World& world, const std::string& name) {
  for (const WallView& view : world.walls())
    if (view.name == name) return view;
  throw Error("a condition of a stage refers to wall \"" + name + "\", which does not exist");
}

double stage_displacement(const DisplacementCondition& c, const World& world) {
  return wall(world, c.wall).stage_position[c.axis[0] - 'x'];
}

double stress(const StressCondition& c, const World& world) {
  return mean_stress(world, world.interior(world.mean_diameter()))(c.component[0] - 'x', c.component[1] - 'x');
}

struct Met {
  const Kernel& kernel;
  const StageStart& start;
  bool without_forces;
  bool always_due = false;

  bool due_now(std::uint64_t every = slow_conditions_every) const {
    return always_due || (kernel.world().step() - start.step) % every == 0;
  }

  // Half a step of tolerance: a stage of 1 ms at 0.1 ms a step has ten steps, whatever the rounding of the sum.
  bool operator()(const TimeCondition& c) const {
    return kernel.world().time() - start.time >= c.value - 0.5 * kernel.world().dt();
  }
  bool operator()(const StepsCondition& c) const {
    return kernel.world().step() - start.step >= static_cast<std::uint64_t>(c.value);
  }
  bool operator()(const DisplacementCondition& c) const {
    const double u = stage_displacement(c, kernel.world());
    return c.value > 0 ? u >= c.value : u <= c.value;
  }
  bool operator()(const UnbalancedForceCondition& c) const {
    if (!due_now()) return false;
    if (without_forces) return true;
    const Equilibrium now = equilibrium(kernel.world());
    return now.mean_contact_force > 0 && now.unbalanced_force < c.below;
  }
  bool operator()(const AtRestCondition& c) const {
    return due_now() && (without_forces || support(kernel.world()).at_rest(c.below));
  }
  bool operator()(const KineticEnergyCondition& c) const {
    return due_now() && (without_forces || kernel.kinetic_energy_ratio() < c.below);
  }
  bool operator()(const VoidRatioCondition& c) const {
    if (!due_now()) return false;
    const double e = void_ratio(kernel.world(), kernel.world().interior(kernel.world().mean_diameter()));
    return (!c.below || e < *c.below) && (!c.above || e > *c.above);
  }
  bool operator()(const MeanStressCondition& c) const {
    if (!due_now(stress_condition_every)) return false;
    if (without_forces) return true;
    const double p = mean_stress(kernel.world(), kernel.world().interior(kernel.world().mean_diameter())).trace() / 3;
    return (!c.below || p < *c.below) && (!c.above || p > *c.above);
  }
  bool operator()(const StressCondition& c) const {
    if (!due_now(stress_condition_every)) return false;
    return without_forces ||
           std::abs(stress(c, kernel.world()) - c.value) <= c.within * std::max(std::abs(c.value), 1e-300);
  }
  bool operator()(const PressureCondition& c) const {
    return without_forces ||
           std::abs(wall(kernel.world(), c.wall).pressure - c.value) <= c.within * std::max(c.value, 1e-300);
  }
  bool operator()(const DischargedCondition& c) const {
    return kernel.state().discharged_fraction() >= c.fraction * (1 - 1e-12) || kernel.bodies() == 0;
  }
  bool operator()(const AllCondition& c) const {
    return std::all_of(c.of.begin(), c.of.end(), [&](const auto& one) { return std::visit(*this, one.is.value()); });
  }
  bool operator()(const AnyCondition& c) const {
    return std::any_of(c.of.begin(), c.of.end(), [&](const auto& one) { return std::visit(*this, one.is.value()); });
  }
  bool operator()(std::monostate) const { return true; }
};

/// The types in a condition, with "all" and "any" resolved.
std::string in_words(const Condition& condition, const Met& met) {
  const auto joined = [&](const auto& of, const char* with, bool met_alone) {
    std::string text;
    for (const auto& one : of)
      if (!met_alone || std::visit(met, one.is.value())) text += (text.empty() ? "" : with) + in_words(one, met);
    return text;
  };
  if (const auto* all = std::get_if<AllCondition>(&condition.is.value())) return joined(all->of, " and ", false);
  if (const auto* any = std::get_if<AnyCondition>(&condition.is.value())) return joined(any->of, " and ", true);
  return condition.is.type();
}

bool has_choice(const Condition& condition) {
  const auto& is = condition.is.value();
  if (const auto* any = std::get_if<AnyCondition>(&is)) return any->of.size() > 1;
  const auto* all = std::get_if<AllCondition>(&is);
  return all && std::ranges::any_of(all->of, [](const auto& one) { return has_choice(one); });
}

struct FractionReached {
  const Kernel& kernel;
  const StageStart& start;

  std::optional<double> operator()(const TimeCondition& c) const {
    return (kernel.world().time() - start.time) / c.value;
  }
  std::optional<double> operator()(const StepsCondition& c) const {
    return static_cast<double>(kernel.world().step() - start.step) / static_cast<double>(c.value);
  }
  std::optional<double> operator()(const DisplacementCondition& c) const {
    return stage_displacement(c, kernel.world()) / c.value;
  }
  std::optional<double> operator()(const DischargedCondition& c) const {
    if (c.fraction <= start.discharged_fraction) return 1;
    return (kernel.state().discharged_fraction() - start.discharged_fraction) /
           (c.fraction - start.discharged_fraction);
  }
  std::optional<double> operator()(const AllCondition& c) const {
    std::optional<double> lowest;
    bool all_known = true;
    for (const auto& one : c.of)
      if (const auto p = progress(one, kernel, start)) lowest = lowest ? std::min(*lowest, *p) : p;
      else all_known = false;
    return all_known || (lowest && *lowest < 1) ? lowest : std::nullopt;
  }
  std::optional<double> operator()(const AnyCondition& c) const {
    std::optional<double> highest;
    for (const auto& one : c.of)
      if (const auto p = progress(one, kernel, start)) highest = highest ? std::max(*highest, *p) : p;
    return highest;
  }
  template <class Other>
  std::optional<double> operator()(const Other&) const {
    return std::nullopt;
  }
};

/// Present and required values of conditions that do not hold; "" for one that holds.
struct Unmet {
  const Met met;

  std::string of(const Condition& condition) const {
    return std::visit(met, condition.is.value()) ? "" : std::visit(*this, condition.is.value());
  }
  static std::string between(const std::optional<double>& above, const std::optional<double>& below,
                             const char* unit = "") {
    std::string text;
    if (above) text = " above " + number(*above) + unit;
    if (below) text += (above ? " and below " : " below ") + number(*below) + unit;
    return ", required" + text;
  }

  std::string operator()(const TimeCondition& c) const {
    return "time " + number(met.kernel.world().time() - met.start.time) + " of " + number(c.value) + " s";
  }
  std::string operator()(const StepsCondition& c) const {
    return std::to_string(met.kernel.world().step() - met.start.step) + " of " + std::to_string(c.value) + " steps";
  }
  std::string operator()(const DisplacementCondition& c) const {
    return "displacement of wall \"" + c.wall + "\" along " + c.axis + " " +
           number(stage_displacement(c, met.kernel.world())) + " of " + number(c.value) + " m";
  }
  std::string operator()(const UnbalancedForceCondition& c) const {
    const Equilibrium now = equilibrium(met.kernel.world());
    if (!(now.mean_contact_force > 0)) return "unbalanced force undefined: no contact forces";
    return "unbalanced force " + number(now.unbalanced_force) + between({}, c.below);
  }
  std::string operator()(const AtRestCondition& c) const {
    const Support now = support(met.kernel.world());
    if (!std::isfinite(now.unbalance)) return "no force acts on the bodies, and no contact carries one yet";
    if (now.carried == 0) return "no contact carries load yet";
    const bool loaded = std::isfinite(now.carried);
    return "net forces " + number(now.unbalance) + " of " + (loaded ? "loads and contact forces" : "contact forces") +
           between({}, c.below) +
           (loaded ? ", contacts carry " + number(now.carried) + " of the load, required 0.5" : "");
  }
  std::string operator()(const KineticEnergyCondition& c) const {
    return "kinetic over elastic energy " + number(met.kernel.kinetic_energy_ratio()) + between({}, c.below);
  }
  std::string operator()(const VoidRatioCondition& c) const {
    const double e = void_ratio(met.kernel.world(), met.kernel.world().interior(met.kernel.world().mean_diameter()));
    return "void ratio of the interior " + number(e) + between(c.above, c.below);
  }
  std::string operator()(const MeanStressCondition& c) const {
    const Mat3 stress =
        mean_stress(met.kernel.world(), met.kernel.world().interior(met.kernel.world().mean_diameter()));
    return "mean stress " + number(stress.trace() / 3) + " Pa" + between(c.above, c.below, " Pa");
  }
  std::string operator()(const StressCondition& c) const {
    return "stress " + c.component + ' ' + number(stress(c, met.kernel.world())) + " Pa, required " + number(c.value) +
           " Pa ± " + number(100 * c.within) + " %";
  }
  std::string operator()(const PressureCondition& c) const {
    return "pressure on wall \"" + c.wall + "\" " + number(wall(met.kernel.world(), c.wall).pressure + 0.0) +
           " Pa, required " + number(c.value) + " Pa ± " + number(100 * c.within) + " %";
  }
  std::string operator()(const DischargedCondition& c) const {
    return number(100 * met.kernel.state().discharged_fraction()) + " % of the mass discharged, required " +
           number(100 * c.fraction) + " %";
  }
  std::string operator()(const AllCondition& c) const { return joined(c.of, "; "); }
  std::string operator()(const AnyCondition& c) const {
    const std::string parts = joined(c.of, " or ");
    return c.of.size() > 1 ? "either " + parts : parts;
  }
  std::string operator()(std::monostate) const { return ""; }

 private:
  std::string joined(const std::vector<Condition>& conditions, const char* with) const {
    std::string text;
    for (const auto& one : conditions)
      if (const std::string part = of(one); !part.empty()) text += (text.empty() ? "" : with) + part;
    return text;
  }
};

/// Duration of conditions that time ends.
struct Duration {
  std::optional<double> operator()(const TimeCondition& c) const { return c.value; }
  std::optional<double> operator()(const AllCondition& c) const {
    std::optional<double> longest;
    for (const auto& one : c.of)
      if (const auto time = std::visit(*this, one.is.value())) longest = std::max(longest, time);
      else return std::nullopt;
    return longest;
  }
  std::optional<double> operator()(const AnyCondition& c) const {
    std::optional<double> shortest;
    for (const auto& one : c.of)
      if (const auto time = std::visit(*this, one.is.value())) shortest = std::min(shortest.value_or(*time), *time);
    return shortest;
  }
  template <class Other>
  std::optional<double> operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

bool is_met(const Condition& condition, const Kernel& kernel, const StageStart& start) {
  return std::visit(Met{kernel, start, false}, condition.is.value());
}

bool may_be_met(const Condition& condition, const Kernel& kernel, const StageStart& start) {
  return std::visit(Met{kernel, start, true}, condition.is.value());
}

bool waits_for_contacts(const Condition& condition) {
  const auto& is = condition.is.value();
  if (const auto* all = std::get_if<AllCondition>(&is)) return std::ranges::any_of(all->of, waits_for_contacts);
  if (const auto* any = std::get_if<AnyCondition>(&is)) return std::ranges::all_of(any->of, waits_for_contacts);
  return std::holds_alternative<AtRestCondition>(is) || std::holds_alternative<UnbalancedForceCondition>(is) ||
         std::holds_alternative<KineticEnergyCondition>(is);
}

std::string ended_by(const Condition& condition, const Kernel& kernel, const StageStart& start) {
  return has_choice(condition) ? in_words(condition, Met{kernel, start, false}) : "";
}

std::string in_flight(const Condition& condition, const World& world) {
  const auto refers_to_unbalanced_force = [](const auto& self, const Condition& one) -> bool {
    const auto& is = one.is.value();
    if (std::holds_alternative<UnbalancedForceCondition>(is)) return true;
    const auto any_of = [&](const auto* parts) {
      return parts != nullptr &&
             std::ranges::any_of(parts->of, [&](const Condition& part) { return self(self, part); });
    };
    return any_of(std::get_if<AllCondition>(&is)) || any_of(std::get_if<AnyCondition>(&is));
  };
  if (!refers_to_unbalanced_force(refers_to_unbalanced_force, condition)) return "";
  const Support now = support(world);
  if (now.carried >= 0.5) return "";
  return "; contacts carry only " + number(100 * now.carried) +
         " % of the load, so that grains are in flight: the condition \"at-rest\" excludes this";
}

std::string still_wanting(const Condition& condition, const Kernel& kernel, const StageStart& start) {
  const std::string parts = Unmet{{kernel, start, false, true}}.of(condition);
  return parts.empty() ? "its condition holds now, but did not when it was last evaluated" : parts;
}

std::optional<double> duration(const Condition& condition) { return std::visit(Duration{}, condition.is.value()); }

std::optional<double> progress(const Condition& condition, const Kernel& kernel, const StageStart& start) {
  const auto raw = std::visit(FractionReached{kernel, start}, condition.is.value());
  return raw ? std::optional(std::clamp(*raw, 0.0, 1.0)) : std::nullopt;
}

}  // namespace grit
