// What lies beside the program, in its installation or its build folder.
#pragma once

#include <filesystem>
#include <initializer_list>

namespace grit {

/// The first of these that exists in a folder above the program's, the nearest folder first; "" if there is none.
std::filesystem::path beside_program(std::initializer_list<const char*> inner);
/// The folder that has the pages as docs/ and descriptions as sims/: of the installation, or of the source tree around
/// the build folder; "" if there is none, as without Debian's package grit-doc.
std::filesystem::path documentation();

}  // namespace grit
