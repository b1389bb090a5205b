// Kinds of JSON files that commands take.
#pragma once

#include <filesystem>

#include "input/document.hpp"

namespace grit {

enum class FileKind { description, study, calibration };

/// Throws DescriptionError that names the right command if a file is of another kind, as far as its keys show.
void refuse_other_kinds(const Document& document, const std::filesystem::path& path, FileKind wanted);

}  // namespace grit
