#include "study/sweep_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/page.hpp"
#include "output/svg.hpp"
#include "study/study_sentences.hpp"
#include "study/sweep_chart.hpp"

namespace grit {
namespace {

std::string spread_text(double value) { return std::isfinite(value) ? fmt::format("{:.2g}", value) : "?"; }

/// The unit of a metric for display, by its largest value.
ReadableUnit unit_of(const StudyResult& result, const std::string& metric) {
  std::string unit;
  double largest = 0;
  for (const VariantResult& one : result.variants)
    if (const auto value = one.values.find(metric); value != one.values.end())
      unit = value->second.unit, largest = std::max(largest, std::abs(value->second.mean));
  return readable(unit, largest);
}

/// Means and standard errors of metrics with one value, with the differences from given values.
std::string sweep_table(const StudyResult& result) {
  std::string html = "<div class=\"wide\"><table><thead><tr><th>#</th>";
  for (const auto& [name, setting] : result.study.settings)
    html += "<th class=\"name\">" + escaped(name) +
            (setting.doc.empty() ? "" : "<br><small>" + escaped(setting.doc) + "</small>") + "</th>";
  for (const auto& [name, metric] : result.study.metrics) {
    if (metric.is_curve()) continue;
    const ReadableUnit unit = unit_of(result, name);
    html += "<th>" + escaped(axis_title(name, unit.unit)) + "</th>";
    if (metric.value) html += fmt::format("<th>{} − {:.4g}</th>", escaped(name), unit.factor * *metric.value);
  }
  html += "<th>samples</th><th>core-seconds</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < result.variants.size(); ++i) {
    const VariantResult& one = result.variants[i];
    html += fmt::format("<tr><td>{}</td>", i + 1);
    std::size_t k = 0;
    for (const auto& [name, setting] : result.study.settings)
      html += "<td class=\"name\">" + escaped(setting.label(one.variant.levels[k++])) + "</td>";
    for (const auto& [name, metric] : result.study.metrics) {
      if (metric.is_curve()) continue;
      const auto value = one.values.find(name);
      if (value == one.values.end()) {
        html += metric.value ? "<td>–</td><td>–</td>" : "<td>–</td>";
        continue;
      }
      const double factor = unit_of(result, name).factor;
      const std::string spread =
          fmt::format(" <small>± {}</small></td>", spread_text(factor * value->second.standard_error()));
      html += fmt::format("<td>{:.4g}", factor * value->second.mean) + spread;
      if (metric.value) html += fmt::format("<td>{:.3g}", factor * (value->second.mean - *metric.value)) + spread;
    }
    html +=
        fmt::format("<td>{} of {}</td>", std::ranges::count(one.samples, "done", &Sample::status), one.samples.size());
    html += one.core_seconds > 0 ? fmt::format("<td>{:.3g} <small>± {}</small></td></tr>\n", one.core_seconds,
                                               spread_text(one.cost_scatter))
                                 : "<td>–</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string sweep_charts(const StudyResult& result) {
  std::string html;
  for (const auto& [name, metric] : result.study.metrics)
    for (const auto& [setting, levels] : result.study.settings) {
      const std::string chart =
          metric.is_curve() ? sweep_curves(result, name, setting) : sweep_chart(result, name, setting);
      if (!chart.empty()) html += "<div>" + chart + "</div>\n";
    }
  return html.empty() ? "" : "<div class=\"charts\">\n" + html + "</div>\n";
}

std::string unfinished_part(const StudyResult& result) {
  std::string html;
  for (const std::string& line : not_evaluated(result)) html += "<li>" + escaped(line) + "</li>\n";
  for (const VariantResult& one : result.variants)
    for (const Sample& sample : one.samples)
      if (sample.status != "done")
        html += fmt::format("<li><b>{}</b>, seed {:.0f}: {}</li>\n", escaped(one.variant.name), sample.seed,
                            sample.status == "failed" ? escaped(sample.message) : sample.status);
  return html.empty() ? "" : "<h2>Failed and unfinished</h2>\n<ul>\n" + html + "</ul>\n";
}

constexpr const char* sweep_sheet = R"(
.verdict{font-size:17px;border-left:4px solid #0072b2;padding:2px 14px;margin:18px 0}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,480px),1fr));gap:18px;margin:18px 0}
svg{width:100%;height:auto}
text{font-family:inherit;font-size:12px;fill:var(--ink)}
.axis{font-size:13px;font-weight:600}.small{font-size:11px;fill:var(--soft)}.m{text-anchor:middle}.e{text-anchor:end}
.grid{stroke:var(--line)}.frame{stroke:var(--frame)}.wish{stroke:var(--over);stroke-dasharray:5 4}
.curve{fill:none;stroke-width:2}.spread{stroke-width:1.5}
)";

}  // namespace

std::string sweep_page(const StudyResult& result) {
  const std::string title = result.study.title.empty() ? "sweep" : result.study.title;
  std::string html = page_begin(title, sweep_sheet) + "<h1>" + escaped(title) + "</h1>\n";
  html += fmt::format(
      "<p>{}, {} of {} runs done. Metrics: mean ± standard error over samples; core-seconds: mean ± standard "
      "deviation. Run by grit {}.</p>\n",
      escaped(std::filesystem::proximate(result.study.scene).string()), result.count("done"), result.runs(),
      escaped(fmt::format("{}", fmt::join(result.revisions, ", "))));
  if (const std::string conclusion = verdict(result); !conclusion.empty())
    html += "<p class=\"verdict\">" + escaped(conclusion) + "</p>\n";
  html += sweep_charts(result) + "<h2>Values</h2>\n" + sweep_table(result) + unfinished_part(result);
  return html + std::string(page_end);
}

}  // namespace grit
