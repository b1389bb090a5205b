#include "study/study_result.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "format/csv.hpp"
#include "grit/error.hpp"
#include "input/scene.hpp"
#include "output/read_results.hpp"
#include "output/reference_curve.hpp"
#include "study/parts.hpp"
#include "study/study_sentences.hpp"

namespace grit {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
/// Number of abscissae at which curves are compared.
constexpr std::size_t curve_points = 200;
/// Fraction of its reference's range that a curve has to cover.
constexpr double least_reach = 0.9;

bool all_done(const VariantResult& outcome) {
  return std::ranges::all_of(outcome.samples, [](const Sample& sample) { return sample.status == "done"; });
}

/// Statistics of a metric over samples at the abscissae of comparison: one entry for a single value.
struct Sampled {
  std::vector<double> mean, variance;  ///< the variance of one sample is NaN
};

/// By abscissa, then by sample; a single value has one entry.
std::vector<std::vector<double>> values_at(const std::vector<const Metric*>& metrics, const std::vector<double>& x) {
  std::vector<std::vector<double>> values(metrics.front()->x.empty() ? 1 : x.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    for (const Metric* metric : metrics) values[k].push_back(metric->x.empty() ? metric->y.front() : at(*metric, x[k]));
  return values;
}

Sampled sampled(const std::vector<std::vector<double>>& by_abscissa) {
  Sampled outcome;
  for (const auto& values : by_abscissa) {
    const auto count = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double value : values) sum += value;
    for (const double value : values) squares += (value - sum / count) * (value - sum / count);
    outcome.mean.push_back(sum / count);
    outcome.variance.push_back(count > 1 ? squares / (count - 1) : unknown);
  }
  return outcome;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<const Metric*> metrics_of(const VariantResult& outcome, const std::string& name) {
  std::vector<const Metric*> all;
  for (const Sample& sample : outcome.samples) all.push_back(&sample.metrics.at(name));
  return all;
}

/// Abscissae within the range that all curves share; empty for single values. Nothing if curves share no range.
std::optional<std::vector<double>> shared_abscissae(const std::vector<const Metric*>& a,
                                                    const std::vector<const Metric*>& b) {
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (const auto* metrics : {&a, &b})
    for (const Metric* metric : *metrics) {
      if (metric->x.empty()) return std::vector<double>();
      low = std::max(low, metric->x.front()), high = std::min(high, metric->x.back());
    }
  if (!(low <= high)) return std::nullopt;
  std::vector<double> x(curve_points);
  for (std::size_t k = 0; k < curve_points; ++k)
    x[k] = std::clamp(low + (high - low) * static_cast<double>(k) / (curve_points - 1), low, high);
  return x;
}

/// Paired by seed, so that common deviations of one seed cancel in the scatter of the difference. An external reference
/// is the same for all samples.
Deviation deviation(const StudyResult& result, const std::vector<const Metric*>& from,
                    const std::vector<const Metric*>& reference, double scale) {
  const auto x = shared_abscissae(from, reference).value();
  const Sampled own = sampled(values_at(from, x));
  auto differences = values_at(from, x);
  const auto others = values_at(reference, x);
  for (std::size_t k = 0; k < differences.size(); ++k)
    for (std::size_t s = 0; s < differences[k].size(); ++s)
      differences[k][s] -= others[k][others[k].size() > 1 ? s : 0];
  const Sampled difference = sampled(differences);
  return {.mean = own.mean.size() == 1 ? own.mean.front() : root_mean_square(own.mean),
          .error = root_mean_square(difference.mean) / scale,
          .standard_error =
              result.scatter(std::sqrt(mean_of(difference.variance) / static_cast<double>(from.size())) / scale),
          .scatter = result.scatter(std::sqrt(mean_of(own.variance)) / scale)};
}

std::string of_the_finest(const Sample& sample, const std::string& why) {
  return fmt::format("finest settings, seed {:.0f}: {}", sample.seed, why);
}

/// A range of abscissae.
struct Range {
  double from = 0, to = 0;
};

/// The range of a curve's reference, averaged over samples. Nothing if there is no reference.
std::optional<Range> reference_range(const StudyResult& result, const std::string& name) {
  const MetricDescription& metric = result.study.metrics.at(name);
  if (metric.curve) {
    const ReferencePoints curve = read_reference(*metric.curve);
    return Range{curve.x.front(), curve.x.back()};
  }
  if (result.study.is_sweep() || !all_done(result.finest())) return std::nullopt;
  const auto finest = metrics_of(result.finest(), name);
  Range mean;
  for (const Metric* one : finest) mean.from += one->x.front(), mean.to += one->x.back();
  const auto count = static_cast<double>(finest.size());
  return Range{mean.from / count, mean.to / count};
}

/// A metric that no run has, or that the finest lacks, is not evaluated. Any other run that lacks a metric has failed.
void find_lacks(StudyResult& result) {
  for (const auto& [name, metric] : result.study.metrics) {
    std::string why;
    bool had = false;
    for (const VariantResult& outcome : result.variants)
      for (const Sample& sample : outcome.samples) {
        had |= sample.metrics.contains(name);
        const auto lack = sample.lacks.find(name);
        if (lack == sample.lacks.end()) continue;
        if (result.is_finest(outcome)) result.unevaluated.emplace(name, of_the_finest(sample, lack->second));
        else if (why.empty()) why = lack->second;
      }
    if (!had && !why.empty()) result.unevaluated[name] = "missing in all runs: " + why;
  }
  for (VariantResult& outcome : result.variants)
    for (Sample& sample : outcome.samples)
      for (const auto& [name, why] : sample.lacks)
        if (!result.unevaluated.contains(name)) sample.status = "failed", sample.message = why;
}

/// The numbers of metrics in the units that the runs have.
void find_numbers(StudyResult& result) {
  for (auto& [name, metric] : result.study.metrics) {
    if (result.unevaluated.contains(name)) continue;
    const Metric* found = nullptr;
    for (const VariantResult& outcome : result.variants)
      for (const Sample& sample : outcome.samples)
        if (const auto own = sample.metrics.find(name); own != sample.metrics.end()) found = &own->second;
    if (found != nullptr)
      metric.find_numbers({{metric.channel(), found->unit}},
                          [&](std::string_view key, std::string_view value, std::string_view allowed) {
                            result.unevaluated[name] = fmt::format("its {} is {}; allowed is {}", key, value, allowed);
                          });
  }
}

/// A run whose curve ends well before its reference has failed, as it did not get far enough. If it is of the finest
/// settings, or if no run overlaps the reference, the metric is not evaluated.
void find_short_curves(StudyResult& result) {
  for (const auto& [name, metric] : result.study.metrics) {
    if (!metric.is_curve() || result.unevaluated.contains(name)) continue;
    if (!metric.curve && !result.study.is_sweep() && all_done(result.finest())) {
      const auto finest = metrics_of(result.finest(), name);
      if (!shared_abscissae(finest, finest)) {
        result.unevaluated[name] = "the samples of the finest settings share no range of the abscissa";
        continue;
      }
    }
    const auto range = reference_range(result, name);
    if (!range) continue;
    std::vector<std::pair<Sample*, std::string>> short_ones;
    bool shared = false;
    for (VariantResult& outcome : result.variants)
      for (Sample& sample : outcome.samples) {
        if (sample.status != "done") continue;
        const Metric& own = sample.metrics.at(name);
        const double reach = std::min(own.x.back(), range->to) - std::max(own.x.front(), range->from);
        shared |= reach >= 0;
        if (reach >= least_reach * (range->to - range->from)) continue;
        short_ones.emplace_back(
            &sample, fmt::format("{} has abscissae from {:g} to {:g}, its reference from {:g} to {:g}; if a stage ends "
                                 "by a condition, choose another abscissa or another condition",
                                 metric.of, own.x.front(), own.x.back(), range->from, range->to));
        if (result.is_finest(outcome))
          result.unevaluated.emplace(name, of_the_finest(sample, short_ones.back().second));
      }
    if (!shared && !short_ones.empty())
      result.unevaluated[name] = "no run overlaps the range of its reference; check the units";
    if (result.unevaluated.contains(name)) continue;
    for (const auto& [sample, why] : short_ones) sample->status = "failed", sample->message = why;
  }
}

/// Whether two samples have the same metrics and numbers of steps.
bool are_alike(const Sample& one, const Sample& other) {
  return one.steps == other.steps && std::ranges::equal(one.metrics, other.metrics, [](const auto& a, const auto& b) {
           return a.first == b.first && a.second.x == b.second.x && a.second.y == b.second.y;
         });
}

void find_alike(StudyResult& result) {
  bool compared = result.study.seeds.values.size() == 1;
  for (const VariantResult& outcome : result.variants) {
    const auto is_done = [](const Sample& sample) { return sample.status == "done"; };
    const auto first = std::ranges::find_if(outcome.samples, is_done);
    for (const Sample& sample : outcome.samples) {
      if (!is_done(sample) || &sample == &*first) continue;
      compared = true;
      if (!are_alike(*first, sample)) result.alike = false;
    }
  }
  if (!compared) result.alike = false;
}

/// Means over the finished samples.
void find_costs(VariantResult& outcome) {
  std::vector<double> costs;
  for (const Sample& sample : outcome.samples) {
    if (sample.status != "done") continue;
    costs.push_back(sample.core_seconds), outcome.steps += sample.steps;
    outcome.particle_steps_per_core_second += sample.particle_steps_per_core_second();
  }
  if (costs.empty()) return;
  const Sampled cost = sampled({costs});
  outcome.core_seconds = cost.mean.front(), outcome.cost_scatter = std::sqrt(cost.variance.front());
  outcome.steps /= static_cast<double>(costs.size());
  outcome.particle_steps_per_core_second /= static_cast<double>(costs.size());
}

/// The standard error of the ratio of two variants' mean costs, seed by seed.
double cost_ratio_error(const VariantResult& own, const VariantResult& other) {
  const double ratio = own.core_seconds / other.core_seconds;
  std::vector<double> residuals;
  for (std::size_t s = 0; s < own.samples.size(); ++s)
    residuals.push_back(own.samples[s].core_seconds - ratio * other.samples[s].core_seconds);
  return std::sqrt(sampled({residuals}).variance.front() / static_cast<double>(residuals.size())) / other.core_seconds;
}

void find_values(const StudyResult& result, VariantResult& outcome) {
  const bool sweep = result.study.is_sweep();
  if (!sweep && !all_done(outcome)) return;
  for (const auto& [name, metric] : result.study.metrics) {
    const bool lacked = std::ranges::any_of(outcome.samples, [&](const Sample& s) { return s.lacks.contains(name); });
    if (sweep ? result.unevaluated.contains(name) : lacked || metric.is_curve()) continue;
    std::vector<const Metric*> metrics;
    for (const Sample& sample : outcome.samples)
      if (sample.status == "done") metrics.push_back(&sample.metrics.at(name));
    if (metrics.empty()) continue;
    const auto x = shared_abscissae(metrics, metrics);
    if (!x) continue;
    const Sampled all = sampled(values_at(metrics, *x));
    if (!metric.is_curve()) {
      const double scatter = result.scatter(std::sqrt(all.variance.front()));
      outcome.values[name] = {all.mean.front(), scatter, metrics.front()->unit, metrics.size()};
      continue;
    }
    MeanCurve& curve =
        outcome.curves[name] = {*x, all.mean, {}, metrics.front()->unit, metrics.front()->x_unit, metrics.size()};
    for (const double variance : all.variance) curve.scatter.push_back(result.scatter(std::sqrt(variance)));
  }
}

/// The reference of each metric and the scale of its errors.
void find_references(StudyResult& result) {
  for (const auto& [name, metric] : result.study.metrics) {
    if (result.unevaluated.contains(name)) continue;
    Metric reference;
    if (metric.value) reference.y = {*metric.value};
    else if (result.study.is_sweep() && !metric.curve) continue;
    else if (metric.curve) {
      ReferencePoints curve = read_reference(*metric.curve);
      reference.x = std::move(curve.x), reference.y = std::move(curve.y);
    } else if (all_done(result.finest())) {
      const auto finest = metrics_of(result.finest(), name);
      const auto x = shared_abscissae(finest, finest).value();
      reference = {x, sampled(values_at(finest, x)).mean, finest.front()->unit, finest.front()->x_unit};
    } else {
      result.unevaluated[name] = "the finest settings have no result";
      continue;
    }
    double largest = 0;
    for (const double y : reference.y) largest = std::max(largest, std::abs(y));
    const double scale = metric.scale.value_or(largest);
    if (scale == 0) {
      result.unevaluated[name] = "its reference is 0, so that relative errors are undefined; give a scale";
      continue;
    }
    result.reference[name] = std::move(reference), result.scale[name] = scale;
  }
}

void find_deviations(StudyResult& result) {
  for (VariantResult& outcome : result.variants) {
    if (!all_done(outcome)) continue;
    for (const auto& [name, reference] : result.reference) {
      const auto& metric = result.study.metrics.at(name);
      const bool exact = metric.has_own_reference();
      const auto others = exact ? std::vector<const Metric*>{&reference} : metrics_of(result.finest(), name);
      Deviation& own = outcome.deviations[name] =
          deviation(result, metrics_of(outcome, name), others, result.scale.at(name));
      // The finest variant is the reference.
      if (!exact && result.is_finest(outcome)) own.error = 0, own.standard_error = 0;
    }
    for (const auto& [name, one] : outcome.deviations)
      if (outcome.worst.empty() || one.error > outcome.of_worst().error) outcome.worst = name;
  }
}

void find_effects(StudyResult& result) {
  std::vector<std::size_t> usual;
  for (const auto& [name, setting] : result.study.settings) usual.push_back(setting.usual_level());
  const auto with = [&](std::size_t k, std::size_t level) {
    auto levels = usual;
    levels[k] = level;
    return std::ranges::find_if(result.variants, [&](const auto& one) { return one.variant.levels == levels; });
  };
  std::size_t k = 0;
  for (const auto& [name, setting] : result.study.settings) {
    const auto finest = with(k, setting.finest_level());
    for (std::size_t level = 0; level < setting.finest_level(); ++level) {
      const auto own = with(k, level);
      if (!all_done(*own) || !all_done(*finest)) continue;
      Effect effect{
          name, setting.label(level), own->core_seconds / finest->core_seconds, cost_ratio_error(*own, *finest), {}};
      for (const auto& [metric, scale] : result.scale)
        effect.deviations[metric] = deviation(result, metrics_of(*own, metric), metrics_of(*finest, metric), scale);
      result.effects.push_back(std::move(effect));
    }
    ++k;
  }
}

void find_front(StudyResult& result) {
  for (VariantResult& one : result.variants) {
    if (!one.complete()) continue;
    one.on_front = std::ranges::none_of(result.variants, [&](const VariantResult& other) {
      return other.complete() && &other != &one && other.core_seconds <= one.core_seconds &&
             other.of_worst().error <= one.of_worst().error &&
             (other.core_seconds < one.core_seconds || other.of_worst().error < one.of_worst().error);
    });
  }
}

/// Whether a variant has no level that is coarser than the other's, and at least one that is finer.
bool is_finer(const Variant& one, const Variant& other) {
  return one.levels != other.levels && std::ranges::equal(one.levels, other.levels, std::greater_equal());
}

/// A variant is within the tolerance only if all finer ones are: an error that grows again at a finer setting was small
/// because errors cancelled.
void find_cheapest(StudyResult& result) {
  for (VariantResult& one : result.variants) {
    if (!one.complete()) continue;
    one.within = one.confidence(result.study.tolerance);
    for (const VariantResult& other : result.variants) {
      if (!other.complete() || !is_finer(other.variant, one.variant)) continue;
      if (const auto finer = other.confidence(result.study.tolerance); finer > one.within)
        one.within = finer, one.decided_by = other.variant.name;
    }
  }
  for (std::size_t i = 0; i < result.variants.size(); ++i) {
    const VariantResult& one = result.variants[i];
    if (!one.complete() || one.within > Confidence::likely) continue;
    if (!result.cheapest || one.core_seconds < result.variants[*result.cheapest].core_seconds) result.cheapest = i;
  }
}

Description or_null(double value) { return std::isfinite(value) ? Description(value) : Description(); }

Description to_json(const std::map<std::string, Deviation>& deviations) {
  Description json = Description::object();
  for (const auto& [name, one] : deviations)
    json[name] = {{"mean", or_null(one.mean)},
                  {"error", or_null(one.error)},
                  {"standard_error", or_null(one.standard_error)},
                  {"scatter", or_null(one.scatter)}};
  return json;
}

/// A table of variants × metrics: the name of the variant, the level of each setting, and the metric, then the cells of
/// `row(variant, metric's name, metric)`, or no row if these are empty.
template <class Row>
std::string rows_of_variants(const StudyResult& result, std::string_view columns, Row row) {
  std::string text = "variant";
  for (const auto& [name, setting] : result.study.settings) text += ',' + quoted_cell(name);
  text += fmt::format(",metric,{}\n", columns);
  for (const VariantResult& one : result.variants) {
    std::string head = quoted_cell(one.variant.name);
    std::size_t k = 0;
    for (const auto& [name, setting] : result.study.settings)
      head += ',' + quoted_cell(setting.label(one.variant.levels[k++]));
    for (const auto& [name, metric] : result.study.metrics)
      if (const std::string cells = row(one, name, metric); !cells.empty())
        text += fmt::format("{},{},{}\n", head, quoted_cell(name), cells);
  }
  return text;
}

/// Runs that are done, and all of them.
std::string counts_of_samples(const VariantResult& one) {
  return fmt::format("{},{}", std::ranges::count(one.samples, "done", &Sample::status), one.samples.size());
}

std::string sweep_csv(const StudyResult& result) {
  return rows_of_variants(
      result, "unit,mean,standard_error,standard_deviation,difference,core_seconds,steps,samples_done,samples",
      [](const VariantResult& one, const std::string& name, const MetricDescription& metric) -> std::string {
        if (metric.is_curve()) return "";
        const auto found = one.values.find(name);
        const Value value = found == one.values.end() ? Value{unknown, unknown, "", 1} : found->second;
        return fmt::format("{},{},{},{},{},{},{},{}", quoted_cell(value.unit), value.mean, value.standard_error(),
                           value.scatter, metric.value ? value.mean - *metric.value : unknown, one.core_seconds,
                           one.steps, counts_of_samples(one));
      });
}

}  // namespace

Sample read_sample(const std::map<std::string, MetricDescription>& metrics, double seed,
                   const std::filesystem::path& folder) {
  Sample sample;
  sample.seed = seed, sample.status = "missing";
  const auto run = read_run_json(folder);
  if (!run) return sample;
  const auto entry = [&](const char* key) { return run->value(key, Description()); };
  const auto text = [&](const char* key) { return entry(key).is_string() ? entry(key).get<std::string>() : ""; };
  const auto number = [&](const char* key) { return entry(key).is_number() ? entry(key).get<double>() : 0.0; };
  const std::string status = text("status");
  if (status == "done" || status == "failed") sample.status = status;
  else if (status == "running" || status == "interrupted") sample.status = "under way";
  sample.message = text("message");
  if (const auto revision = run->value(Description::json_pointer("/grit/revision"), Description());
      revision.is_string())
    sample.revision = revision.get<std::string>();
  sample.core_seconds = number("cpu_s"), sample.steps = number("steps"), sample.bodies = number("bodies");
  if (sample.status != "done") return sample;
  for (const auto& [name, metric] : metrics) try {
      sample.metrics[name] = take_metric(metric, folder);
    } catch (const NumericsError& error) {
      sample.lacks[name] = error.what();
    }
  return sample;
}

std::size_t StudyResult::count(const char* status) const {
  std::size_t all = 0;
  for (const VariantResult& one : variants)
    all += static_cast<std::size_t>(std::ranges::count(one.samples, status, &Sample::status));
  return all;
}

double StudyResult::scatter(double computed) const { return !alike ? computed : random ? unknown : 0; }

Confidence VariantResult::confidence(double tolerance) const {
  Confidence least = Confidence::certain;
  for (const auto& [name, one] : deviations)
    least = std::max(least, grit::confidence(one.error, one.standard_error, tolerance));
  return least;
}

StudyResult evaluate_study(StudyDescription study, const std::filesystem::path& folder,
                           const std::set<std::filesystem::path>& omitted) {
  StudyResult result;
  result.study = std::move(study);
  result.scenario = scenario_type(Document::load(result.study.scene));
  for (Variant& variant : variants(result.study)) {
    VariantResult& outcome = result.variants.emplace_back();
    outcome.variant = std::move(variant);
    for (const double seed : result.study.seeds.values) {
      const auto own = folder / folder_of(outcome.variant, seed);
      if (omitted.contains(own)) {
        outcome.samples.emplace_back().seed = seed, outcome.samples.back().status = "missing";
        continue;
      }
      const Sample& sample = outcome.samples.emplace_back(read_sample(result.study.metrics, seed, own));
      if (!sample.revision.empty()) result.revisions.insert(sample.revision);
      if (const auto run = result.parts.empty() ? read_run_json(own) : std::nullopt;
          run && run->contains("description"))
        result.parts = parts_of(run->at("description")), result.random = is_random(run->at("description"));
    }
  }
  find_lacks(result);
  find_numbers(result);
  find_short_curves(result);
  find_alike(result);
  for (VariantResult& outcome : result.variants) find_costs(outcome), find_values(result, outcome);
  find_references(result);
  find_deviations(result);
  if (result.study.is_sweep()) return result;
  find_effects(result);
  find_front(result);
  find_cheapest(result);
  return result;
}

Description to_json(const StudyResult& result) {
  Description json = {
      {"title", result.study.title},
      {"scene", std::filesystem::proximate(result.study.scene).string()},
      {"scenario", result.scenario},
      {"parts", result.parts},
      {"tolerance", result.study.tolerance},
      {"purpose", result.study.purpose},
      {"samples", result.study.seeds.values.size()},
      {"of_samples", of_samples(result)},
      {"revisions", result.revisions},
      {"settings", Description::object()},
      {"metrics", Description::object()},
      {"variants", Description::array()},
      {"effects", Description::array()},
      {"cheapest", result.cheapest ? Description(result.variants[*result.cheapest].variant.name) : Description()}};
  for (const auto& [name, setting] : result.study.settings) {
    Description levels = Description::array();
    for (std::size_t level = 0; level < setting.levels(); ++level)
      levels.push_back({{"label", setting.label(level)}, {"sets", setting.sets(level)}});
    json["settings"][name] = {
        {"doc", setting.doc}, {"usual", setting.label(setting.usual_level())}, {"levels", levels}};
  }
  for (const auto& [name, metric] : result.study.metrics)
    json["metrics"][name] = {
        {"type", metric.what.type()},
        {"of", metric.of},
        {"reference", metric.curve                 ? "curve"
                      : metric.has_own_reference() ? "value"
                      : result.study.is_sweep()    ? "none"
                                                   : "finest"},
        {"scale", result.scale.contains(name) ? Description(result.scale.at(name)) : Description()},
        {"not_charted", result.unevaluated.contains(name) ? Description(result.unevaluated.at(name)) : Description()}};
  for (const VariantResult& one : result.variants) {
    Description levels = Description::object(), values = Description::object(), samples = Description::array();
    std::size_t k = 0;
    for (const auto& [name, setting] : result.study.settings) levels[name] = setting.label(one.variant.levels[k++]);
    for (const auto& [name, value] : one.values)
      values[name] = {{"mean", value.mean},
                      {"scatter", or_null(value.scatter)},
                      {"standard_error", or_null(value.standard_error())},
                      {"unit", value.unit}};
    for (const Sample& sample : one.samples)
      samples.push_back({{"seed", sample.seed},
                         {"folder", folder_of(one.variant, sample.seed).string()},
                         {"status", sample.status},
                         {"message", sample.message},
                         {"core_seconds", sample.core_seconds},
                         {"steps", sample.steps},
                         {"bodies", sample.bodies},
                         {"particle_steps_per_core_s", sample.particle_steps_per_core_second()}});
    json["variants"].push_back({{"name", one.variant.name},
                                {"levels", levels},
                                {"core_seconds", one.core_seconds},
                                {"core_seconds_scatter", or_null(one.cost_scatter)},
                                {"steps", one.steps},
                                {"particle_steps_per_core_s", one.particle_steps_per_core_second},
                                {"worst_metric", one.worst},
                                {"on_front", one.on_front},
                                {"within_tolerance", one.complete() ? Description(word_of(one.within)) : Description()},
                                {"decided_by", one.decided_by},
                                {"values", values},
                                {"metrics", to_json(one.deviations)},
                                {"samples", samples}});
  }
  for (const Effect& effect : result.effects)
    json["effects"].push_back({{"setting", effect.setting},
                               {"level", effect.level},
                               {"cost", effect.cost},
                               {"cost_standard_error", or_null(effect.cost_error)},
                               {"metrics", to_json(effect.deviations)}});
  return json;
}

std::string to_csv(const StudyResult& result) {
  if (result.study.is_sweep()) return sweep_csv(result);
  return rows_of_variants(
      result,
      "mean,error,standard_error,scatter,core_seconds,core_seconds_scatter,steps,particle_steps_per_core_s,"
      "samples_done,samples",
      [](const VariantResult& one, const std::string& name, const MetricDescription&) {
        const auto found = one.deviations.find(name);
        Deviation metrics = found == one.deviations.end() ? Deviation() : found->second;
        if (const auto value = one.values.find(name); value != one.values.end()) metrics.mean = value->second.mean;
        return fmt::format("{},{},{},{},{},{},{},{},{}", metrics.mean, metrics.error, metrics.standard_error,
                           metrics.scatter, one.core_seconds, one.cost_scatter, one.steps,
                           one.particle_steps_per_core_second, counts_of_samples(one));
      });
}

}  // namespace grit
