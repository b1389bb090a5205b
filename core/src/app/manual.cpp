// Manual pages, in the macros of man(7), of the declarations of the commands.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "app/options.hpp"
#include "grit/error.hpp"
#include "output/own_files.hpp"
#include "plugins/build_facts.hpp"
#include "storage/atomic_file.hpp"

namespace grit {
namespace {

/// Text of the user's in ASCII, as roff shows it as it is, in any encoding; a line of it is no request.
std::string roff(const std::string& text) {
  std::ostringstream out;
  if (text.starts_with('.') || text.starts_with('\'')) out << "\\&";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte == '\\') out << "\\e";
    else if (byte == '-') out << "\\-";
    else if (byte == '\'') out << "\\(aq";
    else if (byte == '`') out << "\\(ga";
    else if (byte == '^') out << "\\(ha";
    else if (byte == '~') out << "\\(ti";
    else if (byte < 0x80) out << text[i];
    else {
      const int more = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : 1;
      std::uint32_t code = byte & (0x3Fu >> more);
      for (int k = 0; k < more; ++k) code = code << 6 | (static_cast<unsigned char>(text.at(++i)) & 0x3Fu);
      // Formatters know no dots for terminals of ASCII.
      if (code == U'…') out << "\\&...";
      else out << "\\[u" << std::uppercase << std::hex << std::setw(4) << std::setfill('0') << code << ']';
    }
  }
  return out.str();
}

/// The same in lines of up to 80 characters, as formatters want them.
std::string lines_of(const std::string& text) {
  std::string lines;
  std::istringstream words(text);
  std::size_t width = 0;
  for (std::string word; words >> word; width += word.size()) {
    word = roff(word);
    if (const bool full = width + 1 + word.size() > 80; full && width > 0) {
      lines += '\n';
      width = 0;
    } else if (width > 0) {
      lines += ' ';
      ++width;
    }
    lines += word;
  }
  return lines;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

/// A sentence of a text that stands alone, such as "replace existing results".
std::string sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + (text.ends_with('.') ? "" : ".");
}

std::string page_name(const std::string& command) { return command.empty() ? "grit" : "grit-" + command; }

class Page {
 public:
  Page(std::ostream& out, const std::string& name, const std::string& doc) : out_(out) {
    std::string title = name;
    std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
    const BuildFacts& build = build_facts();
    out_ << ".TH " << roff(title) << " 1 " << build.date << " \"grit " << build.version
         << "\" \"User Commands\"\n.SH NAME\n"
         << lines_of(name + " - " + doc) << '\n';
  }
  void section(const char* title) { out_ << ".SH " << title << '\n'; }
  void line(const std::string& roff_text) { out_ << roff_text << '\n'; }
  void entry(const std::string& roff_term, const std::string& text) {
    out_ << ".TP\n" << roff_term << '\n' << lines_of(text) << '\n';
  }
  void exit_status() {
    section("EXIT STATUS");
    for (const auto& [status, name, doc] : exit_statuses) entry(bold(std::to_string(static_cast<int>(status))), doc);
  }
  /// Every page but this one.
  void see_also(const std::string& own) {
    section("SEE ALSO");
    std::string others = own.empty() ? "" : "\\fBgrit\\fR(1)";
    for (const Command& c : commands())
      if (c.name != own) others += (others.empty() ? "" : ",\n") + bold(page_name(c.name)) + "(1)";
    line(others);
    line(".PP\n" +
         lines_of("The documentation is in share/doc/grit of the installation, /usr/share/doc/grit of Debian's "
                  "package grit-doc. 'grit --help' prints the place."));
  }

 private:
  std::ostream& out_;
};

