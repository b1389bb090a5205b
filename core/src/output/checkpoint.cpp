#include "output/checkpoint.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "description/description.hpp"
#include "grit/error.hpp"
#include "input/document.hpp"

namespace grit {
namespace {

const char* advice(ResumedBy by) {
  return by == ResumedBy::command_line
             ? "\n  resume with the original program, plugins and description, or start again (--overwrite)"
             : "\n  resume with the original grit, plugins and description, or run from the start";
}

/// The build of a plugin, without the path of its file.
Description build_of(const PluginUsed& used) {
  Description facts = plugin_facts(used);
  facts.erase("file");
  return facts;
}

std::string text_of(const Description& facts) {
  return facts.dump(-1, ' ', false, Description::error_handler_t::replace);
}

/// JSON has neither infinite numbers nor texts that are not UTF-8.
Description as_written(const Description& facts) { return Description::parse(text_of(facts)); }

/// Names of the stages of a description, or of any list of named objects; nothing for another value.
std::optional<std::vector<std::string>> names_of(const Description& list) {
  std::vector<std::string> names;
  for (const Description& one : list) {
    if (!one.is_object() || !one.contains("name") || !one.at("name").is_string()) return std::nullopt;
    names.push_back(one.at("name").get<std::string>());
  }
  return names;
}

std::string quoted_list(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

/// Differences of two values, each with its pointer.
class Differences {
 public:
  Differences(const Description& now, const Description& then) { compare("", now, then); }

  /// One line each, up to a maximum.
  std::string text() const {
    constexpr std::size_t most = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, all_.size()); ++i) text += "\n  " + all_[i];
    if (all_.size() > most) text += fmt::format("\n  and {} more", all_.size() - most);
    return text;
  }

 private:
  static std::string value(const Description& value) {
    constexpr std::size_t longest = 60;
    const std::string text = value.dump();
    return text.size() > longest ? text.substr(0, longest) + " …" : text;
  }

  void compare(const std::string& at, const Description& now, const Description& then) {
    if (now == then) return;
    if (now.is_object() && then.is_object()) return compare_objects(at, now, then);
    if (at == "/stages" && now.is_array() && then.is_array())
      if (const auto names = names_of(now), others = names_of(then); names && others)
        return compare_stages(now, *names, then, *others);
    if (now.is_array() && then.is_array() && now.size() == then.size()) {
      for (std::size_t i = 0; i < now.size(); ++i) compare(fmt::format("{}/{}", at, i), now[i], then[i]);
      return;
    }
    all_.push_back(fmt::format("{}: found {}, allowed {}", at, value(now), value(then)));
  }

  void compare_objects(const std::string& at, const Description& now, const Description& then) {
    for (const auto& [key, one] : now.items()) {
      const std::string pointer = at + '/' + pointer_token(key);
      if (then.contains(key)) compare(pointer, one, then.at(key));
      else all_.push_back(fmt::format("{}: found {}, which the run does not have", pointer, value(one)));
    }
    for (const auto& [key, one] : then.items())
      if (!now.contains(key))
        all_.push_back(fmt::format("{}/{}: missing; the run has {}", at, pointer_token(key), value(one)));
  }

  /// Stages with the same name are compared, wherever they are.
  void compare_stages(const Description& now, const std::vector<std::string>& names, const Description& then,
                      const std::vector<std::string>& others) {
    std::vector<std::string> shared;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string pointer = fmt::format("/stages/{}", i);
      const auto same = std::ranges::find(others, names[i]);
      if (same == others.end()) {
        all_.push_back(
            fmt::format("{}: the stage \"{}\" is new; the run has {}", pointer, names[i], quoted_list(others)));
        continue;
      }
      shared.push_back(names[i]);
      compare(pointer, now[i], then[static_cast<std::size_t>(same - others.begin())]);
    }
    std::vector<std::string> shared_then;
    for (const std::string& name : others) {
      if (std::ranges::find(names, name) != names.end()) shared_then.push_back(name);
      else all_.push_back(fmt::format("/stages: the stage \"{}\" of the run is missing", name));
    }
    if (shared != shared_then)
      all_.push_back(
          fmt::format("/stages: found the order {}, allowed {}", quoted_list(shared), quoted_list(shared_then)));
  }

  std::vector<std::string> all_;
};

std::string lines(const Description& now, const Description& then) { return Differences(now, then).text(); }

}  // namespace

Description checkpoint_facts(const RunFacts& facts) {
  Description all{{"grit", grit_facts()}, {"plugins", Description::object()}, {"description", facts.description}};
  for (const auto& used : facts.plugins) all["plugins"][used.kind + " " + used.name] = build_of(used);
  return as_written(all);
}

std::string differences(const Description& now, const Description& then) {
  const auto without = [](Description description) {
    if (const auto output = description.find("output"); output != description.end() && output->is_object())
      output->erase("checkpoint_every");
    if (const auto stages = description.find("stages"); stages != description.end() && stages->is_array())
      for (Description& stage : *stages)
        if (stage.is_object()) stage.erase("typical_time");
    return description;
  };
  return lines(without(as_written(now)), without(as_written(then)));
}

