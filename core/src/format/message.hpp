// The message of any exception, for users.
#pragma once

#include <exception>
#include <string>

namespace grit {

/// what() of an error of grit; for one of std::filesystem the path, what could not be done, the system's reason, and
/// what to do.
std::string message_of(const std::exception& error);

}  // namespace grit
