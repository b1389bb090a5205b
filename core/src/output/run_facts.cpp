#include "output/run_facts.hpp"

#include <algorithm>
#include <iterator>

#include "input/document.hpp"
#include "plugins/build_facts.hpp"
#include "storage/file_checksum.hpp"

namespace grit {
namespace {

Description layout(const Layout& layout) { return {{"size", layout.size}, {"alignment", layout.alignment}}; }

/// An unexpanded description with further assignments; null if they refer to what the scenario expands to.
Description with_sets(Description unexpanded, const std::vector<std::string>& sets) {
  if (unexpanded.is_null()) return unexpanded;
  Document document(std::move(unexpanded), "run.json");
  try {
    for (const std::string& assignment : sets) document.set(assignment);
  } catch (const DescriptionError&) {
    return nullptr;
  }
  return document.json();
}

}  // namespace

Description grit_facts() {
  const auto& build = build_facts();
  return {{"version", build.version},       {"revision", build.revision}, {"compiler", build.compiler},
          {"build_type", build.build_type}, {"flags", build.flags},       {"libraries", build.libraries},
          {"sdk_version", sdk_version},     {"arch", build.arch},         {"instruction_set", build.instruction_set}};
}

Description plugin_facts(const PluginUsed& used) {
  const auto& tag = used.tag;
  return {{"kind", used.kind},
          {"name", used.name},
          {"version", used.version},
          {"file", used.file.string()},
          {"build",
           {{"sdk_version", tag.sdk_version},
            {"compiler", tag.compiler},
            {"library_abi", tag.library_abi},
            {"instruction_set", tag.instruction_set},
            // Two builds may report the same facts. That of no bytes for built-in components.
            {"checksum", file_checksum(used.file)},
            {"row", layout(tag.row)},
            {"contact_row", layout(tag.contact_row)},
            {"body_sum", layout(tag.body_sum)},
            {"pair_batch", layout(tag.pair_batch)},
            {"wall_batch", layout(tag.wall_batch)}}}};
}

void continue_from(const Description& run_json, bool own_description, RunFacts& facts) {
  try {
    auto commands = run_json.at("commands").get<std::vector<std::vector<std::string>>>();
    std::ranges::move(facts.commands, std::back_inserter(commands));
    facts.commands = std::move(commands);
    if (!own_description) return;
    const Description& before = run_json.at("source");
    DescriptionSource source{.path = before.at("path").get<std::string>(),
                             .written = before.at("written"),
                             .sets = before.at("set").get<std::vector<std::string>>(),
                             .unexpanded = with_sets(before.at("unexpanded"), facts.source.sets)};
    std::ranges::move(facts.source.sets, std::back_inserter(source.sets));
    facts.source = std::move(source);
  } catch (const Description::exception&) {  // of an older program, or edited: only this command is known
  }
}

}  // namespace grit
