// The table of commands, and what their manual pages share.
#include <algorithm>
#include <array>

#include "app/command.hpp"
#include "app/options.hpp"
#include "grit/toolkit/did_you_mean.hpp"

namespace grit {
namespace {

void no_options(Options& /*options*/) {}

}  // namespace

std::span<const Command> commands() {
  static constexpr std::array<Command, 12> all{{
      {"run", "FILE…", "Run descriptions, one after the other. Ctrl-C saves the results and stops.",
       "Each run writes a folder of results, results/NAME for NAME.json. Existing results are kept unless --overwrite "
       "or --resume is given.",
       run_options, run_command},
      {"check", "FILE…", "Validate a description; report time step, memory, frames and run time.",
       "Nothing is run or written. Errors come as FILE:LINE: /pointer: what was found; what is allowed.", check_options,
       check_command},
      {"expand", "FILE", "Print a description with inheritance, --set and scenario resolved.",
       "The output is a description that can be run from any folder: it names its files by their full paths.",
       expand_options, expand_command},
      {"schema", "", "Print the JSON Schema of descriptions, for editors.",
       "The schema knows the built-in components and the plugins that are found.", no_options, schema_command},
      {"plugins", "[PLUGIN]", "List the installed components, or one in detail.",
       "Of each: kind, name, version, one line, and the file of a plugin.", no_options, plugins_command},
      {"describe", "[NAME]", "Print the parameters of a section of a description, or of a component.",
       "Without a name, all are listed.", no_options, describe_command},
      {"study", "STUDY", "Run a sweep, or a study of speed against accuracy; plot its metrics.",
       "Runs that are done are not run again; the same command continues a study. 'grit advise' uses its study.json.",
       study_options, study_command},
      {"calibrate", "FILE", "Find parameters for which runs meet targets, with their errors.",
       "Trials that are done are not run again; the same command continues a calibration.", calibrate_options,
       calibrate_command},
      {"advise", "FILE", "Suggest cheaper settings within a tolerance, from the results of a study.",
       "The results are those of 'grit study', installed or given by --study.", advise_options, advise_command},
      {"report", "RESULTS…", "Write a page with curves and grains of one run, or of several side by side.",
       "RESULTS are folders that 'grit run' wrote.", report_options, report_command},
      {"new", "KIND OWN", "Write a plugin of your own, with its test, from the example of the guide.",
       "KIND is contact, geometry, probe, engine, scenario or body. The folder has the code, a test, a scene that uses "
       "it, "
       "and a README with the commands that build, test and run it.",
       new_options, new_command},
      {"manual", "[COMMAND]", "Print the manual page of grit, or of a command, for 'man -l -'.",
       "The pages have the texts of --help.", manual_options, manual_command},
  }};
  return all;
}

const Command& command(const std::string& name) {
  if (const auto found = std::ranges::find(commands(), name, &Command::name); found != commands().end()) return *found;
  std::vector<std::string> names;
  for (const Command& c : commands()) names.emplace_back(c.name);
  throw UsageError((name.starts_with('-') ? "unknown option \"" : "unknown command \"") + name + '"' +
                   did_you_mean(name, names, "see 'grit --help'"));
}

std::span<const Named> environment() {
  static constexpr std::array<Named, 2> all{{
      {"GRIT_ISA", "selects an installed instruction set"},
      {"GRIT_PLUGIN_PATH", "adds plugin folders"},
  }};
  return all;
}

std::span<const Named> result_files() {
  static constexpr std::array<Named, 7> all{{
      {"description.json", "the description as it was run, with all defaults"},
      {"run.json", "status and facts of the run"},
      {"series.h5", "samples of the probes over time"},
      {"frames.xdmf, frames/", "bodies, contacts and walls at some times, for ParaView"},
      {"checkpoint.h5", "the last checkpoint, from which --resume continues"},
      {"final.h5", "the last state, from which other runs can begin"},
      {"report.html", "a page with curves and grains"},
  }};
  return all;
}

}  // namespace grit
