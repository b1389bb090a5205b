#include "report/report_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/colours.hpp"
#include "output/page.hpp"
#include "output/shell_word.hpp"
#include "output/svg.hpp"
#include "report/description_differences.hpp"
#include "report/facts.hpp"
#include "report/references.hpp"
#include "report/run_results.hpp"

namespace grit {

// Embedded by CMake from page/ and Vega.
extern const std::string_view report_style, report_script, live_script, vega_script, vega_licence;

namespace {

// Vega compiles its expressions to functions.
constexpr const char* policy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline' 'unsafe-eval'; img-src data: blob:; {}base-uri 'none'; form-action 'none'\">\n";

/// What "±" means, for a page that has it.
std::string note_on_errors(const std::string& html) {
  if (html.find(" ± ") == std::string::npos) return "";
  return "<p class=\"note\">± is the standard error of the time average for this packing. Other packings may differ by "
         "more; a study with several seeds shows by how much.</p>\n";
}

std::string text_at(const RunResults& run, const std::string& pointer) {
  const Description& found = run.at(pointer);
  return found.is_string() ? found.get<std::string>() : found.is_null() ? "" : found.dump();
}

std::string badge(const RunResults& run) {
  const std::string status = status_of(run);
  return "<span class=\"status " + escaped(status) + "\">" + escaped(status) + "</span>";
}

/// One line: program, machine, when.
std::string provenance(const RunResults& run) {
  std::vector<std::string> parts;
  if (const auto version = text_at(run, "/grit/version"); !version.empty()) {
    const auto revision = text_at(run, "/grit/revision");
    parts.push_back("grit " + version + (revision.empty() ? "" : " (" + revision + ")"));
  }
  for (const char* pointer : {"/host/cpu", "/started"})
    if (const auto text = text_at(run, pointer); !text.empty()) parts.push_back(text);
  if (const auto seed = text_at(run, "/seed"); !seed.empty()) parts.push_back("seed " + seed);
  return fmt::format("{}", fmt::join(parts, "  ·  "));
}

std::string cards(const std::vector<Fact>& facts) {
  if (facts.empty()) return "";
  std::string html = "<dl class=\"facts\">\n";
  for (const Fact& fact : facts)
    html += fmt::format("<div{}><dt>{}</dt><dd>{}<small>{}</small></dd></div>\n",
                        fact.doubtful ? " class=\"doubtful\"" : "", escaped(fact.name), escaped(fact.value),
                        escaped(fact.note));
  return html + "</dl>\n";
}

/// Rows of the values in which the descriptions of runs differ.
std::string difference_rows(const std::vector<RunResults>& runs) {
  constexpr std::size_t most = 20;
  const auto differences = description_differences(runs);
  std::string html;
  for (const DescriptionDifference& one : std::span(differences).first(std::min(most, differences.size()))) {
    html += "<tr class=\"differs\"><td class=\"name\">" + escaped(one.pointer) + "</td>";
    for (const std::string& value : one.values) html += "<td>" + (value.empty() ? "–" : escaped(value)) + "</td>";
    html += "</tr>\n";
  }
  if (differences.size() > most)
    html += fmt::format("<tr><td class=\"name\" colspan=\"{}\">and {} more</td></tr>\n", runs.size() + 1,
                        differences.size() - most);
  return html;
}

/// Facts of several runs, one column per run.
std::string facts_table(const std::vector<RunResults>& runs, const std::vector<std::vector<Fact>>& facts) {
  std::vector<std::string> names;
  for (const auto& of_run : facts)
    for (const Fact& fact : of_run)
      if (std::ranges::find(names, fact.name) == names.end()) names.push_back(fact.name);
  std::string html = "<div class=\"wide\"><table><thead><tr><th></th>";
  for (std::size_t i = 0; i < runs.size(); ++i)
    html += fmt::format("<th><span class=\"key\" style=\"background:{}\"></span>{}</th>",
                        series_colours[i % series_colours.size()], escaped(runs[i].name));
  html += "</tr></thead><tbody>\n<tr><td class=\"name\">title</td>";
  const auto same_title = [&](const RunResults& run) { return run.title() == runs[0].title(); };
  if (std::ranges::all_of(runs, same_title))
    html += fmt::format("<td class=\"name\" colspan=\"{}\">{}</td>", runs.size(), escaped(runs[0].title()));
  else
    for (const RunResults& run : runs) html += "<td>" + escaped(run.title()) + "</td>";
  html += "</tr>\n<tr><td class=\"name\">status</td>";
  for (const RunResults& run : runs) html += "<td>" + badge(run) + "</td>";
  html += "</tr>\n" + difference_rows(runs);
  for (const std::string& name : names) {
    std::vector<const Fact*> row;
    for (const auto& of_run : facts) {
      const auto fact = std::ranges::find(of_run, name, &Fact::name);
      row.push_back(fact == of_run.end() ? nullptr : &*fact);
    }
    // A note common to all runs is written once.
    const Fact& known = **std::ranges::find_if(row, [](const Fact* fact) { return fact != nullptr; });
    const bool once = std::ranges::all_of(row, [&](const Fact* fact) { return !fact || fact->note == known.note; });
    html += "<tr><td class=\"name\">" + escaped(name);
    html += (once ? "<small>" + escaped(known.note) + "</small>" : "") + "</td>";
    for (const Fact* fact : row)
      html += !fact ? "<td>–</td>"
                    : fmt::format("<td{}>{}{}</td>", fact->doubtful ? " class=\"doubtful\"" : "", escaped(fact->value),
                                  once ? "" : "<small>" + escaped(fact->note) + "</small>");
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// Run time by phase, as one bar.
std::string phases_bar(const RunResults& run) {
  const Description& phases = run.at("/phases_s");
  double all = 0;
  for (const Description& seconds : phases)
    if (seconds.is_number()) all += seconds.get<double>();
  if (!(all > 0)) return "";
  std::string bar, legend;
  std::size_t place = 0;
  for (const auto& [name, seconds] : phases.items()) {
    if (!seconds.is_number()) continue;
    const double fraction = 100 * seconds.get<double>() / all;
    const char* colour = series_colours[place++ % series_colours.size()];
    bar += fmt::format("<span style=\"width:{:.2f}%;background:{}\" title=\"{}\"></span>", fraction, colour,
                       escaped(name));
    legend += fmt::format("<li><span class=\"key\" style=\"background:{}\"></span>{} {}</li>", colour, escaped(name),
                          percent(fraction / 100));
  }
  return "<div class=\"phases\">" + bar + "</div>\n<ul class=\"legend\">" + legend + "</ul>\n";
}

std::string stages_table(const RunResults& run) {
  const Description& stages = run.at("/stages");
  if (!stages.is_array() || stages.empty()) return "";
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th class=\"name\">stage</th><th class=\"name\">reached</th>"
      "<th>time [s]</th><th>step</th><th>wall time</th></tr></thead><tbody>\n";
  for (const Description& stage : stages) try {
      html += fmt::format(
          "<tr><td class=\"name\">{}</td><td class=\"name\">{}</td><td>{:.4g}</td><td>{}</td><td>{}</td>"
          "</tr>\n",
          escaped(stage.value("name", "")), escaped(stage.value("reached", "")), stage.value("time", 0.0),
          grouped(stage.value("step", std::uint64_t{0})), cost_text(stage.value("wall_s", 0.0)));
    } catch (const Description::exception&) {
      html += "<tr><td class=\"name\">unreadable</td></tr>\n";
    }
  return html + "</tbody></table></div>\n";
}

std::string details(const RunResults& run) {
  std::string html = phases_bar(run) + stages_table(run);
  if (!html.empty()) html = "<details><summary>stages and run time by phase</summary>" + html + "</details>\n";
  if (const Description& description = run.at("/description"); description.is_object())
    html += "<details><summary>description, with all defaults</summary><pre>" + escaped(description.dump(2)) +
            "</pre></details>\n";
  return html;
}

std::string message_of(const RunResults& run) {
  std::string message = text_at(run, "/message");
  if (const std::string where = where_interrupted(run); message.empty() && !where.empty())
    message = where + " 'grit run --resume " + shell_word(run.folder.string()) + "' continues it.";
  return message.empty() ? "" : "<p class=\"message\">" + escaped(message) + "</p>\n";
}

std::string head_of(const std::vector<RunResults>& runs, const std::vector<double>& diameters) {
  std::string html = "<header>\n<h1>" + escaped(runs.size() == 1 ? runs[0].title() : "Runs side by side") + "</h1>\n";
  if (runs.size() == 1) {
    const RunResults& run = runs[0];
    html += "<p class=\"provenance\">" + badge(run) + ' ' + escaped(provenance(run)) + "</p>\n" + message_of(run);
    html += cards(cost_facts(run));
    if (const auto results = cards(result_facts(run)); !results.empty())
      html += "<h2>Results</h2>\n" + results + note_on_errors(results);
    if (const auto trust = cards(trust_facts(run, diameters[0])); !trust.empty())
      html += "<h2>Reliability</h2>\n" + trust;
    return html + details(run) + "</header>\n";
  }
  std::vector<std::vector<Fact>> facts;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    facts.push_back(result_facts(runs[i]));
    std::ranges::move(cost_facts(runs[i]), std::back_inserter(facts.back()));
    std::ranges::move(trust_facts(runs[i], diameters[i]), std::back_inserter(facts.back()));
  }
  const std::string table = facts_table(runs, facts);
  html += table + note_on_errors(table);
  for (const RunResults& run : runs) {
    html += message_of(run);
    html += "<details><summary>" + escaped(run.name) + "</summary><p class=\"provenance\">" + escaped(provenance(run)) +
            "</p>\n" + details(run) + "</details>\n";
  }
  return html + "</header>\n";
}

std::string problems_part(const std::vector<std::string>& problems) {
  if (problems.empty()) return "";
  std::string html = "<section class=\"problems\"><h2>What could not be read</h2>\n<ul>\n";
  for (const std::string& problem : problems) html += "<li>" + escaped(problem) + "</li>\n";
  return html + "</ul></section>\n";
}

Description channel_json(const ProbeSeries::Channel& channel, DataElements& data) {
  double largest = 0;
  bool filled = false;
  for (const double value : channel.sampled.values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value)), filled = true;
  return {{"name", channel.name},
          {"label", channel.label()},
          {"unit", channel.sampled.unit},
          {"about", with_symbols(channel.sampled.doc)},
          {"largest", largest},
          {"width", channel.width()},
          {"coordinate", channel.sampled.coordinate},
          {"components", channel.sampled.components},
          {"samples", channel.sampled.samples},
          {"filled", filled},
          {"zero", channel.zero_throughout()},
          {"data", data.add_numbers<double>(channel.sampled.values)}};
}

/// Units in which all runs' values are easy to read, by unit and channel: {unit, factor}.
void add_readable_units(Description& runs) {
  std::map<std::string, double> largest;
  const auto each = [&](auto act) {
    for (Description& run : runs)
      for (Description& probe : run["probes"])
        for (Description& channel : probe["channels"])
          act(probe["name"].get<std::string>() + '/' + channel["name"].get<std::string>(), channel);
  };
  each([&](const std::string& name, const Description& channel) {
    largest[name] = std::max(largest[name], channel["largest"].get<double>());
  });
  each([&](const std::string& name, Description& channel) {
    const ReadableUnit shown = readable(channel["unit"], largest[name]);
    channel["shown_unit"] = shown.unit, channel["factor"] = shown.factor;
    channel.erase("largest");
  });
}

/// References of the description: [{name, of, against, x, y}], x and y being data elements, or value.
Description references_json(RunResults& run, DataElements& data) {
  Description all = Description::array();
  for (const Reference& reference : references_of(run)) {
    Description json = {{"name", reference.name}, {"of", reference.of}, {"against", reference.against}};
    if (reference.value) json["value"] = *reference.value;
    else json["x"] = data.add_numbers<double>(reference.x), json["y"] = data.add_numbers<double>(reference.y);
    all.push_back(std::move(json));
  }
  return all;
}

Description run_json(RunResults& run, DataElements& data) {
  Description json = {{"name", run.name}, {"title", run.title()}, {"picture", run.at("/description/output/picture")}};
  json["color_scales"] = run.at("/description/output/color_scales");
  json["references"] = references_json(run, data);
  json["probes"] = Description::array();
  for (const ProbeSeries& probe : run.probes) {
    Description channels = Description::array();
    for (const auto& channel : probe.channels) channels.push_back(channel_json(channel, data));
    json["probes"].push_back(Description{{"name", probe.name}, {"channels", std::move(channels)}});
  }
  return json;
}

/// JSON escaped for a script element.
std::string json_element(const char* id, const Description& json) {
  std::string text = json.dump(-1, ' ', false, Description::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return std::string("<script type=\"application/json\" id=\"") + id + "\">" + text + "</script>\n";
}

std::string script_element(std::string_view script) {
  std::string html = "<script>\n";
  html += script;
  return html + "</script>\n";
}

}  // namespace

ReportContent report_content(std::span<const std::filesystem::path> folders, const GrainLimits& limits,
                             DataElements& data, std::chrono::milliseconds patience) {
  std::vector<RunResults> runs;
  std::vector<std::string> unread;
  for (const auto& folder : folders) try {
      runs.push_back(read_results(folder, patience));
    } catch (const FileError& error) {
      unread.emplace_back(error.what());
    }
  if (runs.empty()) throw FileError(fmt::format("{}", fmt::join(unread, "\n  ")));
  make_names_unique(runs);
  GrainLimits of_run = limits;
  of_run.bytes /= std::max<std::size_t>(1, runs.size());
  of_run.map_bytes /= std::max<std::size_t>(1, runs.size());
  of_run.value_bytes /= std::max<std::size_t>(1, runs.size());
  ReportContent content = empty_content(runs.size() == 1 ? runs[0].title() : "Runs side by side", "");
  std::vector<double> diameters;
  for (RunResults& run : runs) {
    Description one = run_json(run, data);
    one["grains"] = grain_frames(run.frames, of_run, data, run.problems);
    diameters.push_back(one["grains"].is_null() ? 0 : one["grains"]["mean_diameter"].get<double>());
    content.problems.insert(content.problems.end(), run.problems.begin(), run.problems.end());
    content.unsettled = content.unsettled || run.unsettled;
    content.json["runs"].push_back(std::move(one));
  }
  add_readable_units(content.json["runs"]);
  std::vector<std::string> all = unread;
  all.insert(all.end(), content.problems.begin(), content.problems.end());
  content.head = head_of(runs, diameters) + problems_part(all);
  content.unread = std::move(unread), content.first = runs.front().folder;
  return content;
}

ReportContent empty_content(const std::string& title, const std::string& words) {
  ReportContent content;
  content.title = title;
  content.head = "<header>\n<h1>" + escaped(title) + "</h1>\n<p>" + escaped(words) + "</p>\n</header>\n";
  content.json = {{"colours", {{"series", series_colours}, {"diverging", diverging_colours}}},
                  {"runs", Description::array()}};
  return content;
}

std::string report_html(const ReportContent& content, const DataElements& data, Reach reach) {
  const bool asks = reach == Reach::server;
  std::string html = page_begin(content.title, report_style,
                                fmt::format(policy, asks ? "connect-src 'self'; worker-src blob:; " : ""));
  html += "<div id=\"head\">\n" + content.head + "</div>\n";
  html +=
      "<main>\n<section id=\"curves\"></section>\n<section id=\"grains\"></section>\n<section id=\"maps\"></section>\n"
      "<noscript><p class=\"message\">JavaScript is disabled; it is needed to draw curves and grains."
      "</p></noscript>\n"
      "</main>\n";
  html += json_element("report", content.json);
  html += data.html();
  html += "<script type=\"text/plain\" id=\"vega-licence\">";
  html += vega_licence;
  html += "</script>\n";
  html += script_element(vega_script) + script_element(report_script);
  if (asks) html += script_element(live_script);
  html += page_end;
  return html;
}

ReportPage report_page(std::span<const std::filesystem::path> folders, const GrainLimits& limits) {
  DataElements data;
  ReportContent content = report_content(folders, limits, data);
  return {report_html(content, data, Reach::closed), std::move(content.problems), std::move(content.unread),
          std::move(content.first)};
}

}  // namespace grit
