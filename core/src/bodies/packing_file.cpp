#include "bodies/packing_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

#include "bodies/packing_formats.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/text_file.hpp"

namespace grit {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int reason) {
  throw FileError(path.string() + ": " + what + ": " + (reason != 0 ? std::strerror(reason) : "input or output error"));
}

void append(std::string& text, double number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number, std::chars_format::scientific, 16).ptr;
  text.append(digits, end);
}

}  // namespace

std::vector<PackedBody> read_bodies(const FileSource& source) {
  const std::string text = read_text(source.path);
  std::string format = source.format;
  if (format == "auto") {
    const bool is_plain = source.header_lines > 0;
    format = is_plain ? "text" : recognised_format(text, source.path);
    if (!source.columns.empty() && format != "lammps-data") format = "text";
  }
  if (source.time_step >= 0 && format != "lammps-dump")
    PackingFaults(source.path)
        .raise(0, "is read as " + format + ", of which a time step cannot be chosen; remove time_step");
  return bodies_of_text(text, format, source);
}

std::vector<Row> read_packing(const std::filesystem::path& path) {
  FileSource source;
  source.path = path.string();
  std::vector<Row> grains;
  for (const PackedBody& body : read_bodies(source)) grains.push_back(body.sphere);
  return grains;
}

void write_packing(const std::filesystem::path& path, std::size_t grains, const std::function<Row(std::size_t)>& grain,
                   const std::string& comment) {
  const std::filesystem::path part = path.string() + ".part";
  errno = 0;
  std::ofstream file(part, std::ios::binary);
  if (!file) fail(part, "cannot write grains", errno);

  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += "# " + visible_text(line) + '\n';
  text += "# x y z radius, m\n";
  constexpr std::size_t piece = 1 << 20;
  for (std::size_t i = 0; i < grains; ++i) {
    const Row one = grain(i);
    append(text, one.x), text += ' ';
    append(text, one.y), text += ' ';
    append(text, one.z), text += ' ';
    append(text, one.w), text += '\n';
    if (text.size() >= piece) file.write(text.data(), static_cast<std::streamsize>(text.size())), text.clear();
  }
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  std::error_code error;
  if (!file) {
    const int reason = errno;
    std::filesystem::remove(part, error);
    fail(part, "cannot write grains", reason);
  }
  std::filesystem::rename(part, path, error);
  if (error) {
    const int reason = error.value();
    std::filesystem::remove(part, error);
    fail(path, "cannot write grains", reason);
  }
}

}  // namespace grit
