#include "storage/state_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <span>
#include <string>

#include "grit/error.hpp"
#include "storage/atomic_file.hpp"
#include "storage/hdf5.hpp"
#include "storage/parsed_json.hpp"
#include "storage/seal.hpp"

namespace grit {
namespace {

/// Version of the layout of the file. Parts of the state have their own, see Archive::part().
constexpr std::uint64_t format = 5;

}  // namespace

void write_state(const std::filesystem::path& path, const StateFile& state, const std::filesystem::path& previous,
                 const std::filesystem::path& temporary) {
  const auto part = temporary.empty() ? temporary_path(path) : temporary;
  try {
    hdf5::File file(part, hdf5::Mode::write_whole);
    file.set_attribute("format", format);
    file.set_attribute("stage", state.checkpoint.stage);
    file.set_attribute("time", state.checkpoint.time);
    file.set_attribute("step", state.checkpoint.step);
    // JSON has neither infinite numbers nor texts that are not UTF-8.
    const std::string facts = state.facts.dump(-1, ' ', false, Description::error_handler_t::replace);
    file.write("facts", std::as_bytes(std::span(facts)));
    file.write("state", state.checkpoint.state);
    file.close();
    seal(part);
  } catch (const FileError&) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);  // incomplete, e.g. because the disk is full
    throw;
  }
  std::error_code error;
  if (!previous.empty() && std::filesystem::exists(path, error)) std::filesystem::rename(path, previous, error);
  if (error) throw FileError(path.string() + ": cannot rename it to " + previous.string() + ": " + error.message());
  publish(part, path);
  sync_folder(path.parent_path());
}

StateFile read_state(const std::filesystem::path& path) {
  const bool sealed = is_sealed(path);
  const hdf5::File file(path, hdf5::Mode::read_whole);
  if (!sealed) throw FileError(path.string() + ": is not complete: it lacks the checksum at its end");
  if (const auto found = file.number<std::uint64_t>("format"); found != format)
    throw FileError(fmt::format("{}: found format {}, allowed {}", path.string(), found, format));
  StateFile state;
  state.checkpoint = {file.text("stage"), file.number<double>("time"), file.number<std::uint64_t>("step"), {}};
  const auto text = file.dataset("facts").read_bytes();
  state.facts = parsed_json({reinterpret_cast<const char*>(text.data()), text.size()});
  if (state.facts.is_discarded()) throw FileError(path.string() + ": its facts are not JSON; the file is damaged");
  for (const char* key : {"grit", "plugins", "description"})
    if (!state.facts.is_object() || !state.facts.contains(key))
      throw FileError(path.string() + ": lacks \"" + key + '"');
  state.checkpoint.state = file.dataset("state").read_bytes();
  return state;
}

}  // namespace grit
