// grit: the command line.
#include <algorithm>
#include <array>
#include <iostream>

#include "app/command.hpp"
#include "grit/error.hpp"

namespace grit {

std::span<const Command> commands() {
  static constexpr std::array<Command, 6> all{{
      {"run", "FILE… [options]", "Runs descriptions, one after the other. Ctrl-C saves what there is and stops.",
       run_command},
      {"check", "FILE… [options]",
       "Says what would run: components, state and who asked for it, the time step and its limit, memory, time.",
       check_command},
      {"expand", "FILE [options]", "Prints the plain description: extended, set, its scenario expanded, in SI.",
       expand_command},
      {"schema", "[options]", "Prints the JSON Schema of everything installed, for editors.", schema_command},
      {"plugins", "[NAME] [options]", "Lists what is installed; one in full.", plugins_command},
      {"describe", "NAME [options]", "Prints the parameters of a component, or of a section of a description.",
       describe_command},
  }};
  return all;
}

namespace {

void print_usage(std::ostream& out) {
  out << "grit, discrete elements for sand, shear zones and silos\n\nusage: grit COMMAND [options]\n\n";
  for (const Command& c : commands()) {
    std::string head = std::string("  grit ") + c.name + ' ' + c.synopsis;
    head.resize(std::max<std::size_t>(head.size() + 2, 34), ' ');
    out << head << c.doc << '\n';
  }
  out << "\n'grit COMMAND --help' says more. Exit status: 0 done, 1 usage, 2 description, 3 plugin, 4 numerics,\n"
         "5 files or disk, 130 interrupted and saved.\n";
}

ExitStatus main(const std::vector<std::string>& words) {
  if (words.empty()) {
    print_usage(std::cerr);
    return ExitStatus::usage;
  }
  if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
    print_usage(std::cout);
    return ExitStatus::done;
  }
  const auto found =
      std::find_if(commands().begin(), commands().end(), [&](const Command& c) { return words[0] == c.name; });
  if (found == commands().end()) throw UsageError("there is no command \"" + words[0] + "\"; see 'grit --help'");
  return found->main({words.begin() + 1, words.end()});
}

}  // namespace
}  // namespace grit

int main(int count, char** arguments) {
  using grit::ExitStatus;
  const auto fail = [](const std::exception& error, ExitStatus status) {
    std::cerr << "grit: " << error.what() << '\n';
    return static_cast<int>(status);
  };
  try {
    return static_cast<int>(grit::main({arguments + 1, arguments + count}));
  } catch (const grit::UsageError& error) {
    return fail(error, ExitStatus::usage);
  } catch (const grit::PluginError& error) {
    return fail(error, ExitStatus::plugin);
  } catch (const grit::NumericsError& error) {
    return fail(error, ExitStatus::numerics);
  } catch (const grit::FileError& error) {
    return fail(error, ExitStatus::files);
  } catch (const grit::Error& error) {
    return fail(error, ExitStatus::description);
  } catch (const std::bad_alloc& error) {
    return fail(std::runtime_error("there is not enough memory for this scene; 'grit check' says how much it needs"),
                ExitStatus::files);
  }
}
