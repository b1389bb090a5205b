#include "output/checkpoint.hpp"

#include <spdlog/fmt/fmt.h>

#include "grit/error.hpp"
#include "output/atomic_file.hpp"
#include "output/hdf5.hpp"

namespace grit {
namespace {

/// Version of the layout of the file and of the state.
constexpr std::uint64_t format = 2;
constexpr const char* advice =
    "resume with the original program, plugins and description, or start again (--overwrite)";

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

Description facts_of(const RunFacts& facts) {
  Description all{{"grit", grit_facts()}, {"plugins", Description::object()}, {"description", facts.description}};
  for (const auto& used : facts.plugins) all["plugins"][used.kind + " " + used.name] = build_of(used);
  return as_written(all);
}

/// The differences, one line each, up to a maximum.
std::string lines(const Description& now, const Description& then) {
  constexpr std::size_t most = 8, longest = 60;
  std::string text;
  std::size_t count = 0;
  for (const auto& change : Description::diff(then, now)) {
    if (++count > most) continue;
    const std::string pointer = change.at("path");
    const Description::json_pointer at(pointer);
    const auto value = [&](const Description& of) {
      const std::string text = of.contains(at) ? of.at(at).dump() : "nothing";
      return text.size() > longest ? text.substr(0, longest) + " …" : text;
    };
    text += fmt::format("\n  {}: found {}, allowed {}", pointer, value(now), value(then));
  }
  if (count > most) text += fmt::format("\n  and {} more", count - most);
  return text;
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

}  // namespace

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

std::string differences_on_the_way(const Description& now, const Description& then) {
  const auto without = [](Description description) {
    if (const auto guards = description.find("guards"); guards != description.end() && guards->is_object())
      for (const char* of_the_end : {"travel", "energy"}) guards->erase(of_the_end);
    return description;
  };
  return differences(without(now), without(then));
}

void write_checkpoint(const std::filesystem::path& path, const RunFacts& facts, const Checkpoint& checkpoint) {
  const auto part = temporary_path(path);
  try {
    hdf5::File file(part, hdf5::Mode::replace);
    file.set_attribute("format", format);
    file.set_attribute("stage", checkpoint.stage);
    file.set_attribute("time", checkpoint.time);
    file.set_attribute("step", checkpoint.step);
    file.write_checked("facts", bytes_of(text_of(facts_of(facts))));
    file.write_checked("state", checkpoint.state);
    file.close();
    sync_to_disk(part);
  } catch (const FileError&) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);  // incomplete, e.g. because the disk is full
    throw;
  }
  publish(path);
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const RunFacts& facts) {
  Checkpoint checkpoint;
  Description then;
  try {
    const hdf5::File file(path, hdf5::Mode::read);
    if (const auto found = file.number<std::uint64_t>("format"); found != format)
      throw FileError(fmt::format("{}: found format {}, allowed {}", path.string(), found, format));
    checkpoint = {file.text("stage"), file.number<double>("time"), file.number<std::uint64_t>("step"), {}};
    const auto text = file.dataset("facts").read_bytes();
    then = Description::parse(reinterpret_cast<const char*>(text.data()),
                              reinterpret_cast<const char*>(text.data()) + text.size());
    for (const char* key : {"grit", "plugins", "description"})
      if (!then.contains(key)) throw FileError(path.string() + ": lacks \"" + key + '"');
    checkpoint.state = file.dataset("state").read_bytes();
  } catch (const FileError& error) {
    throw FileError(std::string(error.what()) +
                    "\n  it is not a complete checkpoint of this grit; start again (--overwrite)");
  } catch (const Description::exception&) {
    throw FileError(path.string() + ": its facts are not JSON\n  the file is damaged; start again (--overwrite)");
  }
  const Description now = facts_of(facts);
  if (const auto other = lines(now.at("grit"), then.at("grit")); !other.empty())
    throw FileError(path.string() + ": was written by another grit, so that results would not be bitwise identical:" +
                    other + "\n  " + advice);
  if (const auto other = differences_on_the_way(now.at("description"), then.at("description")); !other.empty())
    throw Error(path.string() + ": is of another description:" + other + "\n  " + advice);
  if (const auto other = lines(now.at("plugins"), then.at("plugins")); !other.empty())
    throw PluginError(path.string() + ": was written with other builds of plugins:" + other + "\n  " + advice);
  return checkpoint;
}

}  // namespace grit
