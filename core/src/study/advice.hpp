// Applies the evidence of a study to a description.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "study/confidence.hpp"

namespace grit {

/// What a figure was found to change by. Shares of the figure's scale; NaN is the standard error of a single sample.
struct Finding {
  std::string figure;
  double error = 0, standard_error = 0;
};

/// What a level of a setting was found to do, the finest level as the reference.
struct Evidence {
  std::string level;
  std::vector<std::string> sets;       ///< "/pointer=value"
  double cost = 1, cost_error = 0;     ///< over that of the finest level, and its standard error
  std::vector<Finding> findings = {};  ///< of each figure that counts; none for the finest
  bool known = true;                   ///< false if runs of it, or of the finest level, failed

  /// Its own, of the figure that is least sure.
  Confidence confidence(double tolerance) const;
  /// That figure, of several the one that changes most; nothing for the finest.
  const Finding* decisive(double tolerance) const;
};

/// A chart.json, as far as advice needs it.
struct ChartedStudy {
  std::filesystem::path file;
  std::string title, scenario;
  std::vector<std::string> parts;  ///< of its scene, as parts_of() says them
  bool advice = true;              ///< whether its settings are of the method, not of what is modelled
  std::size_t samples = 0;
  std::string of_samples = {};                                 ///< what there is to say of them; may be empty
  std::map<std::string, std::vector<Evidence>> settings = {};  ///< from the cheapest level to the finest
  std::vector<std::string> figures = {};                       ///< those that count and are charted
  std::map<std::string, std::string> uncharted = {};           ///< those that count as well, and why they are not
  /// Variants beside the references that figures have of their own.
  std::vector<Evidence> beside_references = {};
};

/// `figures`: those that count; none: all. Throws FileError, also if the chart tells nothing of them, and Error if a
/// figure is unknown.
ChartedStudy read_charted_study(const std::filesystem::path& file, const std::vector<std::string>& figures);

/// The nearest that any variant gets to the reference that a figure has of its own, for each figure where all are too
/// far from it.
std::vector<Finding> far_off(const ChartedStudy& study, double tolerance);

/// One setting.
struct Advice {
  std::string setting;
  std::string found;              ///< why there is no level; empty if there is one
  const Evidence* now = nullptr;  ///< level that the description has
  /// Those cheaper than that which are within the tolerance by themselves, certain or likely, but for those that save
  /// nothing beside a finer one and change no figure by less; the cheapest first.
  std::vector<const Evidence*> within;
  /// The cheapest that is cheaper than that and finer, and changes no figure by more: nothing speaks against it.
  const Evidence* finer = nullptr;
  std::vector<const Evidence*> cheaper;  ///< all that are cheaper than now, or are coarser and failed
  const Evidence* taken = nullptr;       ///< one of these that is part of what is advised together

  /// What the setting has once the advice is taken.
  const Evidence* then() const { return taken != nullptr ? taken : now; }
  /// Levels stand from the cheapest to the finest.
  bool is_relaxed() const { return taken != nullptr && taken < now; }
};

/// What decides whether a level is within the tolerance: the level itself, or the finest of those finer ones of its
/// setting that are less sure. `levels`: all of the setting, as in ChartedStudy.
const Evidence& least_sure(const std::vector<Evidence>& levels, const Evidence& level, double tolerance);

/// Whether a level costs less than another by more than their times scatter.
bool saves(const Evidence& level, const Evidence& than);

/// `same(sets)`: whether the description stays the same with these. Of all combinations of levels the cheapest is taken
/// for which the tolerance holds with what all settings change, those that stay as they are included. What is finer and
/// cheaper is taken whatever the others change.
std::vector<Advice> advise(const ChartedStudy& study, double tolerance,
                           const std::function<bool(const std::vector<std::string>&)>& same);

/// The cheapest finer level that is within the tolerance, certain or likely; nothing for the finest. `levels`: all of
/// the setting, as in ChartedStudy.
const Evidence* within_and_finer(const std::vector<Evidence>& levels, const Evidence& level, double tolerance);

/// What all settings of a description change once the advice is taken, if they do not act on each other: errors of a
/// figure add up. The cost is over what it is without the advice.
Evidence together(const std::vector<Advice>& advices);

}  // namespace grit
