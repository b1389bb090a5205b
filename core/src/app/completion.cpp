#include "app/completion.hpp"

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <sstream>

#include "app/options.hpp"
#include "app/reference.hpp"
#include "plugins/kind.hpp"
#include "simulation/standard_registry.hpp"

namespace grit {
namespace {

using Option = boost::program_options::option_description;

/// What the words before the one to be completed say.
struct Before {
  std::vector<const Option*> given;
  std::vector<std::string> plugin_path;
  const Option* pending = nullptr;  ///< its value comes next
  std::size_t names = 0;            ///< words that are no options
};

/// The option of a word such as --out or --out=results; none for others.
const Option* option_of(const std::string& word, const Options& options) {
  for (const auto& option : options.declared().options())
    if (word.substr(0, word.find('=')) == "--" + option->long_name()) return option.get();
  return nullptr;
}

Before read(std::span<const std::string> words, const Options& options) {
  Before before;
  for (const std::string& word : words) {
    if (before.pending != nullptr) {
      if (before.pending->long_name() == "plugin-path") before.plugin_path.push_back(word);
      before.pending = nullptr;
    } else if (const Option* const option = option_of(word, options)) {
      before.given.push_back(option);
      if (!Options::value_name(*option).empty() && word.find('=') == std::string::npos) before.pending = option;
    } else if (!word.starts_with('-')) {
      ++before.names;
    }
  }
  return before;
}

class Candidates {
 public:
  Candidates(Before before, std::ostream& out) : before_(std::move(before)), out_(out) {}

  void print(const std::string& word, const std::string& doc) { out_ << word << '\t' << doc << '\n'; }

  void print_options(const Options& options) {
    for (const auto& option : options.declared().options())
      if (option->semantic()->is_composing() || std::ranges::find(before_.given, option.get()) == before_.given.end())
        print("--" + option->long_name(), option->description());
  }

  /// Of a value with this name.
  void print_values(const std::string& name) {
    if (name == "FILE" || name == "STUDY") out_ << ":files *.json\n";
    if (name == "PAGE") out_ << ":files *.html\n";
    if (name == "HOSTS") out_ << ":files *\n";
    if (name == "DIR") out_ << ":folders\n";
    if (name == "RESULTS") out_ << ":results\n";
    if (name == "PLUGIN" || name == "NAME") print_components(name == "NAME");
    if (name == "COMMAND") print_commands();
    if (name == "KIND")
      for (const Kind& kind : kinds) print(kind.name, "");
    if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyz|") != std::string::npos) return;
    std::istringstream words(name);
    for (std::string word; std::getline(words, word, '|');) print(word, "");
  }

  void print_commands() {
    for (const Command& c : commands()) print(c.name, c.doc);
  }

 private:
  void print_components(bool sections) {
    std::erase_if(before_.plugin_path, [](const std::string& folder) {
      std::error_code none;
      return !std::filesystem::is_directory(folder, none);
    });
    const auto registry = standard_registry(before_.plugin_path);
    if (sections)
      for (const auto& [name, doc] : described_sections(*registry)) print(name, doc);
    for (const Installed& one : registry->installed()) print(one.name, one.kind);
  }

  Before before_;
  std::ostream& out_;
};

/// The name of what a command takes next, without "…" and brackets; "" if it takes no more.
std::string next_name(const std::string& synopsis, std::size_t before) {
  std::istringstream names(synopsis);
  std::string name;
  for (std::size_t i = 0; i <= before && !name.ends_with("…"); ++i)
    if (!(names >> name)) return "";
  const auto begin = name.find_first_not_of('[');
  return begin == std::string::npos ? "" : name.substr(begin, name.find_first_of("]\xE2", begin) - begin);
}

}  // namespace

void print_candidates(const std::vector<std::string>& words, std::ostream& out) {
  const std::string last = words.empty() ? "" : words.back();
  if (words.size() < 2 || (words.size() == 2 && words.front() == "help")) {
    Candidates candidates({}, out);
    candidates.print_commands();
    if (words.size() < 2) candidates.print("help", "Print the commands, or the options of one.");
    if (last.starts_with('-'))
      candidates.print("--help", "print this help and exit"), candidates.print("--version", "print version and build");
    return;
  }
  const auto named = std::ranges::find(commands(), words.front(), &Command::name);
  if (named == commands().end()) return;
  const Options options(*named);
  const Before before = read(std::span(words).subspan(1, words.size() - 2), options);
  Candidates candidates(before, out);
  if (before.pending != nullptr) return candidates.print_values(Options::value_name(*before.pending));
  if (!last.starts_with('-')) return candidates.print_values(next_name(named->synopsis, before.names));
  const Option* const begun = option_of(last, options);
  if (begun != nullptr && last.find('=') != std::string::npos)
    return candidates.print_values(Options::value_name(*begun));
  candidates.print_options(options);
}

}  // namespace grit
