// Grains as SVG.
#pragma once

#include <filesystem>
#include <string>

#include "grit/world.hpp"

namespace grit::python {

/// The grains and bounded walls of a world under a title; `view` and `color` as for grain_view(). Throws Error for
/// others.
std::string picture_of(const std::string& title, const World& world, const std::string& view, const std::string& color);
/// The grains of the last frame in a folder of results. Throws FileError, and Error without a frame.
std::string picture_of(const std::filesystem::path& folder);

}  // namespace grit::python
