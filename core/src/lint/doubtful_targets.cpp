#include "lint/doubtful_targets.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>

#include "description/wall_ways.hpp"
#include "lint/all_stages.hpp"

namespace grit {
namespace {

constexpr std::size_t normal_components = 3;  // xx, yy, zz come first

/// Whether any bodies, or bodies and walls, may attract each other.
bool attracts(const ContactLaw& law) {
  constexpr double radius = 1e-3;  // m; any has a reach or none
  return std::ranges::any_of(law.reaches(radius), [](double reach) { return reach > 0; });
}

/// Values of a servo during the stages, if it acts throughout.
struct Range {
  std::optional<double> low, high;
  void add(double value) { low = std::min(low.value_or(value), value), high = std::max(high.value_or(value), value); }
  bool known() const { return low.has_value(); }
};

/// Targets at an instant.
struct Targets {
  std::map<std::string, double> pressures;  ///< by wall
  std::array<std::optional<double>, 6> cell;
};

Targets targets_of(const SceneDescription& now) {
  Targets targets;
  for (const auto& [name, wall] : now.walls)
    if (const auto& servo = wall.motion.servo; servo && servo->pressure) targets.pressures[name] = *servo->pressure;
  if (now.domain.servo) targets.cell = now.domain.servo->targets();
  return targets;
}

using Target = std::function<std::optional<double>(const Targets& now)>;
using Instants = std::vector<Targets>;

/// Judges the conditions of a stage. The first stage begins without stress, or with that of a sample.
struct TargetJudge {
  const Instants& before;  ///< in the stage before
  const Instants& during;
  bool is_first, has_sample;

  std::vector<UnusedSetting> at(const Condition& condition, const std::string& pointer) const {
    const auto& is = condition.is.value();
    if (const auto* all = std::get_if<AllCondition>(&is)) return each(all->of, pointer, false);
    if (const auto* any = std::get_if<AnyCondition>(&is)) return each(any->of, pointer, true);
    if (const auto* pressure = std::get_if<PressureCondition>(&is)) return judge(*pressure, pointer);
    if (const auto* stress = std::get_if<StressCondition>(&is)) return judge(*stress, pointer);
    if (const auto* mean = std::get_if<MeanStressCondition>(&is)) return judge(*mean, pointer);
    return {};
  }

 private:
  Range range_of(const Target& target) const {
    Range range;
    if (is_first && has_sample) return {};
    if (is_first) range.add(0);
    for (const Instants* instants : {&before, &during})
      for (const Targets& now : *instants) {
        const auto value = target(now);
        if (!value) return {};
        range.add(*value);
      }
    return range;
  }

  /// If one of several is enough, messages only if none of them can be met.
  std::vector<UnusedSetting> each(const std::vector<Condition>& parts, const std::string& pointer,
                                  bool one_is_enough) const {
    std::vector<UnusedSetting> all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto of_part = at(parts[i], pointer + "/of/" + std::to_string(i));
      if (one_is_enough && of_part.empty()) return {};
      all.insert(all.end(), of_part.begin(), of_part.end());
    }
    return all;
  }

  static std::string kept(const std::string& servo, const Range& range) {
    const double most = std::abs(*range.high) > std::abs(*range.low) ? *range.high : *range.low;
    return fmt::format(
        "; {} keeps at most {:.4g} Pa in this stage: set its target to the value of the condition, or "
        "wait for a value that it reaches",
        servo, most);
  }

  std::vector<UnusedSetting> missed(const std::string& pointer, const std::string& of, double value, double within,
                                    const std::string& servo, const Target& target) const {
    const Range range = range_of(target);
    const double tolerance = within * std::abs(value);
    if (!range.known() || (value + tolerance >= *range.low && value - tolerance <= *range.high)) return {};
    return {{pointer,
             fmt::format("waits for {} of {:.4g} Pa within {:.4g} Pa", of, value, tolerance) + kept(servo, range)}};
  }

  std::vector<UnusedSetting> judge(const PressureCondition& c, const std::string& pointer) const {
    return missed(pointer, "a pressure on wall \"" + c.wall + '"', c.value, c.within, "its servo",
                  [&](const Targets& now) -> std::optional<double> {
                    const auto target = now.pressures.find(c.wall);
                    return target != now.pressures.end() ? std::optional(target->second) : std::nullopt;
                  });
  }