namespace {

Description travel_of(const Description& description) {
  const Description::json_pointer pointer("/guards/travel");
  return description.contains(pointer) ? description.at(pointer) : Description();
}

/// Whether the travel guard sets the time step: above its default, without a maximum displacement.
bool sets_time_step(const Description& description) {
  const Description travel = travel_of(description);
  return travel.is_number() && travel.get<double>() > GuardsDescription().travel &&
         !description.contains(Description::json_pointer("/time_step/max_displacement"));
}

}  // namespace

std::string differences_on_the_way(const Description& now, const Description& then) {
  const bool both_only_stop = !sets_time_step(now) && !sets_time_step(then);
  const auto without = [&](Description description) {
    const auto guards = description.find("guards");
    if (guards == description.end() || !guards->is_object()) return description;
    guards->erase("overlap"), guards->erase("energy");
    if (both_only_stop) guards->erase("travel");
    return description;
  };
  const std::string other = differences(without(now), without(then));
  if (both_only_stop || travel_of(now) == travel_of(then)) return other;
  return other + fmt::format(
                     "\n  above {}, /guards/travel also sets the time step, unless there is a "
                     "/time_step/max_displacement",
                     GuardsDescription().travel);
}

bool can_go_on_with(const Description& description, const std::string& guard, double limit) {
  const Description::json_pointer pointer("/guards/" + guard);
  const auto sets_it = [&](const Description& stage) {
    const auto ramps = stage.value("ramps", Description::array());
    return stage.value("change", Description::object()).contains(pointer) ||
           std::ranges::any_of(ramps,
                               [&](const auto& ramp) { return ramp.value("pointer", "") == pointer.to_string(); });
  };
  if (std::ranges::any_of(description.value("stages", Description::array()), sets_it)) return false;
  Description other = description;
  other[pointer] = limit;
  return differences_on_the_way(other, description).empty();
}

std::string advice_on_stages(const Description& now, const Description& then, ResumedBy by) {
  const auto names = [](const Description& description) {
    const auto stages = description.find("stages");
    return stages == description.end() ? std::nullopt : names_of(*stages);
  };
  if (names(now) == names(then)) return "";
  const bool by_options = by == ResumedBy::command_line;
  return fmt::format(
      "\n  {} continues with the same stages; it cannot go on with other stages yet: run all of them from the start{}",
      by_options ? "--resume" : "resume()", by_options ? " in another folder (--out DIR)" : "");
}

bool has_checkpoint(const std::filesystem::path& folder) {
  std::error_code none;
  return std::filesystem::exists(checkpoint_path(folder), none) ||
         std::filesystem::exists(previous_checkpoint_path(folder), none);
}

void write_checkpoint(const std::filesystem::path& path, const RunFacts& facts, const StateToSave& state,
                      const std::filesystem::path& previous) {
  write_state(path, checkpoint_facts(facts), state, previous);
}

void check_facts(const std::string& checkpoint, const Description& then, const Description& now, ResumedBy by) {
  if (const auto other = lines(now.at("grit"), then.at("grit")); !other.empty())
    throw FileError(checkpoint + ": was written by another grit, so that results would not be bitwise identical:" +
                    other + advice(by));
  if (const auto other = differences_on_the_way(now.at("description"), then.at("description")); !other.empty())
    throw Error(checkpoint + ": is of another description:" + other +
                advice_on_stages(now.at("description"), then.at("description"), by) + advice(by));
  if (const auto other = lines(now.at("plugins"), then.at("plugins")); !other.empty())
    throw PluginError(checkpoint + ": was written with other builds of plugins:" + other + advice(by));
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const RunFacts& facts) {
  StateFile file;
  try {
    file = read_state(path);
  } catch (const FileError& error) {
    throw DamagedCheckpoint(error.what(),
                            "\n  it is not a complete checkpoint of this grit; start again (--overwrite)");
  }
  check_facts(path.string(), file.facts, checkpoint_facts(facts), ResumedBy::command_line);
  return std::move(file.checkpoint);
}

std::optional<LastCheckpoint> last_checkpoint(const std::filesystem::path& folder, const RunFacts& facts) {
  if (!has_checkpoint(folder)) return std::nullopt;
  const auto newest = checkpoint_path(folder), previous = previous_checkpoint_path(folder);
  std::string cause = newest.string() + ": is missing";
  if (std::filesystem::exists(newest)) try {
      return LastCheckpoint{read_checkpoint(newest, facts)};
    } catch (const DamagedCheckpoint& error) {
      if (!std::filesystem::exists(previous)) throw;
      cause = error.cause();
    }
  try {
    return LastCheckpoint{read_checkpoint(previous, facts),
                          cause + "; the run continues from the checkpoint before it, " + previous.string()};
  } catch (const DamagedCheckpoint& error) {
    throw DamagedCheckpoint(cause, std::string("\n") + error.what());
  }
}

}  // namespace grit
