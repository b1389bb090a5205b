// What the machine has left for this process.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace grit {

/// Memory that this process can still take without swapping [bytes]: what the machine has, and no more than its control
/// groups and its limit of address space leave. Infinite if nothing is known.
double available_memory();

/// Whether this process could take so much address space now: libraries in C may crash where it ends.
bool can_take(std::size_t bytes);

/// Most memory that this process has had so far [bytes].
double peak_memory();

/// Space on the disk of a folder that may not exist yet [bytes]. Infinite if it is not known.
double available_disk(const std::filesystem::path& folder);

/// "3.4 GB" of 3.4e9 bytes.
std::string bytes_text(double bytes);

/// A message after std::bad_alloc: what was used, what there is, and what to do.
std::string out_of_memory();

}  // namespace grit
