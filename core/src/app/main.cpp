// grit: the command line.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "app/command.hpp"
#include "app/completion.hpp"
#include "app/early_exit.hpp"
#include "app/installation.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "device/open_device.hpp"
#include "format/message.hpp"
#include "format/resources.hpp"
#include "format/utf8.hpp"
#include "grit/build_tag.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/text_file.hpp"
#include "plugins/build_facts.hpp"

namespace grit {
namespace {

void print_usage(std::ostream& out) {
  out << "grit, " << about_grit << "\n\nusage: grit COMMAND [options]\n\n";
  for (const Command& c : commands()) {
    const std::string head = std::string("  ") + c.name + ' ' + c.synopsis;
    const auto width = static_cast<std::size_t>(std::ranges::count_if(head, [](char b) { return (b & 0xC0) != 0x80; }));
    out << head << std::string(20 - width, ' ') << c.doc << '\n';
  }
  out << "\n'grit COMMAND --help' prints the options of a command, 'grit --version' the version and build.\n";
  for (std::size_t i = 0; i < environment().size(); ++i)
    out << (i > 0 ? "; " : "") << environment()[i].name << ' ' << environment()[i].doc;
  out << ".\nExit status: ";
  for (const auto& [status, name, doc] : exit_statuses) {
    if (status == ExitStatus::defect) out << ",\n";
    else if (status != ExitStatus::done) out << ", ";
    out << static_cast<int>(status) << ' ' << name;
  }
  const std::filesystem::path place = documentation();
  out << ".\nDocumentation: "
      << (place.empty() ? "the Debian package grit-doc, or docs of the source tree" : (place / "docs").string());
  if (!place.empty()) out << "\nDescriptions of tests: " << (place / "sims").string();
  out << '\n';
}

void print_version() {
  const BuildFacts& build = build_facts();
  std::cout << "grit " << build.version << (*build.revision == 0 ? "" : " (") << build.revision
            << (*build.revision == 0 ? "" : ")") << ", " << build.compiler << ", " << build.build_type << ", "
            << build.instruction_set << " (-march=" << build.arch << ")\n"
            << "compiler flags: " << build.flags << "\nlibraries: " << build.libraries
            << "\nplugin interface (SDK): version " << sdk_version
            << "\nGPUs: " << (has_gpu_component() ? "by CUDA" : "none (built without nvcc)") << '\n';
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

ExitStatus run(const Command& command, const std::vector<std::string>& words) {
  Options options(command);
  return options.read(words) ? command.main(options) : ExitStatus::done;
}

ExitStatus main(const std::vector<std::string>& words) {
  check_instruction_set();
  check_encoding(words);
  if (words.empty()) {
    print_usage(std::cerr);
    return ExitStatus::usage;
  }
  const std::string& first = words[0];
  if (first == "--complete") {
    print_candidates({words.begin() + 1, words.end()}, std::cout);
    return ExitStatus::done;
  }
  if (first == "--help" || first == "-h" || first == "help") {
    if (words.size() > 1) return run(command(words[1]), {"--help"});
    print_usage(std::cout);
    return ExitStatus::done;
  }
  if (first == "--version") {
    print_version();
    return ExitStatus::done;
  }
  return run(command(first), {words.begin() + 1, words.end()});
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
