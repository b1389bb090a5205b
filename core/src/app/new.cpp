// `grit new`: a plugin of one's own outside the tree, from the worked example of its guide (docs/plugins).
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/installation.hpp"
#include "app/options.hpp"
#include "format/names.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "plugins/build_facts.hpp"
#include "plugins/kind.hpp"

namespace grit {

extern const std::string_view guide_contact, guide_geometry, guide_probe, guide_engine, guide_scenario, guide_body;

namespace {
namespace fs = std::filesystem;
using nlohmann::json;

struct Guide {
  const char* kind;
  const char* doc;
  const char* page;  ///< in docs/plugins
  const std::string_view& text;
  const char* section;  ///< where the scene uses the plugin
  const char* values;   ///< there, beside its type
};
constexpr std::array<Guide, 6> guides{{
    {kind_name<ContactLaw>(), "a contact law", "contact-law.md", guide_contact, "/contacts", "{}"},
    {kind_name<Geometry>(), "a geometry of walls", "geometry.md", guide_geometry, "/walls/own",
     R"({"centre": ["5 mm", "5 mm", 0], "radius": "3 mm", "material": "sand"})"},
    {kind_name<Probe>(), "a probe", "probe.md", guide_probe, "/probes/own", R"({"every_time": "1 ms"})"},
    {kind_name<Engine>(), "an engine", "engine.md", guide_engine, "/engines/own", "{}"},
    {kind_name<Scenario>(), "a scenario", "scenario.md", guide_scenario, "", "{}"},
    {kind_name<BodyKind>(), "a kind of body", "body.md", guide_body, "/bodies/grains", "{}"},
}};

/// A block of code of a guide: ```LANGUAGE FILE.
struct Block {
  std::string file, code;
};

std::vector<Block> blocks_of(std::string_view guide) {
  std::vector<Block> blocks;
  std::istringstream lines{std::string(guide)};
  Block* open = nullptr;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("```")) {
      if (open != nullptr) open->code += line + '\n';
    } else if (const auto space = line.find(' '); space != std::string::npos) {
      open = &blocks.emplace_back(Block{line.substr(space + 1), ""});
    } else {
      open = nullptr;
    }
  }
  return blocks;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::regex word(const std::string& name) { return std::regex("\\b" + name + "\\b"); }

/// "peak-speed" as PeakSpeed, with a suffix where the example has another thing of that name.
std::string class_name(const std::string& name, const std::string& code) {
  std::string camel;
  for (bool upper = true; const char c : name) {
    if (c != '-') camel += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = c == '-';
  }
  while (std::regex_search(code, word(camel))) camel += "Plugin";
  return camel;
}

/// The example of a guide under another name.
std::vector<Block> renamed(std::vector<Block> blocks, const std::string& name) {
  const std::string example = fs::path(blocks.front().file).stem().string();
  std::smatch found;
  if (!std::regex_search(blocks.front().code, found,
                         std::regex("(?:class|struct) (\\w+) (?:final )?: (?:public )?grit::")))
    throw std::logic_error("the guide of " + example + " has no class");
  const std::string type = found[1];
  std::string code;
  for (const Block& block : blocks) code += std::regex_replace(block.code, word(type), "");
  const std::string own_type = class_name(name, code);
  for (auto& [file, text] : blocks) {
    file = replaced(file, example, name);
    for (const char* end : {"\"", ".hpp\""}) text = replaced(text, '"' + example + end, '"' + name + end);
    text = std::regex_replace(text, word(type), own_type);
  }
  return blocks;
}

/// Some grains that fall into a box, with the component.
std::string scene(const Guide& guide, const std::string& name) {
  json scene = {{"title", "grains that fall into a box"},
                {"materials", {{"sand", {{"density", 2600}}}}},
                {"contacts", {{"type", "linear-rolling"}}},
                {"bodies",
                 {{"grains",
                   {{"type", "sphere"},
                    {"material", "sand"},
                    {"source",
                     {{"type", "cloud"},
                      {"low", {0, 0, "5 mm"}},
                      {"high", {"10 mm", "10 mm", "25 mm"}},
                      {"count", 60},
                      {"sizes", {{"type", "uniform"}, {"smallest", "2 mm"}, {"largest", "2.5 mm"}}}}}}}}},
                {"walls",
                 {{"box",
                   {{"type", "box"},
                    {"low", {0, 0, 0}},
                    {"high", {"10 mm", "10 mm", "30 mm"}},
                    {"open", {"z_high"}},
                    {"material", "sand"}}}}},
                {"engines",
                 {{"gravity", {{"type", "gravity"}}}, {"damping", {{"type", "local-damping"}, {"coefficient", 0.05}}}}},
                {"probes", {{"energy", {{"type", "energy"}, {"every_time", "2 ms"}}}}},
                {"output", {{"frames", {{"every_time", "10 ms"}}}}},
                {"stages", {{{"name", "fall"}, {"until", {{"type", "time"}, {"value", "0.2 s"}}}, {"limit", "1 s"}}}}};
  json& place = scene[json::json_pointer(guide.section)];
  place["type"] = name;
  place.update(json::parse(guide.values));
  return scene.dump(2) + '\n';
}

/// The options by which CMake finds this grit and its compiler.
std::string cmake_options() {
  std::string options = " -DCMAKE_BUILD_TYPE=Release";
  const std::string compiler = build_facts().compiler;  // "Clang 16.0.6"
  const std::string version = compiler.substr(compiler.find(' ') + 1);
  options += std::string(" -DCMAKE_CXX_COMPILER=") + (compiler.starts_with("Clang") ? "clang++-" : "g++-") +
             version.substr(0, version.find('.'));
  const fs::path package = beside_program({"cmake/grit/grit-config.cmake", "lib/cmake/grit/grit-config.cmake"});
  return options + (package.empty() ? " -DCMAKE_PREFIX_PATH=PREFIX" : " -Dgrit_DIR=" + package.parent_path().string());
}

std::string commands_text(const std::string& scene_file) {
  return "cmake -S . -B build" + cmake_options() + "\ncmake --build build\nctest --test-dir build\ngrit run " +
         scene_file + " --plugin-path build/lib/grit\n";
}

std::string readme(const Guide& guide, const std::string& name, const std::string& scene_file) {
  return "# " + name + "\nThis is " + guide.doc +
         ", a plugin of grit. It begins as the worked example of the guide, `" +
         (documentation() / "docs/plugins" / guide.page).string() +
         "`, which has the rules for this kind.\n\n"
         "| file | |\n| --- | --- |\n| `" +
         name + ".hpp` | the code |\n| `" + name +
         ".cpp` | what grit loads: name, version, one line of text |\n| `test_" + name + ".cpp` | its tests |\n| `" +
         scene_file +
         "` | a scene with it |\n\nBuild, test and use it; tests need GoogleTest (Debian: `libgtest-dev "
         "libgmock-dev`):\n```sh\n" +
         commands_text(scene_file) + "```\n`grit describe " + name +
         " --plugin-path build/lib/grit` prints its parameters.\n";
}

std::string cmake_lists(const Guide& guide, const std::string& name) {
  const auto kind =
      std::ranges::find(kinds, std::string(guide.kind), [](const Kind& one) { return std::string(one.name); });
  return "cmake_minimum_required(VERSION 3.25)\nproject(" + name +
         " VERSION 1.0.0 LANGUAGES CXX)\n\nfind_package(GTest)\nif(NOT TARGET GTest::gmock)\n"
         "  message(STATUS \"GoogleTest is not found, so no tests are built; install it, on Debian: apt install "
         "libgtest-dev libgmock-dev\")\nendif()\n"
         "find_package(grit " +
         build_facts().version + " REQUIRED)\nenable_testing()\n\ngrit_plugin(" + kind->folder + ' ' + name + ")\n";
}

const Guide& guide_of(const std::string& kind) {
  if (const auto found = std::ranges::find(guides, kind, &Guide::kind); found != guides.end()) return *found;
  std::vector<std::string> names;
  for (const Guide& guide : guides) names.emplace_back(guide.kind);
  throw UsageError("found the kind \"" + kind + '"' + did_you_mean(kind, names, "allowed are " + listed(names)));
}

void check_name(const std::string& name, const Guide& guide, const Registry& registry) {
  static const std::regex allowed("[a-z][a-z0-9]*(-[a-z0-9]+)*");
  if (!std::regex_match(name, allowed) || name.size() > 64)
    throw UsageError(
        "found the name \"" + name +
        "\"; allowed are lower-case letters, digits and single hyphens between them, beginning with a letter, "
        "64 at most");
  for (const Installed& one : registry.installed())
    if (one.kind == guide.kind && one.name == name)
      throw UsageError("found the name \"" + name + "\", which an installed " + one.kind +
                       " has; two of one name are refused when they are used: choose another");
}

}  // namespace

