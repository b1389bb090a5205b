#include "storage/trial.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "grit/error.hpp"

namespace grit {
namespace {

/// Writes to `done` if it gets so far. The parent then kills it, so that no destructor of the parent's objects runs
/// here.
[[noreturn]] void run_child(unsigned seconds, const std::function<void()>& read, int done) {
  // Handlers of the parent, such as those of sanitizers, would report a crash as one of grit.
  for (const int fatal : {SIGSEGV, SIGABRT, SIGBUS, SIGILL, SIGFPE, SIGXCPU}) std::signal(fatal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0}, time{seconds, seconds};
  ::setrlimit(RLIMIT_CORE, &none), ::setrlimit(RLIMIT_CPU, &time);
  if (const int silence = ::open("/dev/null", O_WRONLY); silence >= 0) ::dup2(silence, STDERR_FILENO);
  try {
    read();
  } catch (...) {
  }
  static_cast<void>(::write(done, "!", 1) == 1);
  for (;;) ::pause();
}

/// Whether a byte arrives before all writers are gone.
bool hears(int done) {
  char byte = 0;
  ssize_t count = 0;
  do count = ::read(done, &byte, 1);
  while (count < 0 && errno == EINTR);
  return count == 1;
}

}  // namespace

void try_in_child(const std::filesystem::path& path, unsigned seconds, const std::function<void()>& read) {
  int done[2];
  if (::pipe2(done, O_CLOEXEC) != 0) return;  // too many files: read without a trial
  const pid_t child = ::fork();
  if (child == 0) run_child(seconds, read, done[1]);
  ::close(done[1]);
  const bool survived = child < 0 || hears(done[0]);
  ::close(done[0]);
  if (child > 0) {
    ::kill(child, SIGKILL);
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  if (!survived) throw FileError(path.string() + ": is damaged: the HDF5 library crashes at it, or does not finish");
}

}  // namespace grit
