#include "storage/state_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grit/error.hpp"
#include "storage/atomic_file.hpp"
#include "storage/hdf5.hpp"

namespace grit {
namespace {

/// Version of the layout of the file and of the state.
constexpr std::uint64_t format = 4;

constexpr std::string_view seal_begin = "grit crc32 ";
constexpr std::size_t seal_bytes = seal_begin.size() + 8;

/// A mark and the checksum of the first bytes of a file, all but its seal.
std::string seal_of(std::ifstream& file, std::uintmax_t bytes) {
  std::vector<char> piece(std::size_t{1} << 20);
  boost::crc_32_type sum;
  while (bytes > 0) {
    const auto count = std::min<std::uintmax_t>(bytes, piece.size());
    if (!file.read(piece.data(), static_cast<std::streamsize>(count))) break;
    sum.process_bytes(piece.data(), static_cast<std::size_t>(count));
    bytes -= count;
  }
  return fmt::format("{}{:08x}", seal_begin, sum.checksum());
}

void seal(const std::filesystem::path& path) {
  std::ifstream whole(path, std::ios::binary);
  const std::string text = seal_of(whole, std::filesystem::file_size(path));
  std::ofstream file(path, std::ios::binary | std::ios::app);
  errno = 0;
  if (!whole || !file.write(text.data(), static_cast<std::streamsize>(text.size())).flush())
    throw FileError(path.string() + ": cannot write: " + std::strerror(errno));
}

/// Throws FileError for a file with another checksum. One without a seal was cut off, which HDF5 reports.
void check_seal(const std::filesystem::path& path) {
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  if (none || size < seal_bytes) return;
  std::ifstream file(path, std::ios::binary);
  std::string found(seal_bytes, '\0');
  file.seekg(static_cast<std::streamoff>(size - seal_bytes)).read(found.data(), seal_bytes);
  if (!file || !found.starts_with(seal_begin)) return;
  file.seekg(0);
  if (seal_of(file, size - seal_bytes) != found)
    throw FileError(path.string() + ": its checksum is not that of its content: the file is damaged");
}

}  // namespace

void write_state(const std::filesystem::path& path, const StateFile& state, const std::filesystem::path& previous) {
  const auto part = temporary_path(path);
  try {
    hdf5::File file(part, hdf5::Mode::replace);
    file.set_attribute("format", format);
    file.set_attribute("stage", state.checkpoint.stage);
    file.set_attribute("time", state.checkpoint.time);
    file.set_attribute("step", state.checkpoint.step);
    // JSON has neither infinite numbers nor texts that are not UTF-8.
    const std::string facts = state.facts.dump(-1, ' ', false, Description::error_handler_t::replace);
    file.write_checked("facts", std::as_bytes(std::span(facts)));
    file.write_checked("state", state.checkpoint.state);
    file.close();
    seal(part);
    sync_to_disk(part);
  } catch (const FileError&) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);  // incomplete, e.g. because the disk is full
    throw;
  }
  std::error_code error;
  if (!previous.empty() && std::filesystem::exists(path, error)) std::filesystem::rename(path, previous, error);
  if (error) throw FileError(path.string() + ": cannot rename it to " + previous.string() + ": " + error.message());
  publish(path);
  sync_folder(path.parent_path());
}

StateFile read_state(const std::filesystem::path& path) try {
  check_seal(path);
  const hdf5::File file(path, hdf5::Mode::read);
  if (const auto found = file.number<std::uint64_t>("format"); found != format)
    throw FileError(fmt::format("{}: found format {}, allowed {}", path.string(), found, format));
  StateFile state;
  state.checkpoint = {file.text("stage"), file.number<double>("time"), file.number<std::uint64_t>("step"), {}};
  const auto text = file.dataset("facts").read_bytes();
  state.facts = Description::parse(reinterpret_cast<const char*>(text.data()),
                                   reinterpret_cast<const char*>(text.data()) + text.size());
  for (const char* key : {"grit", "plugins", "description"})
    if (!state.facts.contains(key)) throw FileError(path.string() + ": lacks \"" + key + '"');
  state.checkpoint.state = file.dataset("state").read_bytes();
  return state;
} catch (const Description::exception&) {
  throw FileError(path.string() + ": its facts are not JSON; the file is damaged");
}

}  // namespace grit
