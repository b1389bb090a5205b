// Text formats in which codes write their packings.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bodies/packing_rows.hpp"
#include "description/description.hpp"

namespace grit {

/// The format of a text: "lammps-data", "lammps-dump", "yade", "xyz", "dem-engine", else "text". By its content, of xyz
/// also by its extension. Throws DescriptionError for compressed files and for formats that are recognised but not
/// read.
std::string recognised_format(std::string_view text, const std::filesystem::path& path);

/// The bodies of a text in a format, in the order of its lines. Throws DescriptionError with each line at fault, and if
/// there are no bodies.
std::vector<PackedBody> bodies_of_text(std::string_view text, const std::string& format, const FileSource& source);

}  // namespace grit
