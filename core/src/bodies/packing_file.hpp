// Files of bodies: those of other codes, and grit's own, with one line "x y z radius" per grain in m.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bodies/packing_rows.hpp"
#include "description/description.hpp"
#include "grit/vec.hpp"

namespace grit {

/// The bodies of a file, in the order of its lines. Throws FileError as read_text() does. Throws DescriptionError, with
/// each line at fault, for lines with other columns than expected, numbers that are not finite, radii that are not
/// positive, for files that end early, and for a file without bodies.
std::vector<PackedBody> read_bodies(const FileSource& source);

/// Their centres [m], w: radius [m].
std::vector<Row> read_packing(const std::filesystem::path& path);

/// Writes 17 significant digits, so that reading gives identical numbers. The file is replaced as a whole or not at
/// all. Each line of `comment` becomes a comment before the grains. Throws FileError.
void write_packing(const std::filesystem::path& path, std::size_t grains, const std::function<Row(std::size_t)>& grain,
                   const std::string& comment = "");
inline void write_packing(const std::filesystem::path& path, std::span<const Row> grains,
                          const std::string& comment = "") {
  write_packing(
      path, grains.size(), [=](std::size_t i) { return grains[i]; }, comment);
}

}  // namespace grit
