// Command-line options shared by all commands.
#pragma once

#include <boost/program_options.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "grit/simulation.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// The command line of one command; positional words go to the hidden option "words".
class Options {
 public:
  /// Those that the command declares. Every command has --plugin-path and --help, too.
  explicit Options(const Command& command);
  /// --set, for commands that read a description; list("set") returns the values given.
  void add_set();
  /// --threads; threads() checks the value.
  void add_threads(const char* doc);
  /// --device; device() checks the value.
  void add_device();
  boost::program_options::options_description_easy_init add() { return visible_.add_options(); }
  /// The name of the value that an option takes; "" if it takes none.
  static std::string value_name(const boost::program_options::option_description& option);
  /// A sentence with its default, as in " Default: 5%."; "" without one.
  static std::string default_text(const boost::program_options::option_description& option);
  const boost::program_options::options_description& declared() const { return visible_; }
  /// Parses the words. Prints the help and returns false if --help is given. Throws UsageError.
  bool read(const std::vector<std::string>& words);

  const std::vector<std::string>& words() const { return words_; }
  /// The words as they were given, with options.
  const std::vector<std::string>& command_line() const { return command_line_; }
  bool has(const char* name) const { return values_.count(name) > 0; }
  /// Whether the command line has the option, not only its default.
  bool given(const char* name) const { return has(name) && !values_[name].defaulted(); }
  template <class T>
  T get(const char* name) const {
    return values_[name].as<T>();
  }
  std::vector<std::string> list(const char* name) const;
  /// Value of --threads or --jobs. Throws UsageError if it is not from 1 to 1024.
  unsigned number(const char* name) const;
  unsigned threads() const { return number("threads"); }
  /// Value of --device. Throws UsageError for others than those allowed.
  DeviceKind device() const;
  /// Reports --threads beyond those of the machine.
  void warn_of_threads() const;
  /// The single positional word of the command. Throws UsageError.
  std::string only_word(const char* what) const;
  /// Built-in components and the plugins of --plugin-path, GRIT_PLUGIN_PATH and this installation. Throws UsageError
  /// for a --plugin-path that is not a folder.
  std::unique_ptr<Registry> registry() const;

 private:
  const Command& command_;
  boost::program_options::options_description visible_{"options"};
  boost::program_options::variables_map values_;
  std::vector<std::string> words_, command_line_;
};

}  // namespace grit
