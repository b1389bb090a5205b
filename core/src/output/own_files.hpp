// Which files of a folder grit may replace or remove: those that it wrote.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "grit/description.hpp"

namespace grit {

/// In pages and pictures, so that they are known as written by grit.
inline constexpr const char* page_mark = "<meta name=\"generator\" content=\"grit\">";
inline constexpr const char* picture_mark = "<!-- drawn by grit -->";

/// Whether a folder holds a run: a run.json that grit wrote or, if that was lost, a state.
bool holds_a_run(const std::filesystem::path& folder);

/// Throws FileError if a run in this folder would replace or remove a file that no run wrote, or an edited description.
void refuse_foreign_files(const std::filesystem::path& folder);

/// Throws FileError if a run in this folder would replace or remove one of these files.
void refuse_inputs(const std::filesystem::path& folder, const std::set<std::filesystem::path>& inputs);

/// Paths in a resolved description.
std::set<std::filesystem::path> paths_in(const Description& description);

/// Removes the results of a run, with its pictures, except run.json and description.json, which are replaced. To be
/// called after refuse_foreign_files(). Throws FileError.
void remove_results(const std::filesystem::path& folder);

/// Removes a run with all that it wrote, and its folder if nothing else is in it. To be called after
/// refuse_foreign_files(). Throws FileError.
void remove_run(const std::filesystem::path& folder);

/// Whether an entry of frames/ is a file of a run, by its name and how it begins.
bool is_own_frame(const std::filesystem::path& path);

/// Throws FileError if something of this name exists that is neither an empty file nor one that `is_own`.
void refuse_foreign_file(const std::filesystem::path& path,
                         const std::function<bool(const std::filesystem::path&)>& is_own);

/// Throws FileError if a page or picture exists that grit did not write, with what can be done. A PNG file is its own
/// if the SVG file is.
void refuse_foreign_page(const std::filesystem::path& path,
                         const std::string& remedy = "move it away, or choose another one (--out)");

}  // namespace grit
