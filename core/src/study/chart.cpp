#include "study/chart.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "format/csv.hpp"
#include "grit/error.hpp"
#include "input/scene.hpp"
#include "output/read_results.hpp"
#include "output/reference_curve.hpp"
#include "study/chart_words.hpp"
#include "study/parts.hpp"

namespace grit {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
/// Places at which curves are compared.
constexpr std::size_t places = 200;
/// Of its reference's abscissae, that a curve has to have.
constexpr double least_reach = 0.9;

Sample read_sample(const StudyDescription& study, double seed, const std::filesystem::path& folder) {
  Sample sample;
  sample.seed = seed, sample.status = "missing";
  const auto run = read_run_json(folder);
  if (!run) return sample;
  const auto entry = [&](const char* key) { return run->value(key, Description()); };
  const auto text = [&](const char* key) { return entry(key).is_string() ? entry(key).get<std::string>() : ""; };
  const auto number = [&](const char* key) { return entry(key).is_number() ? entry(key).get<double>() : 0.0; };
  if (const auto status = text("status"); status == "done" || status == "failed") sample.status = status;
  sample.message = text("message");
  if (const auto revision = run->value(Description::json_pointer("/grit/revision"), Description());
      revision.is_string())
    sample.revision = revision.get<std::string>();
  sample.core_seconds = number("cpu_s"), sample.steps = number("steps"), sample.bodies = number("bodies");
  if (sample.status != "done") return sample;
  for (const auto& [name, figure] : study.figures) try {
      sample.figures[name] = take_figure(figure, folder);
    } catch (const NumericsError& error) {
      sample.lacks[name] = error.what();
    }
  return sample;
}

bool all_done(const VariantResult& result) {
  return std::ranges::all_of(result.samples, [](const Sample& sample) { return sample.status == "done"; });
}

/// Samples of a figure at the places where it is compared: one for a value.
struct Sampled {
  std::vector<double> mean, variance;  ///< variance NaN of one sample
};

/// By place, then by sample; a value has one place.
std::vector<std::vector<double>> values_at(const std::vector<const Figure*>& figures, const std::vector<double>& x) {
  std::vector<std::vector<double>> values(figures.front()->x.empty() ? 1 : x.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    for (const Figure* figure : figures) values[k].push_back(figure->x.empty() ? figure->y.front() : at(*figure, x[k]));
  return values;
}

Sampled sampled(const std::vector<std::vector<double>>& by_place) {
  Sampled result;
  for (const auto& values : by_place) {
    const auto count = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double value : values) sum += value;
    for (const double value : values) squares += (value - sum / count) * (value - sum / count);
    result.mean.push_back(sum / count);
    result.variance.push_back(count > 1 ? squares / (count - 1) : unknown);
  }
  return result;
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

std::vector<const Figure*> figures_of(const VariantResult& result, const std::string& name) {
  std::vector<const Figure*> all;
  for (const Sample& sample : result.samples) all.push_back(&sample.figures.at(name));
  return all;
}

/// Where both can be compared: what all curves have; no place for values. Nothing if curves share none.
std::optional<std::vector<double>> shared_places(const std::vector<const Figure*>& a,
                                                 const std::vector<const Figure*>& b) {
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (const auto* figures : {&a, &b})
    for (const Figure* figure : *figures) {
      if (figure->x.empty()) return std::vector<double>();
      low = std::max(low, figure->x.front()), high = std::min(high, figure->x.back());
    }
  if (!(low <= high)) return std::nullopt;
  std::vector<double> x(places);
  for (std::size_t k = 0; k < places; ++k)
    x[k] = std::clamp(low + (high - low) * static_cast<double>(k) / (places - 1), low, high);
  return x;
}

/// Sample by sample, so that what samples of one seed have in common is not taken for scatter of the difference. A
/// reference from elsewhere is one for all samples.
Deviation deviation(const Chart& chart, const std::vector<const Figure*>& from,
                    const std::vector<const Figure*>& reference, double scale) {
  const auto x = shared_places(from, reference).value();
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
              chart.scatter(std::sqrt(mean_of(difference.variance) / static_cast<double>(from.size())) / scale),
          .scatter = chart.scatter(std::sqrt(mean_of(own.variance)) / scale)};
}

std::string of_the_finest(const Sample& sample, const std::string& why) {
  return fmt::format("of the finest settings, seed {:.0f}: {}", sample.seed, why);
}

/// Abscissae from one to another.
struct Range {
  double from = 0, to = 0;
};

/// Where the reference of a curve is; of several samples on average. Nothing if there is none.
std::optional<Range> reference_range(const Chart& chart, const std::string& name) {
  const FigureDescription& figure = chart.study.figures.at(name);
  if (figure.curve) {
    const ReferencePoints curve = read_reference(*figure.curve);
    return Range{curve.x.front(), curve.x.back()};
  }
  if (!all_done(chart.finest())) return std::nullopt;
  const auto finest = figures_of(chart.finest(), name);
  Range mean;
  for (const Figure* one : finest) mean.from += one->x.front(), mean.to += one->x.back();
  const auto count = static_cast<double>(finest.size());
  return Range{mean.from / count, mean.to / count};
}

/// A figure that no run has, or that the finest lacks, is not charted; any other run that lacks one has failed.
void find_lacks(Chart& chart) {
  for (const auto& [name, figure] : chart.study.figures) {
    std::string why;
    bool had = false;
    for (const VariantResult& result : chart.variants)
      for (const Sample& sample : result.samples) {
        had |= sample.figures.contains(name);
        const auto lack = sample.lacks.find(name);
        if (lack == sample.lacks.end()) continue;
        if (&result == &chart.finest()) chart.uncharted.emplace(name, of_the_finest(sample, lack->second));
        else if (why.empty()) why = lack->second;
      }
    if (!had && !why.empty()) chart.uncharted[name] = "in no run: " + why;
  }
  for (VariantResult& result : chart.variants)
    for (Sample& sample : result.samples)
      for (const auto& [name, why] : sample.lacks)
        if (!chart.uncharted.contains(name)) sample.status = "failed", sample.message = why;
}

/// A curve that ends before its reference does is compared where that is easy only: such a run did not get far enough.
/// If it is of the finest, or if no run shares an abscissa with the reference, the figure is not charted.
void find_short_curves(Chart& chart) {
  for (const auto& [name, figure] : chart.study.figures) {
    if (!figure.is_curve() || chart.uncharted.contains(name)) continue;
    if (!figure.curve && all_done(chart.finest())) {
      const auto finest = figures_of(chart.finest(), name);
      if (!shared_places(finest, finest)) {
        chart.uncharted[name] = "samples of the finest settings have no abscissa in common";
        continue;
      }
    }
    const auto range = reference_range(chart, name);
    if (!range) continue;
    std::vector<std::pair<Sample*, std::string>> short_ones;
    bool shared = false;
    for (VariantResult& result : chart.variants)
      for (Sample& sample : result.samples) {
        if (sample.status != "done") continue;
        const Figure& own = sample.figures.at(name);
        const double reach = std::min(own.x.back(), range->to) - std::max(own.x.front(), range->from);
        shared |= reach >= 0;
        if (reach >= least_reach * (range->to - range->from)) continue;
        short_ones.emplace_back(
            &sample, fmt::format("{} is of abscissae from {:g} to {:g}, its reference from {:g} to {:g}; where a stage "
                                 "ends by a condition, take another abscissa or another end",
                                 figure.of, own.x.front(), own.x.back(), range->from, range->to));
        if (&result == &chart.finest()) chart.uncharted.emplace(name, of_the_finest(sample, short_ones.back().second));
      }
    if (!shared && !short_ones.empty())
      chart.uncharted[name] = "no run has an abscissa in common with its reference; mind the units";
    if (chart.uncharted.contains(name)) continue;
    for (const auto& [sample, why] : short_ones) sample->status = "failed", sample->message = why;
  }
}

/// Whether two samples came to the same in all figures, in as many steps.
bool are_alike(const Sample& one, const Sample& other) {
  return one.steps == other.steps && std::ranges::equal(one.figures, other.figures, [](const auto& a, const auto& b) {
           return a.first == b.first && a.second.x == b.second.x && a.second.y == b.second.y;
         });
}

void find_alike(Chart& chart) {
  bool compared = chart.study.seeds.values.size() == 1;
  for (const VariantResult& result : chart.variants) {
    const auto is_done = [](const Sample& sample) { return sample.status == "done"; };
    const auto first = std::ranges::find_if(result.samples, is_done);
    for (const Sample& sample : result.samples) {
      if (!is_done(sample) || &sample == &*first) continue;
      compared = true;
      if (!are_alike(*first, sample)) chart.alike = false;
    }
  }
  if (!compared) chart.alike = false;
}

/// Means over the samples that are done.
void find_costs(VariantResult& result) {
  std::vector<double> costs;
  for (const Sample& sample : result.samples) {
    if (sample.status != "done") continue;
    costs.push_back(sample.core_seconds), result.steps += sample.steps;
    result.particle_steps_per_core_second += sample.particle_steps_per_core_second();
  }
  if (costs.empty()) return;
  const Sampled cost = sampled({costs});
  result.core_seconds = cost.mean.front(), result.cost_scatter = std::sqrt(cost.variance.front());
  result.steps /= static_cast<double>(costs.size());
  result.particle_steps_per_core_second /= static_cast<double>(costs.size());
}

/// The standard error of the ratio of two variants' mean costs, seed by seed.
double cost_ratio_error(const VariantResult& own, const VariantResult& other) {
  const double ratio = own.core_seconds / other.core_seconds;
  std::vector<double> residuals;
  for (std::size_t s = 0; s < own.samples.size(); ++s)
    residuals.push_back(own.samples[s].core_seconds - ratio * other.samples[s].core_seconds);
  return std::sqrt(sampled({residuals}).variance.front() / static_cast<double>(residuals.size())) / other.core_seconds;
}

void find_values(const Chart& chart, VariantResult& result) {
  if (!all_done(result)) return;
  for (const auto& [name, figure] : chart.study.figures) {
    if (figure.is_curve() ||
        std::ranges::any_of(result.samples, [&](const Sample& s) { return s.lacks.contains(name); }))
      continue;
    const auto figures = figures_of(result, name);
    const Sampled values = sampled(values_at(figures, {}));
    const double scatter = chart.scatter(std::sqrt(values.variance.front()));
    result.values[name] = {values.mean.front(), scatter, figures.front()->unit};
  }
}

/// The reference of each figure, and what its errors are divided by.
void find_references(Chart& chart) {
  for (const auto& [name, figure] : chart.study.figures) {
    if (chart.uncharted.contains(name)) continue;
    Figure reference;
    if (figure.value) reference.y = {*figure.value};
    else if (figure.curve) {
      ReferencePoints curve = read_reference(*figure.curve);
      reference.x = std::move(curve.x), reference.y = std::move(curve.y);
    } else if (all_done(chart.finest())) {
      const auto finest = figures_of(chart.finest(), name);
      const auto x = shared_places(finest, finest).value();
      reference = {x, sampled(values_at(finest, x)).mean, finest.front()->unit, finest.front()->x_unit};
    } else {
      chart.uncharted[name] = "the finest settings have no result";
      continue;
    }
    double largest = 0;
    for (const double y : reference.y) largest = std::max(largest, std::abs(y));
    const double scale = figure.scale.value_or(largest);
    if (scale == 0) {
      chart.uncharted[name] = "its reference is 0, to which no error can be put in relation; give a scale";
      continue;
    }
    chart.reference[name] = std::move(reference), chart.scale[name] = scale;
  }
}

void find_deviations(Chart& chart) {
  for (VariantResult& result : chart.variants) {
    if (!all_done(result)) continue;
    for (const auto& [name, reference] : chart.reference) {
      const auto& figure = chart.study.figures.at(name);
      const bool exact = figure.value || figure.curve;
      const auto others = exact ? std::vector<const Figure*>{&reference} : figures_of(chart.finest(), name);
      Deviation& own = result.deviations[name] =
          deviation(chart, figures_of(result, name), others, chart.scale.at(name));
      // The finest is the reference, and no further from it than its samples scatter.
      if (!exact && &result == &chart.finest()) own.error = 0, own.standard_error = 0;
    }
    for (const auto& [name, one] : result.deviations)
      if (result.worst.empty() || one.error > result.of_worst().error) result.worst = name;
  }
}

void find_effects(Chart& chart) {
  std::vector<std::size_t> usual;
  for (const auto& [name, setting] : chart.study.settings) usual.push_back(setting.usual_level());
  const auto with = [&](std::size_t k, std::size_t level) {
    auto levels = usual;
    levels[k] = level;
    return std::ranges::find_if(chart.variants, [&](const auto& one) { return one.variant.levels == levels; });
  };
  std::size_t k = 0;
  for (const auto& [name, setting] : chart.study.settings) {
    const auto finest = with(k, setting.finest_level());
    for (std::size_t level = 0; level < setting.finest_level(); ++level) {
      const auto own = with(k, level);
      if (!all_done(*own) || !all_done(*finest)) continue;
      Effect effect{
          name, setting.label(level), own->core_seconds / finest->core_seconds, cost_ratio_error(*own, *finest), {}};
      for (const auto& [figure, scale] : chart.scale)
        effect.deviations[figure] = deviation(chart, figures_of(*own, figure), figures_of(*finest, figure), scale);
      chart.effects.push_back(std::move(effect));
    }
    ++k;
  }
}

void find_front(Chart& chart) {
  for (VariantResult& one : chart.variants) {
    if (!one.complete()) continue;
    one.on_front = std::ranges::none_of(chart.variants, [&](const VariantResult& other) {
      return other.complete() && &other != &one && other.core_seconds <= one.core_seconds &&
             other.of_worst().error <= one.of_worst().error &&
             (other.core_seconds < one.core_seconds || other.of_worst().error < one.of_worst().error);
    });
  }
}

/// Whether a variant has no level that is cheaper than the other's, and some that are finer.
bool is_finer(const Variant& one, const Variant& other) {
  return one.levels != other.levels && std::ranges::equal(one.levels, other.levels, std::greater_equal());
}

/// An error that grows again where a setting is made finer was small because others cancelled it.
void find_cheapest(Chart& chart) {
  for (VariantResult& one : chart.variants) {
    if (!one.complete()) continue;
    one.within = one.confidence(chart.study.tolerance);
    for (const VariantResult& other : chart.variants) {
      if (!other.complete() || !is_finer(other.variant, one.variant)) continue;
      if (const auto finer = other.confidence(chart.study.tolerance); finer > one.within)
        one.within = finer, one.decided_by = other.variant.name;
    }
  }
  for (std::size_t i = 0; i < chart.variants.size(); ++i) {
    const VariantResult& one = chart.variants[i];
    if (!one.complete() || one.within > Confidence::likely) continue;
    if (!chart.cheapest || one.core_seconds < chart.variants[*chart.cheapest].core_seconds) chart.cheapest = i;
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

}  // namespace

double Chart::scatter(double computed) const { return !alike ? computed : random ? unknown : 0; }

Confidence VariantResult::confidence(double tolerance) const {
  Confidence worst = Confidence::certain;
  for (const auto& [name, one] : deviations)
    worst = std::max(worst, grit::confidence(one.error, one.standard_error, tolerance));
  return worst;
}

Chart make_chart(StudyDescription study, const std::filesystem::path& folder) {
  Chart chart;
  chart.study = std::move(study);
  chart.scenario = scenario_type(Document::load(chart.study.scene));
  for (Variant& variant : variants(chart.study)) {
    VariantResult& result = chart.variants.emplace_back();
    result.variant = std::move(variant);
    for (const double seed : chart.study.seeds.values) {
      const auto own = folder / folder_of(result.variant, seed);
      const Sample& sample = result.samples.emplace_back(read_sample(chart.study, seed, own));
      if (!sample.revision.empty()) chart.revisions.insert(sample.revision);
      if (const auto run = chart.parts.empty() ? read_run_json(own) : std::nullopt; run && run->contains("description"))
        chart.parts = parts_of(run->at("description")), chart.random = is_random(run->at("description"));
    }
  }
  find_lacks(chart);
  find_short_curves(chart);
  find_alike(chart);
  for (VariantResult& result : chart.variants) find_costs(result), find_values(chart, result);
  find_references(chart);
  find_deviations(chart);
  find_effects(chart);
  find_front(chart);
  find_cheapest(chart);
  return chart;
}

Description to_json(const Chart& chart) {
  Description json = {
      {"title", chart.study.title},
      {"scene", std::filesystem::proximate(chart.study.scene).string()},
      {"scenario", chart.scenario},
      {"parts", chart.parts},
      {"tolerance", chart.study.tolerance},
      {"advice", chart.study.advice},
      {"samples", chart.study.seeds.values.size()},
      {"of_samples", of_samples(chart)},
      {"revisions", chart.revisions},
      {"settings", Description::object()},
      {"figures", Description::object()},
      {"variants", Description::array()},
      {"effects", Description::array()},
      {"cheapest", chart.cheapest ? Description(chart.variants[*chart.cheapest].variant.name) : Description()}};
  for (const auto& [name, setting] : chart.study.settings) {
    Description levels = Description::array();
    for (std::size_t level = 0; level < setting.levels(); ++level)
      levels.push_back({{"label", setting.label(level)}, {"sets", setting.sets(level)}});
    json["settings"][name] = {
        {"about", setting.about}, {"usual", setting.label(setting.usual_level())}, {"levels", levels}};
  }
  for (const auto& [name, figure] : chart.study.figures)
    json["figures"][name] = {
        {"type", figure.what.type()},
        {"of", figure.of},
        {"reference", figure.value   ? "value"
                      : figure.curve ? "curve"
                                     : "finest"},
        {"scale", chart.scale.contains(name) ? Description(chart.scale.at(name)) : Description()},
        {"not_charted", chart.uncharted.contains(name) ? Description(chart.uncharted.at(name)) : Description()}};
  for (const VariantResult& one : chart.variants) {
    Description levels = Description::object(), values = Description::object(), samples = Description::array();
    std::size_t k = 0;
    for (const auto& [name, setting] : chart.study.settings) levels[name] = setting.label(one.variant.levels[k++]);
    for (const auto& [name, value] : one.values)
      values[name] = {{"mean", value.mean}, {"scatter", or_null(value.scatter)}, {"unit", value.unit}};
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
                                {"worst_figure", one.worst},
                                {"on_front", one.on_front},
                                {"within_tolerance", one.complete() ? Description(word_of(one.within)) : Description()},
                                {"decided_by", one.decided_by},
                                {"values", values},
                                {"figures", to_json(one.deviations)},
                                {"samples", samples}});
  }
  for (const Effect& effect : chart.effects)
    json["effects"].push_back({{"setting", effect.setting},
                               {"level", effect.level},
                               {"cost", effect.cost},
                               {"cost_standard_error", or_null(effect.cost_error)},
                               {"figures", to_json(effect.deviations)}});
  return json;
}

std::string to_csv(const Chart& chart) {
  std::string text = "variant";
  for (const auto& [name, setting] : chart.study.settings) text += ',' + quoted_cell(name);
  text +=
      ",figure,mean,error,standard_error,scatter,core_seconds,core_seconds_scatter,steps,particle_steps_per_core_s,"
      "samples_"
      "done,samples\n";
  for (const VariantResult& one : chart.variants) {
    std::string head = quoted_cell(one.variant.name);
    std::size_t k = 0;
    for (const auto& [name, setting] : chart.study.settings)
      head += ',' + quoted_cell(setting.label(one.variant.levels[k++]));
    const auto done = std::ranges::count(one.samples, "done", &Sample::status);
    for (const auto& [name, figure] : chart.study.figures) {
      const auto found = one.deviations.find(name);
      Deviation figures = found == one.deviations.end() ? Deviation() : found->second;
      if (const auto value = one.values.find(name); value != one.values.end()) figures.mean = value->second.mean;
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", head, quoted_cell(name), figures.mean, figures.error,
                          figures.standard_error, figures.scatter, one.core_seconds, one.cost_scatter, one.steps,
                          one.particle_steps_per_core_second, done, one.samples.size());
    }
  }
  return text;
}

}  // namespace grit
