#include "app/options.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <system_error>
#include <thread>

#include "grit/toolkit/did_you_mean.hpp"
#include "simulation/standard_registry.hpp"

namespace grit {
namespace po = boost::program_options;
namespace {

/// In lines as wide as those of the options.
std::string wrapped(const std::string& text) {
  std::string lines;
  std::istringstream words(text);
  std::size_t width = 0;
  for (std::string word; words >> word; width += word.size() + 1) {
    if (const bool full = width + word.size() > po::options_description::m_default_line_length; full || width == 0) {
      lines += full ? "\n" : "";
      width = 0;
    } else {
      lines += ' ';
    }
    lines += word;
  }
  return lines + '\n';
}

}  // namespace

Options::Options(const Command& command) : command_(command) {
  visible_.add_options()("plugin-path", po::value<std::vector<std::string>>()->composing()->value_name("DIR"),
                         "search for plugins here too; may be repeated")("help,h", "print this help and exit");
  command.options(*this);
}

std::string Options::value_name(const po::option_description& option) {
  if (option.semantic()->max_tokens() == 0) return "";
  const std::string text = option.format_parameter();  // with the default: "N (=1)"
  return text.substr(0, text.find(" (="));
}

std::string Options::default_text(const po::option_description& option) {
  const std::string text = option.format_parameter();
  const auto begin = text.find(" (=");
  return begin == std::string::npos ? "" : " Default: " + text.substr(begin + 3, text.size() - begin - 4) + '.';
}

void Options::add_set() {
  visible_.add_options()("set", po::value<std::vector<std::string>>()->composing()->value_name("/POINTER=VALUE"),
                         "override a value of the description, e.g. --set /seed=2; an object replaces that of the file "
                         "and is merged onto that of a scenario; /- appends to a list, null removes; may be repeated");
}

void Options::add_threads(const char* doc) {
  const unsigned all = std::max(1u, std::thread::hardware_concurrency());
  visible_.add_options()(
      "threads", po::value<std::string>()->default_value(std::to_string(all), "all cores")->value_name("N"), doc);
}

void Options::add_device() {
  visible_.add_options()(
      "device", po::value<std::string>()->default_value("none")->value_name("KIND"),
      "what steps the bodies: none (this process), gpu, or emulated (the kernels of a GPU in loops on the CPU, for tests)");
}

DeviceKind Options::device() const {
  const auto kind = get<std::string>("device");
  if (kind == "none") return DeviceKind::none;
  if (kind == "gpu") return DeviceKind::gpu;
  if (kind == "emulated") return DeviceKind::emulated;
  throw UsageError("--device takes none, gpu or emulated, not \"" + kind + '"');
}

unsigned Options::number(const char* name) const {
  const auto text = get<std::string>(name);
  unsigned number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1 || number > 1024)
    throw UsageError(std::string("--") + name + " takes a number from 1 to 1024, not \"" + text + '"');
  return number;
}

bool Options::read(const std::vector<std::string>& words) {
  command_line_ = words;
  po::options_description all;
  all.add(visible_).add_options()("words", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("words", -1);
  try {
    // No abbreviated names: a script must not change its meaning when an option is added.
    const auto style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(words).options(all).positional(positional).style(style).run(), values_);
    po::notify(values_);
  } catch (const po::unknown_option& error) {
    std::vector<std::string> names;
    for (const auto& option : visible_.options()) names.push_back("--" + option->long_name());
    throw UsageError(error.what() + did_you_mean(error.get_option_name(), names,
                                                 std::string("see 'grit ") + command_.name + " --help'"));
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see 'grit " + command_.name + " --help'");
  }
  words_ = list("words");
  const auto takes_value = [&](const std::string& name) { return all.find(name, false).semantic()->max_tokens() > 0; };
  for (const auto& [name, value] : values_)
    if (const auto* const text = boost::any_cast<std::string>(&value.value());
        text != nullptr && text->empty() && takes_value(name))
      throw UsageError("--" + name + " takes a value, not \"\"; see 'grit " + command_.name + " --help'");
  if (std::ranges::find(words_, "") != words_.end())
    throw UsageError(std::string("found an empty name, \"\"; give a file or folder; see 'grit ") + command_.name +
                     " --help'");
  if (!has("help")) return true;
  std::cout << "grit " << command_.name << ' ' << command_.synopsis << (*command_.synopsis == 0 ? "" : " ")
            << "[options]\n\n"
            << command_.doc << '\n'
            << wrapped(command_.text) << '\n'
            << visible_;
  return false;
}

std::vector<std::string> Options::list(const char* name) const {
  return has(name) ? get<std::vector<std::string>>(name) : std::vector<std::string>();
}

std::string Options::only_word(const char* what) const {
  if (words_.size() != 1)
    throw UsageError(std::string("'grit ") + command_.name + "' takes one " + what + ", not " +
                     (words_.empty() ? "none" : std::to_string(words_.size())) + "; see 'grit " + command_.name +
                     " --help'");
  return words_.front();
}

void Options::warn_of_threads() const {
  const unsigned present = std::thread::hardware_concurrency();
  if (present == 0 || threads() <= present) return;
  std::cerr << "grit: warning: --threads " << threads() << ": this machine runs " << present
            << " at once, and more of them are slower; give " << present << " or fewer" << std::endl;
}

std::unique_ptr<Registry> Options::registry() const {
  const auto folders = list("plugin-path");
  for (const std::string& folder : folders) {
    if (const std::string fault = fault_of_plugin_directory(folder); !fault.empty())
      throw UsageError("--plugin-path takes a folder of plugins, not \"" + folder + "\", " + fault);
  }
  return standard_registry(folders);
}

}  // namespace grit
