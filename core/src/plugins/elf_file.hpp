// Shared libraries as files, before they are opened.
#pragma once

#include <filesystem>
#include <string>

namespace grit {

/// Why an ELF file cannot be mapped into this process: it is shorter than its headers say, or of another machine. The
/// dynamic linker does not check the length, and ends the process. Empty if there is nothing, or if the file is no ELF
/// file, which the linker refuses.
std::string elf_fault(const std::filesystem::path& file);

}  // namespace grit
