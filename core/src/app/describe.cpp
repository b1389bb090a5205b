#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/options.hpp"
#include "app/reference.hpp"
#include "calibration/description.hpp"
#include "description/description.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "input/reference.hpp"
#include "study/description.hpp"

namespace grit {
namespace {

/// The reference of a section of a description, by its key; empty if there is no such section.
std::string section_text(const Parameters& all, const std::string& name) {
  for (const Parameter& section : all.entries()) {
    if (section.name() != name) continue;
    Parameters one;
    one.add_target(section.name(), section.target()).doc(section.doc());
    return reference_text(one);
  }
  return "";
}

/// A type that a section lets the user choose: a condition, a source of bodies, a size distribution.
struct SectionType {
  std::string section, name;
  std::string text;  ///< its part of the section's reference
};

/// Those of all sections whose components can be loaded.
std::vector<SectionType> types_of(const Parameters& all) {
  std::vector<SectionType> types;
  for (const Parameter& section : all.entries()) {
    std::vector<std::pair<std::size_t, std::size_t>> open;  // indents and indices of the types around a line
    std::istringstream lines;
    try {
      lines.str(section_text(all, section.name()));
    } catch (const PluginError&) {
      continue;
    }
    std::string head;
    std::getline(lines, head);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t indent = line.find_first_not_of(' ');
      if (indent == std::string::npos) continue;
      while (!open.empty() && indent <= open.back().first) open.pop_back();
      if (line[indent] == '"') {
        open.emplace_back(indent, types.size());
        types.push_back(
            {section.name(), line.substr(indent + 1, line.find('"', indent + 1) - indent - 1), head + '\n'});
      }
      for (const auto& [_, type] : open) types[type].text += line + '\n';
    }
  }
  return types;
}

/// The reference of files for a command: StudyDescription, CalibrationDescription.
template <class File>
std::string file_text() {
  File file;
  Parameters parameters;
  file.declare(parameters);
  return reference_text(parameters);
}

void print_names(const Parameters& all, const Registry& registry) {
  std::cout << "sections of a description\n";
  for (const Parameter& section : all.entries())
    std::cout << "  " << std::left << std::setw(20) << section.name() << section.doc() << '\n';
  std::cout << "\nfiles for 'grit study' and 'grit calibrate'\n  study\n  calibration\n";
  std::string kind;
  for (const Installed& one : registry.installed()) {
    if (kind != one.kind) std::cout << '\n' << (kind = one.kind) << '\n';
    std::cout << "  " << one.name << '\n';
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> described_sections(const Registry& registry) {
  SceneDescription scene(registry);
  Parameters all;
  scene.declare(all);
  std::vector<std::pair<std::string, std::string>> sections{{"study", "file of 'grit study'"},
                                                            {"calibration", "file of 'grit calibrate'"}};
  for (const Parameter& section : all.entries()) sections.emplace_back(section.name(), section.doc());
  return sections;
}

ExitStatus describe_command(const Options& options) {
  const auto registry = options.registry();
  SceneDescription scene(*registry);
  Parameters all;
  scene.declare(all);
  if (options.words().empty()) {
    print_names(all, *registry);
    return ExitStatus::done;
  }
  const std::string name = options.only_word("name");
  if (const std::string section = section_text(all, name); !section.empty()) {
    std::cout << section;
    return ExitStatus::done;
  }
  if (name == "study" || name == "calibration") {
    std::cout << (name == "study" ? file_text<StudyDescription>() : file_text<CalibrationDescription>());
    return ExitStatus::done;
  }
  std::vector<std::string> names;
  for (const auto& [section, _] : described_sections(*registry)) names.push_back(section);
  for (const Installed& one : registry->installed()) {
    if (one.name == name) {
      std::cout << component_text(*registry, name, false);
      return ExitStatus::done;
    }
    names.push_back(one.name);
  }
  std::string section;  // each once: clouds and streams have the same sizes
  for (const SectionType& type : types_of(all)) {
    names.push_back(type.name);
    if (type.name != name || type.section == section) continue;
    std::cout << (section.empty() ? "" : "\n") << "in the section " << type.section << '\n' << type.text;
    section = type.section;
  }
  if (section.empty())
    throw PluginError("unknown section or component \"" + name + '"' +
                      did_you_mean(name, names, "'grit describe' lists all") + "\n  " + registry->search_text());
  return ExitStatus::done;
}

}  // namespace grit
