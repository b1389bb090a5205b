// grit: the command line.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "app/command.hpp"
#include "grit/error.hpp"
#include "plugins/build_facts.hpp"
#include "plugins/nearest.hpp"

namespace grit {

std::span<const Command> commands() {
  static constexpr std::array<Command, 9> all{{
      {"run", "FILE…", "Runs descriptions, one after the other. Ctrl-C saves what there is and stops.", run_command},
      {"check", "FILE…", "Says what would run: components, state, time step and its limit, memory, time.",
       check_command},
      {"expand", "FILE", "Prints the plain description: extended, set, its scenario expanded.", expand_command},
      {"schema", "", "Prints the JSON Schema of everything installed, for editors.", schema_command},
      {"plugins", "[NAME]", "Lists what is installed; one in full.", plugins_command},
      {"describe", "[NAME]", "Prints the parameters of a section of a description, or of a component.",
       describe_command},
      {"chart", "STUDY", "Speed against accuracy: runs a study, draws error against cost.", chart_command},
      {"advise", "FILE", "Says what may be relaxed within a tolerance, by the evidence of a study.", advise_command},
      {"report", "DIR…", "Makes one page of a run, or of several side by side: curves and grains.", report_command},
  }};
  return all;
}

namespace {

const Command& named(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& c : commands()) {
    if (name == c.name) return c;
    names.emplace_back(c.name);
  }
  const auto meant = nearest(name, names);
  throw UsageError((name.starts_with('-') ? "there is no option \"" : "there is no command \"") + name + '"' +
                   (meant ? "; did you mean \"" + *meant + "\"? See" : "; see") + " 'grit --help'");
}

void print_usage(std::ostream& out) {
  out << "grit, discrete elements for sand, shear zones and silos\n\nusage: grit COMMAND [options]\n\n";
  for (const Command& c : commands()) {
    const std::string head = std::string("  ") + c.name + ' ' + c.synopsis;
    const auto width = static_cast<std::size_t>(std::ranges::count_if(head, [](char b) { return (b & 0xC0) != 0x80; }));
    out << head << std::string(20 - width, ' ') << c.doc << '\n';
  }
  out << "\n'grit COMMAND --help' says more, 'grit --version' which grit this is.\n"
         "GRIT_ISA chooses among installed instruction sets, GRIT_PLUGIN_PATH adds folders of plugins.\n"
         "Exit status: 0 done, 1 usage, 2 description, 3 plugin, 4 numerics, 5 files or disk,\n"
         "70 defect of the program, 130 interrupted and saved.\n";
}

void print_version() {
  const BuildFacts& build = build_facts();
  std::cout << "grit " << build.version << (*build.revision == 0 ? "" : " (") << build.revision
            << (*build.revision == 0 ? "" : ")") << ", " << build.compiler << ", " << build.build_type << ", "
            << build.instruction_set << " (-march=" << build.arch << ")\n";
}

/// Installed builds are chosen from before one starts. A build by itself must not let another choice pass unnoticed.
void check_instruction_set() {
  const char* const wanted = std::getenv("GRIT_ISA");
  const BuildFacts& build = build_facts();
  if (wanted == nullptr || *wanted == 0 || wanted == std::string(build.arch)) return;
  throw Error(std::string("GRIT_ISA=") + wanted + ": this build has one instruction set, \"" + build.arch + "\" (" +
              build.instruction_set + ")\n  unset GRIT_ISA, build with -DGRIT_ARCH=" + wanted +
              ", or install several with scripts/package.sh");
}

ExitStatus main(const std::vector<std::string>& words) {
  check_instruction_set();
  if (words.empty()) {
    print_usage(std::cerr);
    return ExitStatus::usage;
  }
  const std::string& first = words[0];
  if (first == "--help" || first == "-h" || first == "help") {
    if (words.size() > 1) return named(words[1]).main({"--help"});
    print_usage(std::cout);
    return ExitStatus::done;
  }
  if (first == "--version") {
    print_version();
    return ExitStatus::done;
  }
  return named(first).main({words.begin() + 1, words.end()});
}

}  // namespace

ExitStatus report(const std::function<ExitStatus()>& work) {
  const auto say = [](const std::string& text, ExitStatus status) {
    std::cerr << "grit: " << text << std::endl;
    return status;
  };
  try {
    const ExitStatus status = work();
    // A full disk behind a redirection shows here at the latest.
    if (!std::cout.flush()) throw FileError("standard output cannot be written: is the disk full?");
    return status;
  } catch (const UsageError& error) {
    return say(error.what(), ExitStatus::usage);
  } catch (const DescriptionError& error) {
    // As compilers have it, file:line first, so that editors find the places.
    std::cerr << error.what() << std::endl;
    const std::size_t count = error.problems().size();
    return say(count == 1 ? "1 problem in the description" : std::to_string(count) + " problems in the description",
               ExitStatus::description);
  } catch (const PluginError& error) {
    return say(error.what(), ExitStatus::plugin);
  } catch (const NumericsError& error) {
    return say(error.what(), ExitStatus::numerics);
  } catch (const FileError& error) {
    return say(error.what(), ExitStatus::files);
  } catch (const Error& error) {
    return say(error.what(), ExitStatus::description);
  } catch (const std::filesystem::filesystem_error& error) {
    return say(error.what(), ExitStatus::files);
  } catch (const std::bad_alloc&) {
    return say("there is not enough memory for this scene; 'grit check' says how much it needs", ExitStatus::files);
  } catch (const std::exception& error) {
    return say(std::string("a defect of grit or of a plugin, please report it: ") + error.what(), ExitStatus::defect);
  }
}

}  // namespace grit

int main(int count, char** arguments) {
  return static_cast<int>(grit::report([&] { return grit::main({arguments + 1, arguments + count}); }));
}
