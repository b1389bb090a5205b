#include "study/chart_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/page.hpp"
#include "output/svg.hpp"
#include "study/chart_words.hpp"
#include "study/error_chart.hpp"

namespace grit {
namespace {

/// Two digits; "?" where it cannot be told.
std::string or_unknown(double value) { return std::isfinite(value) ? fmt::format("{:.2g}", value) : "?"; }

std::string variants_table(const Chart& chart) {
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th>#</th><th class=\"name\">settings that differ from the "
      "usual</th><th>core-seconds</th>"
      "<th>cheaper than the finest</th><th>steps</th><th>M particle-steps a core-second</th>";
  for (const auto& [name, reference] : chart.reference)
    html += "<th>" + word_for_error(chart.study) + " of " + escaped(name) + "</th>";
  html += "</tr></thead><tbody>\n";
  std::vector<std::size_t> order(chart.variants.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return chart.variants[i].core_seconds; });
  for (const std::size_t i : order) {
    const VariantResult& one = chart.variants[i];
    const std::string finer = finer_that_is_not(chart, one);
    html += fmt::format(
        "<tr{}><td><span class=\"dot\" style=\"background:{}\">{}</span></td><td class=\"name\">{}{}{}</td>",
        chart.cheapest == i ? " class=\"best\"" : "", colour_of(chart, one), i + 1, escaped(one.variant.name),
        one.on_front ? " <b title=\"none is both cheaper and nearer\">◂</b>" : "",
        finer.empty() ? "" : "<br><small>not within the tolerance: " + escaped(finer) + "</small>");
    html += one.core_seconds > 0
                ? fmt::format("<td>{:.3g} <small>± {}</small></td><td>{}</td><td>{:.0f}</td><td>{:.2f}</td>",
                              one.core_seconds, or_unknown(one.cost_scatter),
                              chart.finest().core_seconds > 0
                                  ? ratio_text(chart.finest().core_seconds / one.core_seconds) + " times"
                                  : "?",
                              one.steps, 1e-6 * one.particle_steps_per_core_second)
                : "<td>–</td><td>–</td><td>–</td><td>–</td>";
    for (const auto& [name, reference] : chart.reference) {
      const auto found = one.deviations.find(name);
      if (found == one.deviations.end()) {
        html += "<td>failed or not run</td>";
      } else if (&one == &chart.finest() && found->second.error == 0) {
        html += "<td>reference</td>";
      } else {
        html += fmt::format("<td{}>{} <small>± {}</small></td>",
                            found->second.error > chart.study.tolerance ? " class=\"over\"" : "",
                            percent(found->second.error), percent(found->second.standard_error));
      }
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// The figures of one value themselves, each in the unit that reads best.
std::string values_part(const Chart& chart) {
  std::map<std::string, std::pair<std::string, double>> figures;  // by name: the unit, and the largest of all
  for (const VariantResult& one : chart.variants)
    for (const auto& [name, value] : one.values) {
      auto& [unit, largest] = figures[name];
      unit = value.unit, largest = std::max(largest, std::abs(value.mean));
    }
  if (figures.empty()) return "";
  std::string html =
      "<h2>What they came to</h2>\n<p>Means over samples ± the standard deviation of one.</p>\n"
      "<div class=\"wide\"><table><thead><tr><th>#</th><th class=\"name\">settings that differ from the usual</th>";
  for (const auto& [name, figure] : figures)
    html += "<th>" + escaped(axis_title(name, readable(figure.first, figure.second).unit)) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < chart.variants.size(); ++i) {
    const VariantResult& one = chart.variants[i];
    html += fmt::format("<tr><td>{}</td><td class=\"name\">{}</td>", i + 1, escaped(one.variant.name));
    for (const auto& [name, figure] : figures) {
      const auto value = one.values.find(name);
      const double factor = readable(figure.first, figure.second).factor;
      html += value == one.values.end()
                  ? "<td>–</td>"
                  : fmt::format("<td>{:.3g} <small>± {}</small></td>", factor * value->second.mean,
                                or_unknown(factor * value->second.scatter));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// Cost of each level of a setting and what it changes, as bars.
std::string effects_part(const Chart& chart) {
  if (chart.effects.empty()) return "";
  std::string html =
      "<h2>Each setting alone</h2>\n<p>A level beside the finest of the same setting, all others as usual.</p>\n"
      "<div class=\"wide\"><table><thead><tr><th class=\"name\">setting</th><th class=\"name\">level</th><th>cost over "
      "the finest</th>";
  for (const auto& [name, reference] : chart.reference) html += "<th>changes " + escaped(name) + " by</th>";
  html += "</tr></thead><tbody>\n";
  double largest = chart.study.tolerance;
  for (const Effect& effect : chart.effects)
    for (const auto& [name, one] : effect.deviations) largest = std::max(largest, one.error);
  for (const Effect& effect : chart.effects) {
    const auto& setting = chart.study.settings.at(effect.setting);
    html += fmt::format(
        "<tr><td class=\"name\">{}{}</td><td class=\"name\">{} <small>(finest {})</small></td><td>{} <small>± "
        "{}</small></td>",
        escaped(effect.setting), setting.about.empty() ? "" : "<br><small>" + escaped(setting.about) + "</small>",
        escaped(effect.level), escaped(setting.label(setting.finest_level())), ratio_text(effect.cost),
        or_unknown(effect.cost_error));
    for (const auto& [name, reference] : chart.reference) {
      const auto found = effect.deviations.find(name);
      if (found == effect.deviations.end()) {
        html += "<td>?</td>";
        continue;
      }
      const Deviation& one = found->second;
      html += fmt::format("<td class=\"bar{}\" style=\"--share:{:.1f}%\">{} <small>± {}</small></td>",
                          one.error > chart.study.tolerance ? " over" : "", 100 * one.error / largest,
                          percent(one.error), percent(one.standard_error));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string uncharted_part(const Chart& chart) {
  std::string html;
  for (const std::string& line : not_charted(chart)) html += "<li>" + escaped(line) + "</li>\n";
  return html.empty() ? "" : "<h2>Figures that could not be charted</h2>\n<ul>\n" + html + "</ul>\n";
}

std::string failures_part(const Chart& chart) {
  std::string html;
  for (std::size_t i = 0; i < chart.variants.size(); ++i)
    for (const Sample& sample : chart.variants[i].samples)
      if (sample.status != "done")
        html += fmt::format("<li><b>{} {}</b>, seed {:.0f}: {}</li>\n", i + 1, escaped(chart.variants[i].variant.name),
                            sample.seed, sample.status == "failed" ? escaped(sample.message) : "not run to its end");
  return html.empty() ? "" : "<h2>Where it fails</h2>\n<ul>\n" + html + "</ul>\n";
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

std::string chart_page(const Chart& chart) {
  const std::string title = chart.study.title.empty() ? "speed against accuracy" : chart.study.title;
  std::string html = page_begin(title, sheet) + "<h1>" + escaped(title) + "</h1>\n";
  html += fmt::format(
      "<p>{}, {} samples of each variant; {}s ± their standard error, core-seconds ± their standard "
      "deviation, both from the scatter between samples. By grit {}.{}</p>\n",
      escaped(std::filesystem::proximate(chart.study.scene).string()), chart.study.seeds.values.size(),
      word_for_error(chart.study), escaped(fmt::format("{}", fmt::join(chart.revisions, ", "))),
      chart.study.advice ? ""
                         : " What varies is what is modelled, not how: differences are from what is called the finest, "
                           "and none is an error.");
  html += "<p class=\"verdict\">" + escaped(verdict(chart)) + "</p>\n";
  if (!chart.reference.empty()) {
    html += "<div class=\"first\">" + error_chart(chart, "") + "</div>\n";
    html +=
        "<p><small>Down is nearer, left is cheaper; none is both that lies above the stepped line. In the shaded part "
        "differences are those between samples. The finest stands on the axis. A variant is within the tolerance only "
        "if all that are finer are: where an error grows again with a finer setting, it was small because others "
        "cancelled it.</small></p>\n";
  }
  html += "<h2>Variants</h2>\n" + variants_table(chart) + values_part(chart) + effects_part(chart) +
          uncharted_part(chart) + failures_part(chart);
  if (chart.reference.size() > 1) {
    html += "<h2>Each figure</h2>\n<div class=\"charts\">\n";
    for (const auto& [name, reference] : chart.reference) html += "<div>" + error_chart(chart, name) + "</div>\n";
    html += "</div>\n";
  }
  html += page_end;
  return html;
}

}  // namespace grit
