#include "output/own_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

#include "grit/error.hpp"
#include "grit/toolkit/text_file.hpp"
#include "output/checkpoint.hpp"
#include "output/frame_exports.hpp"
#include "output/read_results.hpp"
#include "storage/atomic_file.hpp"
#include "storage/frame_state.hpp"
#include "storage/hdf5.hpp"
#include "storage/parsed_json.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;

constexpr const char* how_to_keep = ": it would be lost; move it away, or choose another folder (--out DIR)";

// In the order in which they are removed: first those from which a run would be resumed.
constexpr std::array run_files{"checkpoint.h5", "checkpoint-previous.h5",
                               "final.h5",      "series.journal",
                               "series.h5",     "frames.xdmf",
                               "grains.pvd",    "walls.pvd",
                               "packing.txt",   "picture.svg",
                               "report.html"};
constexpr std::array rewritten_files{"run.json", "description.json"};
// Of `grit report --png`; a run does not write them.
constexpr std::array picture_names{"curves", "curves-overlaid", "grains", "layers", "force-chains", "linear-chains"};
constexpr std::array picture_beginnings{"profiles-", "directions-", "map-"};

/// The names in a folder of results that a run writes.
std::vector<std::string> names_of_a_run() {
  std::vector<std::string> all(run_files.begin(), run_files.end());
  all.insert(all.end(), rewritten_files.begin(), rewritten_files.end());
  for (std::size_t i = 0, files = all.size(); i < files; ++i) all.push_back(temporary_path(all[i]).string());
  return all;
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::symlink_status(path, none).type() == fs::file_type::regular;
}

bool is_there(const fs::path& path) {
  std::error_code fault;
  const auto type = fs::symlink_status(path, fault).type();
  if (type == fs::file_type::none)  // nothing is known of it
    throw FileError(path.string() + ": cannot examine it: " + fault.message() +
                    "; remove the cause, or give another path (--out)");
  return type != fs::file_type::not_found;
}

bool is_run_json(const std::optional<Description>& json) {
  return json && json->contains("grit") && json->at("grit").is_object() && json->contains("status") &&
         json->at("status").is_string();
}

/// Whether a file has this text near its beginning.
bool has_mark(const fs::path& path, std::string_view mark) {
  std::string head(4096, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head.find(mark) != std::string::npos;
}

/// There is nothing to lose: it is of a run, or a machine, that stopped while it was written.
bool is_empty_file(const fs::path& path) {
  std::error_code none;
  return is_file(path) && fs::file_size(path, none) == 0;
}

constexpr const char* hdf5_beginning = "\x89HDF\r\n\x1a\n";

/// As RunJson begins.
constexpr const char* run_json_beginning = "{\n  \"status\": \"running\",\n  \"message\": \"\"";

/// Whether a run was killed while it wrote its first file.
bool is_begun_run_json(const fs::path& path) {
  return path.filename() == temporary_path("run.json") && is_file(path) && has_mark(path, run_json_beginning);
}

bool is_state(const fs::path& path) {
  if (!is_file(path)) return false;
  try {
    const hdf5::File file(path, hdf5::Mode::read);  // not whole: earlier versions wrote no checksum
    return file.has_attribute("format") && file.has("facts") && file.has("state");
  } catch (const FileError&) {
    return false;
  }
}

// Of versions that wrote no marks.
constexpr const char* earlier_picture =
    "text{font-family:'Helvetica Neue',Helvetica,Arial,'Liberation Sans','DejaVu Sans'";
constexpr const char* earlier_page = "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src";

bool is_own_page(fs::path path) {
  if (path.extension() == ".png") path.replace_extension(".svg");
  if (!is_file(path)) return false;
  if (is_empty_file(path)) return true;
  if (path.extension() == ".svg") return has_mark(path, picture_mark) || has_mark(path, earlier_picture);
  return has_mark(path, page_mark) || has_mark(path, earlier_page);
}

[[noreturn]] void refuse(const fs::path& path, const char* why) {
  throw FileError(path.string() + ": " + why + how_to_keep);
}

constexpr const char* not_own = "grit did not write this file";

void refuse_foreign_frames(const fs::path& folder) {
  std::error_code none;
  if (!is_there(folder)) return;
  if (!fs::is_directory(folder, none)) refuse(folder, not_own);
  if (::access(folder.c_str(), W_OK | X_OK) != 0)  // before the other results are removed
    throw FileError(folder.string() + ": cannot change it: " + std::strerror(errno) +
                    "; allow it, or choose another folder (--out DIR)");
  for (const auto& path : entries(folder))
    if (!is_own_frame(path)) refuse(path, not_own);
}

/// Of a folder that holds a run.
void refuse_edited_description(const fs::path& folder) {
  const auto path = folder / "description.json";
  const auto run = read_run_json(folder);
  if (!is_file(path) || !run || !run->contains("description")) return;
  std::string fault;  // then it is another text
  if (parsed_json(read_bytes(path, fault)) != run->at("description"))
    refuse(path, "was changed since the run wrote it");
}

}  // namespace

