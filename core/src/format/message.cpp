#include "format/message.hpp"

#include <filesystem>
#include <system_error>

namespace grit {

std::string message_of(const std::exception& error) {
  const auto* failure = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  if (failure == nullptr) return error.what();
  const std::string reason = failure->code().message(), all = failure->what();
  // "filesystem error: cannot create directories: Not a directory [a/b]"; some name a function in place of "cannot".
  const auto begin = all.find("cannot "), end = all.find(": " + reason);
  const std::string what = begin < end && end != all.npos ? all.substr(begin, end - begin) : "cannot examine it";
  const std::string where = failure->path1().empty() ? "" : failure->path1().string() + ": ";
  std::error_code gone;
  static_cast<void>(std::filesystem::current_path(gone));
  return where + what + ": " + reason +
         (gone ? "\n  the working folder was removed: change to one that exists"
               : "; remove the cause, or give another path");
}

}  // namespace grit
