// Speed against accuracy: what the runs of a study cost, and how far they are from the reference.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "study/confidence.hpp"
#include "study/description.hpp"
#include "study/figures.hpp"
#include "study/variants.hpp"

namespace grit {

/// One run: a variant with a seed.
struct Sample {
  double seed = 0;
  std::string status;  ///< "done", "failed" or "missing"; "failed" too if it lacks a figure that is charted, or did not
                       ///< get to where a curve's reference goes
  std::string message;   ///< why it failed
  std::string revision;  ///< of the grit that ran it
  double core_seconds = 0, steps = 0, bodies = 0;
  std::map<std::string, Figure> figures;
  std::map<std::string, std::string> lacks;  ///< figures that could not be taken of it, and why

  /// Of the whole run; what runs beside it hardly changes it, as it does the wall clock's.
  double particle_steps_per_core_second() const { return core_seconds > 0 ? bodies * steps / core_seconds : 0; }
};

/// A figure of a variant beside the reference. Shares are of the figure's scale; NaN where it cannot be told: the
/// scatter of one sample.
struct Deviation {
  double mean = std::numeric_limits<double>::quiet_NaN();   ///< over samples; of a curve, its root mean square
  double error = std::numeric_limits<double>::quiet_NaN();  ///< |mean − reference|; of a curve, root mean square
  double standard_error =
      std::numeric_limits<double>::quiet_NaN();               ///< of that difference, from its scatter between samples
  double scatter = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation between samples
};

/// What a figure of one value came to, with or without a reference.
struct Value {
  double mean = 0;     ///< over samples
  double scatter = 0;  ///< standard deviation between them; NaN of one sample
  std::string unit;
};

struct VariantResult {
  Variant variant;
  std::vector<Sample> samples;
  double core_seconds = 0, steps = 0, particle_steps_per_core_second = 0;  ///< means of the samples that are done
  double cost_scatter = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of core_seconds between them
  std::map<std::string, Value> values;                             ///< by figure of one value; empty if a sample failed
  std::map<std::string, Deviation> deviations;                     ///< by figure; empty if a sample failed
  std::string worst;                                               ///< figure with the largest error
  bool on_front = false;                                           ///< no other is both cheaper and nearer
  Confidence within = Confidence::untold;  ///< the tolerance: of itself and of all that are finer, the least sure
  std::string decided_by;                  ///< the finer variant which that is; empty if it is itself

  bool complete() const { return !deviations.empty(); }
  /// Its own, of the figure that is least sure.
  Confidence confidence(double tolerance) const;
  const Deviation& of_worst() const { return deviations.at(worst); }
};

/// What one setting does alone, the others as usual: a level beside the finest.
struct Effect {
  std::string setting, level;
  double cost = 0, cost_error = 0;              ///< over that of the finest level, and its standard error
  std::map<std::string, Deviation> deviations;  ///< by figure, with the finest level as the reference
};

struct Chart {
  StudyDescription study;
  std::string scenario;                 ///< of the scene; empty if it has none
  std::vector<std::string> parts;       ///< of the scene, as parts_of() says them; none without a run
  std::set<std::string> revisions;      ///< of the grit that made the runs
  bool random = true;                   ///< whether a seed decides anything of the scene
  bool alike = true;                    ///< whether no seed made any difference to the last digit
  std::vector<VariantResult> variants;  ///< the finest last
  std::map<std::string, Figure> reference;
  std::map<std::string, double> scale;           ///< what errors are divided by
  std::map<std::string, std::string> uncharted;  ///< figures without a reference that serves, and why
  std::vector<Effect> effects;
  std::optional<std::size_t> cheapest;  ///< variant of least cost that is within the tolerance, certain or likely

  const VariantResult& finest() const { return variants.back(); }
  /// Of what was computed from samples: 0 where nothing is random, so that there is none, and NaN where something is
  /// and the seeds did not change it, so that all samples are one.
  double scatter(double computed) const;
};

/// Reads what is in the runs' folders below `folder`. Throws FileError if a run that is done lacks a channel.
Chart make_chart(StudyDescription study, const std::filesystem::path& folder);

/// chart.json: everything above but whole curves.
Description to_json(const Chart& chart);
/// One row a variant and figure.
std::string to_csv(const Chart& chart);

}  // namespace grit
