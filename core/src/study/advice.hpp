// Applies the evidence of a study to a description.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace grit {

/// What a level of a setting was found to do, the finest level as the reference. Shares of the figures' scales.
struct Evidence {
  std::string level;
  std::vector<std::string> sets;  ///< "/pointer=value"
  double cost = 1;                ///< over that of the finest level
  double error = 0, standard_error = 0;
  std::string figure;  ///< in which the error is the largest; empty for the finest
  bool known = true;   ///< false if runs of it, or of the finest level, failed
};

/// A chart.json, as far as advice needs it.
struct ChartedStudy {
  std::filesystem::path file;
  std::string title, scenario;
  std::size_t samples = 0;
  std::map<std::string, std::vector<Evidence>> settings;  ///< from the cheapest level to the finest
};

/// `figures`: those that count; none: all. Throws FileError, and Error if a figure is unknown.
ChartedStudy read_charted_study(const std::filesystem::path& file, const std::vector<std::string>& figures);

enum class Confidence {
  certain,     ///< twice the standard error more would still be within the tolerance
  likely,      ///< the error is within the tolerance, the scatter is not
  untold,      ///< the error is no larger than the scatter, which is beyond the tolerance
  impossible,  ///< the error is beyond the tolerance
};
Confidence confidence(const Evidence& evidence, double tolerance);

struct Advice {
  std::string setting;
  std::string found;               ///< why there is no level; empty if there is one
  const Evidence* now = nullptr;   ///< level that the description has
  const Evidence* best = nullptr;  ///< the cheapest within the tolerance that is cheaper than that, certain or likely
  std::vector<const Evidence*> cheaper;  ///< all that are cheaper than now, or are coarser and failed
  bool taken = false;                    ///< part of what is advised together
};

/// `same(sets)`: whether the description stays the same with these. Settings are taken together as long as their errors
/// add up to no more than the tolerance, those first that save the most for their error.
std::vector<Advice> advise(const ChartedStudy& study, double tolerance,
                           const std::function<bool(const std::vector<std::string>&)>& same);

}  // namespace grit