bool is_own_frame(const fs::path& path) {
  if (!is_file(path)) return false;
  const std::string name = path.filename().string();
  const auto is_of = [&](const char* suffix, const char* beginning) {
    const std::string part = temporary_path(suffix).string();
    return frame_number(name, part.c_str()) ||
           (frame_number(name, suffix) && (is_empty_file(path) || has_mark(path, beginning)));
  };
  return is_of(".h5", hdf5_beginning) ||
         std::ranges::any_of(frame_exports(), [&](const FrameExport& one) { return is_of(one.suffix, one.beginning); });
}

bool holds_a_run(const fs::path& folder) {
  if (is_file(folder / "run.json") && is_run_json(read_run_json(folder))) return true;
  return is_state(checkpoint_path(folder)) || is_state(previous_checkpoint_path(folder)) ||
         is_state(folder / "final.h5");
}

void refuse_foreign_files(const fs::path& folder) {
  const bool has_run = holds_a_run(folder);
  for (const std::string& name : names_of_a_run())
    if (const auto path = folder / name;
        is_there(path) && !is_empty_file(path) && !is_begun_run_json(path) && !(has_run && is_file(path)))
      refuse(path, not_own);
  for (const char* page : {"picture.svg", "report.html"})
    if (is_there(folder / page) && !is_own_page(folder / page)) refuse(folder / page, not_own);
  refuse_foreign_frames(folder / "frames");
  if (!has_run) {
    if (const auto all = entries(folder / "frames"); !all.empty()) refuse(all.front(), not_own);
    return;
  }
  refuse_edited_description(folder);
}

void refuse_inputs(const fs::path& folder, const std::set<fs::path>& inputs) {
  const auto all = names_of_a_run();
  std::error_code none;
  for (const fs::path& input : inputs) {
    if (input.empty() || !fs::exists(input, none)) continue;
    const bool is_result =
        fs::equivalent(input, folder, none) ||
        fs::equivalent(fs::absolute(input, none).parent_path(), folder / "frames", none) ||
        std::ranges::any_of(all, [&](const auto& name) { return fs::equivalent(input, folder / name, none); });
    if (is_result) refuse(input, "this run reads it and would replace it");
  }
}

std::set<fs::path> paths_in(const Description& description) {
  std::set<fs::path> all;
  if (description.is_string())
    if (const fs::path path = description.get<std::string>(); path.is_absolute()) all.insert(path);
  if (description.is_structured())
    for (const Description& part : description) all.merge(paths_in(part));
  return all;
}

void remove_results(const fs::path& folder) {
  std::vector<fs::path> old;
  for (const char* name : run_files) {
    old.push_back(folder / name);
    old.push_back(temporary_path(folder / name));
  }
  for (const auto& path : entries(folder / "frames"))
    if (is_own_frame(path)) old.push_back(path);
  for (const auto& path : entries(folder)) {
    const std::string name = path.stem().string();
    const bool is_picture =
        std::ranges::find(picture_names, name) != picture_names.end() ||
        std::ranges::any_of(picture_beginnings, [&](const char* begin) { return name.starts_with(begin); });
    // The PNG file, known by its SVG file, comes before it.
    if (is_picture && (path.extension() == ".svg" || path.extension() == ".png") && is_own_page(path))
      old.push_back(path);
  }
  for (const auto& path : old) {
    std::error_code error;
    if (fs::remove(path, error); error) throw FileError(path.string() + ": cannot remove it: " + error.message());
  }
}

void remove_run(const fs::path& folder) {
  remove_results(folder);
  for (const auto& path : {folder / "run.json", folder / "description.json", folder / "frames", folder}) {
    std::error_code error;
    if (fs::remove(path, error); error && error != std::errc::directory_not_empty)
      throw FileError(path.string() + ": cannot remove it: " + error.message());
  }
}

void refuse_foreign_file(const fs::path& path, const std::function<bool(const fs::path&)>& is_own) {
  if (is_there(path) && !is_empty_file(path) && !(is_file(path) && is_own(path))) refuse(path, not_own);
}

void refuse_foreign_page(const fs::path& path, const std::string& remedy) {
  if (is_there(path) && !is_own_page(path))
    throw FileError(path.string() + ": grit did not write this file: it would be lost; " + remedy);
}

}  // namespace grit
