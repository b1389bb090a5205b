// The page of a run, served by a process of its own.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "app/page_server.hpp"

namespace grit {

/// Shows a folder while the object lives. The process that serves reads files and nothing else of the run, yields to it
/// (nice), and can neither stop nor change it: whether somebody looks makes no difference to results.
class Watch {
 public:
  /// Before there are threads. Throws FileError where no process can be made.
  Watch(const Listener& listener, const std::filesystem::path& folder);
  /// Readers get the last state first, which takes up to some seconds where there are any.
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// One line that says how far the run is; lost where nobody takes it.
  void say(const std::string& line) const;

 private:
  pid_t process_ = -1;
  int control_ = -1;
};

}  // namespace grit