  std::vector<UnusedSetting> judge(const StressCondition& c, const std::string& pointer) const {
    const auto k = static_cast<std::size_t>(std::ranges::find(cell_components, c.component) - cell_components.begin());
    return missed(pointer, "a stress " + c.component, c.value, c.within, "the servo of the cell",
                  [&](const Targets& now) { return now.cell.at(k); });
  }

  std::vector<UnusedSetting> judge(const MeanStressCondition& c, const std::string& pointer) const {
    const Range range = range_of([](const Targets& now) -> std::optional<double> {
      double sum = 0;
      for (std::size_t k = 0; k < normal_components; ++k) {
        if (!now.cell[k]) return std::nullopt;
        sum += *now.cell[k];
      }
      return sum / normal_components;
    });
    if (!range.known()) return {};
    const std::string servo = "the servo of the cell";
    if (c.above && *range.high < *c.above)
      return {{pointer, fmt::format("waits for a mean stress above {:.4g} Pa", *c.above) + kept(servo, range)}};
    if (c.below && *range.low > *c.below)
      return {{pointer, fmt::format("waits for a mean stress below {:.4g} Pa; {} keeps at least {:.4g} Pa in this "
                                    "stage: set its targets below the value of the condition",
                                    *c.below, servo, *range.low)}};
    return {};
  }
};

}  // namespace

std::vector<UnusedSetting> tensile_targets(const Scene& described,
                                           const std::map<std::string, std::shared_ptr<const Geometry>>& geometries) {
  std::vector<UnusedSetting> all;
  std::set<std::string> reported;
  const auto say = [&](const std::string& pointer, const std::string& found, const std::string& advice) {
    if (reported.insert(pointer).second)
      all.push_back({pointer, "the servo pulls with " + found + ", which bodies without attraction cannot bear; " +
                                  advice + ", or use a contact law with cohesion"});
  };
  std::set<std::string> turned;  // names of walls whose normal may have changed
  MixedLaw mixed(*described.description);
  through_stages(
      *described.description, described.stages, [&](const SceneDescription& now, std::optional<std::size_t>) {
        mixed.follow(now);
        if (attracts(mixed.law())) return true;
        if (now.domain.servo)
          for (std::size_t k = 0; k < normal_components; ++k)
            if (const auto target = now.domain.servo->targets()[k]; target && *target < 0)
              say("/domain/servo/stress/" + cell_components[k], fmt::format("{:.4g} Pa", *target),
                  "compression is positive: set a target above 0");
        for (const auto& [name, wall] : now.walls) {
          const auto& servo = wall.motion.servo;
          const auto geometry = geometries.find(name);
          if (turns(wall.motion)) turned.insert(name);
          const bool is_known = geometry != geometries.end() && !turned.contains(name) &&
                                wall.geometry == described.description->walls.at(name).geometry;
          if (!servo || !servo->force || !is_known) continue;
          constexpr double parallel = 0.99;
          const double normal = geometry->second->normal()[servo->axis.front() - 'x'];
          if (std::abs(normal) > parallel && *servo->force * normal < 0)
            say("/walls/" + pointer_token(name) + "/motion/servo/force", fmt::format("{:.4g} N", *servo->force),
                std::string("the force of the wall on the bodies acts along its normal: set a force ") +
                    (normal > 0 ? "above" : "below") + " 0");
        }
        return true;
      });
  return all;
}

std::vector<UnusedSetting> missed_targets(const Scene& described) {
  const auto& stages = described.description->stages;
  std::vector<Instants> targets(stages.size());
  through_stages(*described.description, described.stages,
                 [&](const SceneDescription& now, std::optional<std::size_t> stage) {
                   if (stage) targets[*stage].push_back(targets_of(now));
                   return true;
                 });
  const Instants none;
  std::vector<UnusedSetting> all;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const TargetJudge judge{i > 0 ? targets[i - 1] : none, targets[i], i == 0,
                            described.description->begin.has_value()};
    std::ranges::move(judge.at(stages[i].until, "/stages/" + std::to_string(i) + "/until"), std::back_inserter(all));
  }
  return all;
}

}  // namespace grit
