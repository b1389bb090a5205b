// The page of a run, served by a separate process.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "app/page_server.hpp"
#include "output/folder_lock.hpp"

namespace grit {

/// Serves the page of a folder while the object lives. The server process only reads files and runs at lower priority
/// (nice). It can neither stop nor change the run, so that results do not depend on readers.
class Watch {
 public:
  /// To be called before any thread is started. The server does not hold the lock of the run: if the run is killed,
  /// another one may begin at once. Throws FileError if no process can be created.
  Watch(const Listener& listener, const std::filesystem::path& folder, const FolderLock& lock);
  /// Readers get the last state first, which may take some seconds.
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// Sends one line of progress; it is dropped if the server is busy or gone.
  void say(const std::string& line) const;

 private:
  pid_t process_ = -1;
  int control_ = -1;
};

}  // namespace grit
