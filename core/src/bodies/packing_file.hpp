// Grains as plain text: one line "x y z radius" per grain, in m; "#" starts a comment. Other DEM codes read it, too.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// Centres [m], w: radius [m], in the order of the lines. Throws FileError as read_text() does. Throws
/// DescriptionError, with each line at fault, for lines without exactly four numbers, numbers that are not finite,
/// radii that are not positive, and for a file without grains.
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
