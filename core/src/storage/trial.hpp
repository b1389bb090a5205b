// Libraries that crash at damaged files.
#pragma once

#include <filesystem>
#include <functional>

namespace grit {

/// Runs `read`, which only reads a file, in a child process. Throws FileError if the child is killed by a signal or
/// uses more than `seconds` of processor time: the same would happen here. What `read` throws is ignored, as the caller
/// meets it, too.
void try_in_child(const std::filesystem::path& path, unsigned seconds, const std::function<void()>& read);

}  // namespace grit