void print_page_of_grit(std::ostream& out) {
  Page page(out, "grit", about_grit);
  page.section("SYNOPSIS");
  page.line(bold("grit") + ' ' + italic("COMMAND") + " [" + italic("options") + ']');
  page.line(".br\n" + bold("grit") + ' ' + bold("help") + " [" + italic("COMMAND") + ']');
  page.line(".br\n" + bold("grit") + ' ' + bold("--version"));
  page.section("DESCRIPTION");
  page.line(lines_of(
      "A JSON file describes a test of granular mechanics. grit runs it and writes curves, maps and pictures of "
      "the grains. "
      "Contact laws, walls, engines, probes and scenarios are plugins."));
  page.section("COMMANDS");
  for (const Command& c : commands())
    page.entry(bold(c.name) + (*c.synopsis == 0 ? "" : ' ' + italic(c.synopsis)), c.doc);
  page.section("OPTIONS");
  page.entry(bold("-h") + ", " + bold("--help"), "Print the commands and exit.");
  page.entry(bold("--version"), "Print the version and the build, and exit.");
  page.exit_status();
  page.section("ENVIRONMENT");
  for (const Named& variable : environment()) page.entry(bold(variable.name), sentence(variable.doc));
  page.section("FILES");
  page.line(roff("In the folder of results of a run:"));
  for (const Named& file : result_files()) page.entry(italic(file.name), sentence(file.doc));
  page.line(".PP\n" + roff("The documentation:"));
  page.entry(
      italic("/usr/share/doc/grit"),
      "Pages in docs and descriptions of tests in sims, by the Debian package grit-doc. Other installations have "
      "them in share/doc/grit below their prefix, the source tree in its root. 'grit --help' prints the place.");
  page.see_also("");
}

void print_page_of(const Command& command, std::ostream& out) {
  Page page(out, page_name(command.name), command.doc);
  page.section("SYNOPSIS");
  page.line(bold("grit") + ' ' + bold(command.name) + (*command.synopsis == 0 ? "" : ' ' + italic(command.synopsis)) +
            " [" + italic("options") + ']');
  page.section("DESCRIPTION");
  page.line(lines_of(std::string(command.doc) + ' ' + command.text));
  page.section("OPTIONS");
  const Options options(command);
  for (const auto& option : options.declared().options()) {
    const std::string value = Options::value_name(*option);
    const std::string shorter =
        option->canonical_display_name(boost::program_options::command_line_style::allow_dash_for_short);
    page.entry((shorter.starts_with("--") || !shorter.starts_with('-') ? "" : bold(shorter) + ", ") +
                   bold("--" + option->long_name()) + (value.empty() ? "" : ' ' + italic(value)),
               sentence(option->description()) + Options::default_text(*option));
  }
  page.exit_status();
  page.see_also(command.name);
}

void print_page(const std::string& name, std::ostream& out) {
  name.empty() ? print_page_of_grit(out) : print_page_of(command(name), out);
}

/// Whether a file is one of these pages, by its title.
bool is_own_page_of_manual(const std::filesystem::path& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(".TH "))
      return line.starts_with(".TH GRIT") && line.find(" \"grit ") != line.npos && line.ends_with("\"User Commands\"");
  return false;
}

}  // namespace

void manual_options(Options& options) {
  options.add()("out", boost::program_options::value<std::string>()->value_name("DIR"),
                "write all pages into this folder instead, as grit.1, grit-run.1, …");
}

ExitStatus manual_command(const Options& options) {
  if (!options.has("out")) {
    print_page(options.words().empty() ? "" : options.only_word("command"), std::cout);
    return ExitStatus::done;
  }
  if (!options.words().empty()) throw UsageError("--out writes the pages of all commands; give it without a command");
  const std::filesystem::path folder = options.get<std::string>("out");
  std::filesystem::create_directories(folder);
  std::vector<std::string> names{""};
  for (const Command& c : commands()) names.emplace_back(c.name);
  const auto file_of = [&](const std::string& name) { return folder / (page_name(name) + ".1"); };
  for (const std::string& name : names) refuse_foreign_file(file_of(name), is_own_page_of_manual);
  for (const std::string& name : names) {
    std::ostringstream out;
    print_page(name, out);
    write_beside_others(file_of(name), out.str());
  }
  return ExitStatus::done;
}

}  // namespace grit
