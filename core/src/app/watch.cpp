#include "app/watch.hpp"

#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "grit/error.hpp"

namespace grit {
namespace {

[[noreturn]] void serve(int listening_socket, int control, const std::filesystem::path& folder) {
  // Ctrl-C and a hangup reach all processes of a terminal, but this one must end after the run.
  for (const int signal : {SIGINT, SIGHUP}) std::signal(signal, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  try {
    static_cast<void>(::nice(5));
    const auto now = std::chrono::system_clock::now().time_since_epoch().count();
    LivePage page(folder, std::to_string(now));
    serve_page(::dup(listening_socket), control, page);
  } catch (const std::exception& error) {
    std::cerr << "grit: watch: " << error.what() << std::endl;
    std::_Exit(1);
  }
  std::_Exit(0);
}

}  // namespace

Watch::Watch(const Listener& listener, const std::filesystem::path& folder, const FolderLock& lock) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw FileError(std::string("cannot watch the run: ") + std::strerror(errno));
  std::cout.flush();
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[0]);
    lock.leave();
    serve(listener.socket(), ends[1], folder);
  }
  const int error = errno;
  ::close(ends[1]);
  control_ = ends[0];
  if (process_ < 0) {
    ::close(control_);
    throw FileError(std::string("cannot watch the run: ") + std::strerror(error));
  }
}

Watch::~Watch() {
  ::close(control_);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Watch::say(const std::string& line) const {
  const std::string text = line + '\n';
  // Neither waits for a busy server nor fails if it is gone.
  static_cast<void>(::send(control_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
}

}  // namespace grit
