// Grains as plain text: "x y z radius" a line, SI, "#" starts a comment. Every peer reads and writes it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// Centres [m], w: radius [m], in the order of the lines. Throws FileError where the file cannot be read, and
/// DescriptionError, with each line at fault, where it does not hold grains: not four numbers a line, a number that is
/// not finite, a radius that is not positive, no grain at all.
std::vector<Row> read_packing(const std::filesystem::path& path);

/// Writes 17 significant digits, so that reading gives the same bits. The file appears whole or not at all. Each line
/// of `comment` becomes a comment before the grains. Throws FileError.
void write_packing(const std::filesystem::path& path, std::size_t grains, const std::function<Row(std::size_t)>& grain,
                   const std::string& comment = "");
inline void write_packing(const std::filesystem::path& path, std::span<const Row> grains,
                          const std::string& comment = "") {
  write_packing(
      path, grains.size(), [=](std::size_t i) { return grains[i]; }, comment);
}

}  // namespace grit
