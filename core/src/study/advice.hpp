// Applies the results of a study to a description.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "study/confidence.hpp"

namespace grit {

/// Change of a metric, as a fraction of the metric's scale. The standard error of a single sample is NaN.
struct Finding {
  std::string metric;
  double error = 0, standard_error = 0;
};

/// Cost and changes of a level of a setting, relative to the finest level.
struct Evidence {
  std::string level;
  std::vector<std::string> sets;       ///< "/pointer=value"
  double cost = 1, cost_error = 0;     ///< relative to the finest level, and its standard error
  std::vector<Finding> findings = {};  ///< one per selected metric; none for the finest
  bool known = true;                   ///< false if runs at this or the finest level failed

  /// Confidence of this level alone: that of its least certain metric.
  Confidence confidence(double tolerance) const;
  /// The least certain metric; if several, the one that changes most. Null for the finest level.
  const Finding* decisive(double tolerance) const;
};

/// The part of study.json that advice needs.
struct EvaluatedStudy {
  std::filesystem::path file;
  std::string title, scenario;
  std::vector<std::string> parts;  ///< components of its scene, from parts_of()
  bool sweep = false;              ///< whether its settings are other than numerical: it gives no advice
  std::size_t samples = 0;
  std::string of_samples = {};                                 ///< a remark on the samples; may be empty
  std::map<std::string, std::vector<Evidence>> settings = {};  ///< from the cheapest level to the finest
  std::vector<std::string> metrics = {};                       ///< selected metrics that were evaluated
  std::map<std::string, std::string> unevaluated = {};         ///< other selected metrics, and the reasons
  /// Errors of variants relative to metrics' own references.
  std::vector<Evidence> beside_references = {};
};

/// `metrics`: selected metrics; all if empty. Throws FileError, also if no selected metric has errors, and Error if a
/// metric is unknown.
EvaluatedStudy read_evaluated_study(const std::filesystem::path& file, const std::vector<std::string>& metrics);

/// For each metric with its own reference from which all variants deviate by more than the tolerance: the smallest
/// deviation.
std::vector<Finding> far_off(const EvaluatedStudy& study, double tolerance);

/// Advice on one setting.
struct Advice {
  std::string setting;
  std::string found;              ///< why the description has none of the levels; empty if it has one
  const Evidence* now = nullptr;  ///< level of the description
  /// Cheaper levels that are within the tolerance on their own, certain or likely, cheapest first. Without levels that
  /// save nothing over a finer one that changes no metric by more.
  std::vector<const Evidence*> within;
  /// The cheapest level that is cheaper and finer than the present one and changes no metric by more.
  const Evidence* finer = nullptr;
  std::vector<const Evidence*> cheaper;  ///< all levels that are cheaper, or coarser and failed
  const Evidence* taken = nullptr;       ///< the advised level; null: no change

  /// The level after the advice is applied.
  const Evidence* then() const { return taken != nullptr ? taken : now; }
  /// Levels are ordered from the cheapest to the finest.
  bool is_relaxed() const { return taken != nullptr && taken < now; }
};

/// The level that decides whether `level` is within the tolerance: itself, or the least certain of the finer ones (of
/// several the finest). `levels`: all levels of the setting, as in EvaluatedStudy.
const Evidence& least_sure(const std::vector<Evidence>& levels, const Evidence& level, double tolerance);

/// Whether a level costs less than another by more than twice the standard error.
bool saves(const Evidence& level, const Evidence& than);

/// `same(sets)`: whether the description is unchanged by these. Advises the cheapest combination of levels for which
/// the summed changes of all settings, including unchanged ones, are within the tolerance. A level that is finer and
/// cheaper is always advised.
std::vector<Advice> advise(const EvaluatedStudy& study, double tolerance,
                           const std::function<bool(const std::vector<std::string>&)>& same);

/// The cheapest finer level that is within the tolerance, certain or likely; null if there is none. `levels`: all
/// levels of the setting, as in EvaluatedStudy.
const Evidence* within_and_finer(const std::vector<Evidence>& levels, const Evidence& level, double tolerance);

/// Changes by all settings after the advice is applied, assuming that they do not interact: errors of a metric are
/// summed. The cost is relative to that without the advice.
Evidence together(const std::vector<Advice>& advices);

}  // namespace grit
