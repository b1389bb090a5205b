// Results of a study: cost of the runs, their metrics, and the deviations from a reference.
#pragma once

#include <cmath>
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
#include "study/metrics.hpp"
#include "study/variants.hpp"

namespace grit {

/// One run: a variant with a seed.
struct Sample {
  double seed = 0;
  std::string status;    ///< "done", "failed", "under way" or "missing"; "failed" also if it lacks an evaluated metric,
                         ///< or ends before the reference of a curve does; "under way" also if it was interrupted
  std::string message;   ///< why it failed
  std::string revision;  ///< of grit
  double core_seconds = 0, steps = 0, bodies = 0;
  std::map<std::string, Metric> metrics;
  std::map<std::string, std::string> lacks;  ///< metrics that could not be evaluated, and why

  /// Mean speed of the run in CPU time, which depends less on other processes than wall-clock time.
  double particle_steps_per_core_second() const { return core_seconds > 0 ? bodies * steps / core_seconds : 0; }
};

/// The run in a folder, with its metrics if it is done. Throws FileError if it lacks a channel.
Sample read_sample(const std::map<std::string, MetricDescription>& metrics, double seed,
                   const std::filesystem::path& folder);

/// A metric of a variant compared with the reference. Errors are fractions of the metric's scale; NaN if unknown, such
/// as the scatter of one sample.
struct Deviation {
  double mean = std::numeric_limits<double>::quiet_NaN();   ///< over samples; of a curve, its root mean square
  double error = std::numeric_limits<double>::quiet_NaN();  ///< |mean − reference|; of a curve, root mean square
  double standard_error =
      std::numeric_limits<double>::quiet_NaN();               ///< of that difference, from its scatter between samples
  double scatter = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation between samples
};

/// A metric with a single value, with or without a reference.
struct Value {
  double mean = 0;     ///< over samples
  double scatter = 0;  ///< standard deviation between samples; NaN for one sample
  std::string unit;
  std::size_t samples = 1;

  double standard_error() const { return scatter / std::sqrt(static_cast<double>(samples)); }
};

/// The mean curve of a metric over samples, where all of them have it.
struct MeanCurve {
  std::vector<double> x, mean, scatter;  ///< scatter: NaN for one sample
  std::string unit, x_unit;
  std::size_t samples = 1;
};

struct VariantResult {
  Variant variant;
  std::vector<Sample> samples;
  double core_seconds = 0, steps = 0, particle_steps_per_core_second = 0;  ///< means of the finished samples
  double cost_scatter = std::numeric_limits<double>::quiet_NaN();          ///< standard deviation of core_seconds
  std::map<std::string, Value> values;           ///< metrics with one value; empty if a sample is not done, but in a
                                                 ///< sweep of the samples that are
  std::map<std::string, MeanCurve> curves;       ///< in a sweep, the other metrics of the samples that are done
  std::map<std::string, Deviation> deviations;   ///< by metric; empty if a sample failed
  std::string worst;                             ///< metric with the largest error
  bool on_front = false;                         ///< Pareto-optimal: no other is both cheaper and more accurate
  Confidence within = Confidence::inconclusive;  ///< within the tolerance; least certain of itself and all finer ones
  std::string decided_by;                        ///< the finer variant that decides `within`; empty if it is itself

  bool complete() const { return !deviations.empty(); }
  /// Confidence of this variant alone: that of its least certain metric.
  Confidence confidence(double tolerance) const;
  const Deviation& of_worst() const { return deviations.at(worst); }
};

/// Effect of one setting, the others at their usual levels: a level compared with the finest.
struct Effect {
  std::string setting, level;
  double cost = 0, cost_error = 0;              ///< relative to the finest level, and its standard error
  std::map<std::string, Deviation> deviations;  ///< by metric, with the finest level as the reference
};

struct StudyResult {
  StudyDescription study;
  std::string scenario;                 ///< of the scene; empty if it has none
  std::vector<std::string> parts;       ///< components of the scene, from parts_of(); none without a run
  std::set<std::string> revisions;      ///< of grit in the runs
  bool random = true;                   ///< whether the seed can affect the scene
  bool alike = true;                    ///< whether all samples are identical to the last digit
  std::vector<VariantResult> variants;  ///< the finest last
  std::map<std::string, Metric> reference;
  std::map<std::string, double> scale;             ///< errors are divided by this
  std::map<std::string, std::string> unevaluated;  ///< metrics without a usable reference, and why
  std::vector<Effect> effects;
  std::optional<std::size_t> cheapest;  ///< cheapest variant within the tolerance, certain or likely

  /// In a study of accuracy.
  const VariantResult& finest() const { return variants.back(); }
  bool is_finest(const VariantResult& one) const { return !study.is_sweep() && &one == &variants.back(); }
  /// The number of runs with this status, and of all.
  std::size_t count(const char* status) const;
  std::size_t runs() const { return variants.size() * study.seeds.values.size(); }
  /// Corrects a scatter computed from samples that are identical: 0 if the scene is not random, NaN if it is, as all
  /// samples then count as one.
  double scatter(double computed) const;
};

/// Evaluates the runs below `folder`; those in `omitted` count as missing. Throws FileError if a finished run lacks a
/// channel.
StudyResult evaluate_study(StudyDescription study, const std::filesystem::path& folder,
                           const std::set<std::filesystem::path>& omitted = {});

/// study.json: all of the above except curves.
Description to_json(const StudyResult& result);
/// One row per variant and metric. Of a sweep the mean, its standard error, and the difference from a given value.
std::string to_csv(const StudyResult& result);

}  // namespace grit
