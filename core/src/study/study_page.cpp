#include "study/study_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/page.hpp"
#include "output/svg.hpp"
#include "study/error_chart.hpp"
#include "study/study_sentences.hpp"
#include "study/sweep_page.hpp"

namespace grit {
namespace {

/// Two digits; "?" if unknown.
std::string or_unknown(double value) { return std::isfinite(value) ? fmt::format("{:.2g}", value) : "?"; }

/// The cost that others are compared with: of the finest settings, or the largest.
double cost_to_compare(const StudyResult& result) {
  if (result.study.compares_with_finest()) return result.finest().core_seconds;
  return std::ranges::max(result.variants, {}, &VariantResult::core_seconds).core_seconds;
}

std::string variants_table(const StudyResult& result) {
  std::string html = fmt::format(
      "<div class=\"wide\"><table><thead><tr><th>#</th><th class=\"name\">changed settings</th><th>core-seconds</th>"
      "<th>cheaper than the {}</th><th>steps</th><th>M particle-steps per core-second</th>",
      result.study.compares_with_finest() ? "finest" : "most expensive");
  for (const auto& [name, reference] : result.reference)
    html += "<th>" + escaped(deviation_title(result.study, name)) + "</th>";
  html += "</tr></thead><tbody>\n";
  std::vector<std::size_t> order(result.variants.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return result.variants[i].core_seconds; });
  for (const std::size_t i : order) {
    const VariantResult& one = result.variants[i];
    const std::string finer = finer_that_is_not(result, one);
    html += fmt::format(
        "<tr{}><td><span class=\"dot\" style=\"background:{}\">{}</span></td><td class=\"name\">{}{}{}</td>",
        result.cheapest == i ? " class=\"best\"" : "", colour_of(result, one), i + 1, escaped(one.variant.name),
        one.on_front ? " <b title=\"no other variant is both cheaper and more accurate\">◂</b>" : "",
        finer.empty() ? "" : "<br><small>not within the tolerance: " + escaped(finer) + "</small>");
    html +=
        one.core_seconds > 0
            ? fmt::format(
                  "<td>{:.3g} <small>± {}</small></td><td>{}</td><td>{:.0f}</td><td>{:.2f}</td>", one.core_seconds,
                  or_unknown(one.cost_scatter),
                  cost_to_compare(result) > 0 ? ratio_text(cost_to_compare(result) / one.core_seconds) + " times" : "?",
                  one.steps, 1e-6 * one.particle_steps_per_core_second)
            : "<td>–</td><td>–</td><td>–</td><td>–</td>";
    for (const auto& [name, reference] : result.reference) {
      const auto found = one.deviations.find(name);
      if (found == one.deviations.end()) {
        html += "<td>not finished</td>";
      } else if (&one == &result.finest() && found->second.error == 0) {
        html += "<td>reference</td>";
      } else {
        html += fmt::format("<td{}>{} <small>± {}</small></td>",
                            found->second.error > result.study.tolerance ? " class=\"over\"" : "",
                            percent(found->second.error), percent(found->second.standard_error));
      }
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// Values of metrics with one value, each in its most readable unit.
std::string values_part(const StudyResult& result) {
  std::map<std::string, std::pair<std::string, double>> metrics;  // by name: the unit and the largest magnitude
  for (const VariantResult& one : result.variants)
    for (const auto& [name, value] : one.values) {
      auto& [unit, largest] = metrics[name];
      unit = value.unit, largest = std::max(largest, std::abs(value.mean));
    }
  if (metrics.empty()) return "";
  std::string html =
      "<h2>Values of the metrics</h2>\n<p>Mean ± standard deviation of the samples.</p>\n"
      "<div class=\"wide\"><table><thead><tr><th>#</th><th class=\"name\">changed settings</th>";
  for (const auto& [name, metric] : metrics)
    html += "<th>" + escaped(axis_title(name, readable(metric.first, metric.second).unit)) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < result.variants.size(); ++i) {
    const VariantResult& one = result.variants[i];
    html += fmt::format("<tr><td>{}</td><td class=\"name\">{}</td>", i + 1, escaped(one.variant.name));
    for (const auto& [name, metric] : metrics) {
      const auto value = one.values.find(name);
      const double factor = readable(metric.first, metric.second).factor;
      html += value == one.values.end()
                  ? "<td>–</td>"
                  : fmt::format("<td>{:.3g} <small>± {}</small></td>", factor * value->second.mean,
                                or_unknown(factor * value->second.scatter));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// Cost and changes of each level of a setting, as bars.
std::string effects_part(const StudyResult& result) {
  if (result.effects.empty() || !result.study.compares_with_finest()) return "";
  std::string html =
      "<h2>Effect of each setting</h2>\n<p>Each level is compared with the finest of the same setting, all others at "
      "their usual levels.</p>\n"
      "<div class=\"wide\"><table><thead><tr><th class=\"name\">setting</th><th class=\"name\">level</th><th>cost "
      "relative to the finest</th>";
  for (const auto& [name, reference] : result.reference) html += "<th>changes " + escaped(name) + " by</th>";
  html += "</tr></thead><tbody>\n";
  double largest = result.study.tolerance;
  for (const Effect& effect : result.effects)
    for (const auto& [name, one] : effect.deviations) largest = std::max(largest, one.error);
  for (const Effect& effect : result.effects) {
    const auto& setting = result.study.settings.at(effect.setting);
    html += fmt::format(
        "<tr><td class=\"name\">{}{}</td><td class=\"name\">{} <small>(finest {})</small></td><td>{} <small>± "
        "{}</small></td>",
        escaped(effect.setting), setting.doc.empty() ? "" : "<br><small>" + escaped(setting.doc) + "</small>",
        escaped(effect.level), escaped(setting.label(setting.finest_level())), ratio_text(effect.cost),
        or_unknown(effect.cost_error));
    for (const auto& [name, reference] : result.reference) {
      const auto found = effect.deviations.find(name);
      if (found == effect.deviations.end()) {
        html += "<td>?</td>";
        continue;
      }
      const Deviation& one = found->second;
      html += fmt::format("<td class=\"bar{}\" style=\"--share:{:.1f}%\">{} <small>± {}</small></td>",
                          one.error > result.study.tolerance ? " over" : "", 100 * one.error / largest,
                          percent(one.error), percent(one.standard_error));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string unevaluated_part(const StudyResult& result) {
  std::string html;
  for (const std::string& line : not_evaluated(result)) html += "<li>" + escaped(line) + "</li>\n";
  return html.empty() ? "" : "<h2>Metrics that could not be evaluated</h2>\n<ul>\n" + html + "</ul>\n";
}

std::string failures_part(const StudyResult& result) {
  std::string html;
  for (std::size_t i = 0; i < result.variants.size(); ++i)
    for (const Sample& sample : result.variants[i].samples)
      if (sample.status != "done")
        html += fmt::format("<li><b>{} {}</b>, seed {:.0f}: {}</li>\n", i + 1, escaped(result.variants[i].variant.name),
                            sample.seed, sample.status == "failed" ? escaped(sample.message) : sample.status);
  return html.empty() ? "" : "<h2>Failed and unfinished runs</h2>\n<ul>\n" + html + "</ul>\n";
}

constexpr const char* sheet = R"(
.verdict{font-size:17px;border-left:4px solid #0072b2;padding:2px 14px;margin:18px 0}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,480px),1fr));gap:18px}
svg{width:100%;height:auto}.first svg{max-width:900px}
text{font-family:inherit;font-size:12px;fill:var(--ink)}
.axis{font-size:13px;font-weight:600}.small{font-size:11px;fill:var(--soft)}.m{text-anchor:middle}.e{text-anchor:end}
.grid{stroke:var(--line)}.frame{stroke:var(--frame)}.floor{fill:var(--band)}
.wish{stroke:var(--over);stroke-dasharray:5 4}.front{fill:none;stroke:var(--frame);stroke-width:2}
.number{font-size:11px;font-weight:600;fill:#fff}.spread{stroke-width:1.5}.failed{fill:var(--over);font-weight:600}
tr.best{background:var(--band)}.over{color:var(--over)}
.dot{display:inline-block;min-width:22px;padding:0 4px;border-radius:11px;color:#fff;text-align:center;font-weight:600}
.bar{background:linear-gradient(to left,var(--bar) var(--share),transparent 0)}
)";

}  // namespace

std::string study_page(const StudyResult& result) {
  if (result.study.is_sweep()) return sweep_page(result);
  const std::string title = result.study.title.empty() ? "speed against accuracy" : result.study.title;
  std::string html = page_begin(title, sheet) + "<h1>" + escaped(title) + "</h1>\n";
  const bool with_finest = result.study.compares_with_finest();
  html += fmt::format(
      "<p>{}, {} samples per variant; {} ± standard error, core-seconds ± standard deviation, both from the scatter "
      "between samples. Run by grit {}.</p>\n",
      escaped(std::filesystem::proximate(result.study.scene).string()), result.study.seeds.values.size(),
      with_finest ? "errors" : "differences from the references",
      escaped(fmt::format("{}", fmt::join(result.revisions, ", "))));
  html += "<p class=\"verdict\">" + escaped(verdict(result)) + "</p>\n";
  if (!result.reference.empty()) {
    html += "<div class=\"first\">" + error_chart(result, "") + "</div>\n";
    html += fmt::format(
        "<p><small>Lower is {}, further left is cheaper; no variant is better in both than those on the stepped line. "
        "In the shaded area differences are within the scatter between samples. {}</small></p>\n",
        with_finest ? "more accurate" : "closer to the references",
        with_finest ? "The finest variant lies on the axis. A variant is within the tolerance only if all finer ones "
                      "are: an error that grows again at a finer setting was small because errors cancelled."
                    : "A variant is within the tolerance only if those with settings further down their lists are, "
                      "too.");
  }
  html += "<h2>Variants</h2>\n" + variants_table(result) + values_part(result) + effects_part(result) +
          unevaluated_part(result) + failures_part(result);
  if (result.reference.size() > 1) {
    html += "<h2>Each metric</h2>\n<div class=\"charts\">\n";
    for (const auto& [name, reference] : result.reference) html += "<div>" + error_chart(result, name) + "</div>\n";
    html += "</div>\n";
  }
  html += page_end;
  return html;
}

}  // namespace grit
