#include "storage/state_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "grit/error.hpp"
#include "storage/atomic_file.hpp"
#include "storage/hdf5.hpp"
#include "storage/parsed_json.hpp"
#include "storage/seal.hpp"

namespace grit {
namespace {

/// Version of the layout of the file. Parts of the state have their own, see Archive::part().
constexpr std::uint64_t format = 6;

/// Writes a dataset in pieces, or at once if there is less than one.
void write_pieces(hdf5::File& file, const std::string& name, const std::function<void(Archive&)>& save) {
  std::optional<hdf5::Dataset> written;
  Archive archive([&](std::span<const std::byte> piece) {
    if (piece.size() < Archive::piece && !written) {
      written = file.write(name, piece);
    } else {
      if (!written) written = file.create_growing<std::uint8_t>(name, {}, Archive::piece, true);
      written->append(std::span(reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size()));
    }
  });
  save(archive);
  archive.flush();
  if (!written) file.write(name, {});
}

}  // namespace

Checkpoint saved(const StateToSave& state) {
  Archive archive;
  state.save(archive);
  return {state.stage, state.time, state.step, std::move(archive).bytes()};
}

void write_state(const std::filesystem::path& path, const Description& facts, const StateToSave& state,
                 const std::filesystem::path& previous, const std::filesystem::path& temporary) {
  const auto part = temporary.empty() ? temporary_path(path) : temporary;
  try {
    hdf5::File file(part, hdf5::Mode::write_whole);
    file.set_attribute("format", format);
    file.set_attribute("stage", state.stage);
    file.set_attribute("time", state.time);
    file.set_attribute("step", state.step);
    // JSON has neither infinite numbers nor texts that are not UTF-8.
    const std::string text = facts.dump(-1, ' ', false, Description::error_handler_t::replace);
    file.write("facts", std::as_bytes(std::span(text)));
    write_pieces(file, "state", state.save);
    file.close();
    seal(part);
  } catch (...) {
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
