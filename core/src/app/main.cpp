// grit: the command line.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "app/command.hpp"
#include "app/early_exit.hpp"
#include "app/interrupt.hpp"
#include "format/message.hpp"
#include "format/resources.hpp"
#include "format/utf8.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "grit/toolkit/text_file.hpp"
#include "plugins/build_facts.hpp"

namespace grit {

std::span<const Command> commands() {
  static constexpr std::array<Command, 10> all{{
      {"run", "FILE…", "Run descriptions, one after the other. Ctrl-C saves the results and stops.", run_command},
      {"check", "FILE…", "Validate a description; report time step, memory, frames and run time.", check_command},
      {"expand", "FILE", "Print a description with inheritance, --set and scenario resolved.", expand_command},
      {"schema", "", "Print the JSON Schema of descriptions, for editors.", schema_command},
      {"plugins", "[NAME]", "List the installed components, or one in detail.", plugins_command},
      {"describe", "[NAME]", "Print the parameters of a section of a description, or of a component.",
       describe_command},
      {"study", "STUDY", "Run a sweep, or a study of speed against accuracy; plot its metrics.", study_command},
      {"calibrate", "FILE", "Find parameters for which runs meet targets, with their errors.", calibrate_command},
      {"advise", "FILE", "Suggest cheaper settings within a tolerance, from the results of a study.", advise_command},
      {"report", "DIR…", "Write a page with curves and grains of one run, or of several side by side.", report_command},
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
  throw UsageError((name.starts_with('-') ? "unknown option \"" : "unknown command \"") + name + '"' +
                   did_you_mean(name, names, "see 'grit --help'"));
}

void print_usage(std::ostream& out) {
  out << "grit, discrete element method for sand, shear zones and silos\n\nusage: grit COMMAND [options]\n\n";
  for (const Command& c : commands()) {
    const std::string head = std::string("  ") + c.name + ' ' + c.synopsis;
    const auto width = static_cast<std::size_t>(std::ranges::count_if(head, [](char b) { return (b & 0xC0) != 0x80; }));
    out << head << std::string(20 - width, ' ') << c.doc << '\n';
  }
  out << "\n'grit COMMAND --help' prints the options of a command, 'grit --version' the version and build.\n"
         "GRIT_ISA selects an installed instruction set; GRIT_PLUGIN_PATH adds plugin folders.\n"
         "Exit status: 0 done, 1 usage, 2 description, 3 plugin, 4 numerics, 5 files or disk,\n"
         "70 defect of the program, 130 interrupted and saved.\n";
}

void print_version() {
  const BuildFacts& build = build_facts();
  std::cout << "grit " << build.version << (*build.revision == 0 ? "" : " (") << build.revision
            << (*build.revision == 0 ? "" : ")") << ", " << build.compiler << ", " << build.build_type << ", "
            << build.instruction_set << " (-march=" << build.arch << ")\n";
}

/// The launcher selects among installed builds. A single build must refuse a GRIT_ISA other than its own.
void check_instruction_set() {
  const char* const wanted = std::getenv("GRIT_ISA");
  const BuildFacts& build = build_facts();
  if (wanted == nullptr || *wanted == 0 || wanted == std::string(build.arch)) return;
  throw Error(std::string("GRIT_ISA=") + wanted + ": this build has one instruction set, \"" + build.arch + "\" (" +
              build.instruction_set + ")\n  unset GRIT_ISA, build with -DGRIT_ARCH=" + wanted +
              ", or install several with scripts/package.sh");
}

/// Values, names and paths of the command line are written into descriptions, run.json and pages.
void check_encoding(const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (!is_utf8(word))
      throw UsageError("found " + quoted_excerpt(word) +
                       ", which is not UTF-8; give all names and values in UTF-8, and rename files of other names");
  std::error_code none;
  if (const auto here = std::filesystem::current_path(none).string(); !is_utf8(here))
    throw FileError(visible_text(here) +
                    ": the name of the working folder is not UTF-8; rename it, or work in another");
}

ExitStatus main(const std::vector<std::string>& words) {
  check_instruction_set();
  check_encoding(words);
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
    // With redirected output a full disk may only show here.
    if (!std::cout.flush() && !has_no_reader(STDOUT_FILENO))
      throw FileError("standard output cannot be written; is the disk full?");
    return status;
  } catch (const UsageError& error) {
    return say(error.what(), ExitStatus::usage);
  } catch (const DescriptionError& error) {
    // file:line comes first, as in compilers, so that editors can jump to it.
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
    return say(message_of(error), ExitStatus::files);
  } catch (const std::bad_alloc&) {
    return say(out_of_memory(), ExitStatus::files);
  } catch (const std::exception& error) {
    return say(std::string("defect of grit or of a plugin; please report it: ") + error.what(), ExitStatus::defect);
  } catch (...) {
    return say("defect of grit or of a plugin; please report it: something that is not a std::exception",
               ExitStatus::defect);
  }
}

}  // namespace grit

int main(int count, char** arguments) {
  grit::prepare_outputs();
  grit::refuse_early_exit();
  return grit::finish(grit::report([&] { return grit::main({arguments + 1, arguments + count}); }));
}
