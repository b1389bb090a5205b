#include "calibration/calibration_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <filesystem>

#include "calibration/calibration_chart.hpp"
#include "output/colours.hpp"
#include "output/page.hpp"
#include "output/svg.hpp"

namespace grit {
namespace {

std::string lines_of(const std::vector<std::string>& lines) {
  std::string html = "<ul>\n";
  for (const std::string& line : lines) html += "<li>" + escaped(line) + "</li>\n";
  return html + "</ul>\n";
}

std::string correlation_table(const std::vector<std::string>& names, const Eigen::MatrixXd& correlation) {
  std::string html = "<div class=\"wide\"><table><thead><tr><th></th>";
  for (const std::string& name : names) html += "<th>" + escaped(name) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    html += "<tr><td class=\"name\">" + escaped(names[i]) + "</td>";
    for (std::size_t k = 0; k < names.size(); ++k) {
      const double one = correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      html += fmt::format("<td style=\"background:{};color:#{}\">{:.2f}</td>",
                          colour_at(diverging_colours, 0.5 + 0.5 * one), std::abs(one) > 0.6 ? "fff" : "000", one);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string trials_table(const CalibrationDescription& calibration, const Trials& trials, std::size_t optimum) {
  std::string html = "<div class=\"wide\"><table><thead><tr><th>#</th><th class=\"name\">purpose</th>";
  for (const auto& [name, parameter] : calibration.parameters)
    html += "<th>" + escaped(name + (parameter.unit().empty() ? "" : " [" + parameter.unit() + ']')) + "</th>";
  std::vector<ReadableUnit> shown;  // by target
  for (const Observation& one : trials.observations())
    if (one.target == shown.size()) shown.push_back(readable(one));
  std::size_t column = 0;
  for (const auto& [name, target] : calibration.targets) {
    const std::string& unit = shown[column++].unit;
    html += "<th>" +
            (target.metric.is_curve() ? escaped(name) + "<br><small>misfit</small>" : escaped(axis_title(name, unit))) +
            "</th>";
  }
  html += "<th>misfit</th><th>core-seconds</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < trials.all().size(); ++i) {
    const Trial& trial = trials.all()[i];
    html += fmt::format("<tr{}><td>{}</td><td class=\"name\">{}</td>", i == optimum ? " class=\"best\"" : "", i + 1,
                        word_of(trial.purpose));
    for (const double value : trial.values) html += fmt::format("<td>{:.4g}</td>", value);
    if (trial.failed())
      html += fmt::format("<td class=\"name failed\" colspan=\"{}\">{}</td>", calibration.targets.size() + 1,
                          escaped(trial.failure()));
    else {
      const Eigen::VectorXd misfits = trials.misfits(trial);
      for (std::size_t k = 0, row = 0; k < trials.targets(); ++k) {
        const bool is_curve = !std::isnan(trials.observations()[row].at);
        html += fmt::format("<td>{:.4g}</td>", is_curve ? misfits[static_cast<Eigen::Index>(k)]
                                                        : shown[k].factor * trial.mean[static_cast<Eigen::Index>(row)]);
        while (row < trials.observations().size() && trials.observations()[row].target == k) ++row;
      }
      html += fmt::format("<td>{:.3g}</td>", misfits.sum());
    }
    html += fmt::format("<td>{:.3g}</td></tr>\n", trial.core_seconds());
  }
  return html + "</tbody></table></div>\n";
}

constexpr const char* calibration_sheet = R"(
.verdict{font-size:17px;border-left:4px solid #0072b2;padding:2px 14px;margin:18px 0}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,480px),1fr));gap:18px;margin:18px 0}
svg{width:100%;height:auto}
text{font-family:inherit;font-size:12px;fill:var(--ink)}
.axis{font-size:13px;font-weight:600}.small{font-size:11px;fill:var(--soft)}.m{text-anchor:middle}.e{text-anchor:end}
.grid{stroke:var(--line)}.frame{stroke:var(--frame)}.floor{fill:var(--band)}.wish{fill:none;stroke:var(--over);stroke-dasharray:5 4}
.curve{fill:none;stroke-width:2}.front{fill:none;stroke:var(--frame)}.target{fill:var(--over)}
.failed{fill:var(--over);color:var(--over)}tr.best{background:var(--band)}
)";

}  // namespace

std::string calibration_page(const CalibrationDescription& calibration, const Trials& trials,
                             const CalibrationOutcome& outcome) {
  const std::string title = calibration.title.empty() ? "calibration" : calibration.title;
  std::vector<std::string> targets;
  for (const auto& [name, target] : calibration.targets) targets.push_back(name);
  std::string html = page_begin(title, calibration_sheet) + "<h1>" + escaped(title) + "</h1>\n";
  html += fmt::format("<p>{}: {} samples a trial. ± is one standard error.</p>\n",
                      escaped(std::filesystem::proximate(calibration.base).string()), calibration.samples.count);
  html += "<div class=\"verdict\">" + lines_of(verdict(calibration, trials, outcome)) + "</div>\n";
  html += "<h2>Parameters</h2>\n" + lines_of(parameter_texts(calibration, trials, outcome));
  html += "<h2>Targets</h2>\n" + lines_of(target_texts(calibration, trials, outcome));
  html +=
      "<div class=\"charts\">\n<div>" + deviation_chart(trials, outcome.optimum, targets) +
      "<p><small>Grey: the first trial. Blue: the best. In the shaded band a target is met. Of a curve the root mean "
      "square is shown; beyond 10 at the edge.</small></p></div>\n";
  std::size_t index = 0;
  for (const auto& [name, target] : calibration.targets) {
    if (target.metric.is_curve())
      html += "<div>" + target_chart(trials, outcome.optimum, index, name, target.metric) + "</div>\n";
    ++index;
  }
  html += "<div>" + misfit_chart(trials, outcome.optimum) +
          "<p><small>Blue: the search. Orange: around the optimum, for the uncertainty. ×: failed.</small></p></div>\n"
          "</div>\n";
  if (calibration.parameters.size() > 1)
    html += "<h2>Correlation of the parameters' errors</h2>\n" +
            correlation_table(calibration.names(), outcome.uncertainty.correlation);
  html += "<h2>Trials</h2>\n" + trials_table(calibration, trials, outcome.optimum);
  return html + std::string(page_end);
}

}  // namespace grit