void new_options(Options& options) {
  options.add()("out", boost::program_options::value<std::string>()->value_name("DIR"),
                "the folder to make; default: ./NAME");
}

ExitStatus new_command(const Options& options) {
  if (options.words().size() != 2)
    throw UsageError("'grit new' takes a kind and a name, as in 'grit new contact my-law'; see 'grit new --help'");
  const std::string name = options.words()[1];
  const Guide& guide = guide_of(options.words()[0]);
  check_name(name, guide, *options.registry());

  std::vector<Block> files = renamed(blocks_of(guide.text), name);
  const std::string scene_file = guide.section[0] == 0 ? name + ".json" : "scene.json";
  if (guide.section[0] != 0) files.push_back({scene_file, scene(guide, name)});
  files.push_back({"CMakeLists.txt", cmake_lists(guide, name)});
  files.push_back({"README.md", readme(guide, name, scene_file)});

  const fs::path folder = options.has("out") ? options.get<std::string>("out") : name;
  std::error_code none;
  if (fs::exists(fs::symlink_status(folder, none)) && !(fs::is_directory(folder, none) && fs::is_empty(folder, none)))
    throw FileError(folder.string() +
                    ": exists and is not an empty folder; nothing was written: choose another by --out");
  fs::create_directories(folder);
  for (const auto& [file, text] : files) {
    std::ofstream out(folder / file);
    if (!(out << text).flush()) throw FileError((folder / file).string() + ": cannot be written");
  }
  std::cout << folder.string() << ": " << guide.doc << ". Build, test and use it:\n\ncd " << folder.string() << '\n'
            << commands_text(scene_file);
  return ExitStatus::done;
}

}  // namespace grit
