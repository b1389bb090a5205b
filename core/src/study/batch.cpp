#include "study/batch.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <map>
#include <thread>
#include <utility>

#include "grit/error.hpp"

namespace grit {
namespace {

constexpr auto poll_interval = std::chrono::milliseconds(50);

pid_t start(const BatchJob& job) {
  std::vector<char*> words;
  for (const auto& word : job.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  std::filesystem::create_directories(job.log.parent_path());
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, job.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  // Programs such as scripts expect these signals to end them.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaddset(&usual, signal);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, words.front(), &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0)
    throw FileError(job.words.front() + " cannot be started, or " + job.log.string() +
                    " cannot be written: " + std::strerror(error));
  return pid;
}

}  // namespace

void run_batch(std::span<const BatchJob> jobs, std::size_t at_once, const std::atomic<bool>& interrupted,
               const BatchEvents& events) {
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  bool go_on = true, stopped = false;
  const auto stop_all = [&] {
    for (const auto& [pid, index] : running) ::kill(pid, SIGTERM);
  };
  try {
    while (true) {
      go_on = go_on && !interrupted.load();
      if (!go_on && !std::exchange(stopped, true)) stop_all();
      while (go_on && next < jobs.size() && running.size() < at_once) {
        running.emplace(start(jobs[next]), next);
        ++next;
      }
      if (running.empty()) return;
      int status = 0;
      const pid_t pid = ::waitpid(-1, &status, WNOHANG);
      if (const auto found = running.find(pid); found != running.end()) {
        const std::size_t index = found->second;
        running.erase(found);
        go_on = events.ended(index, WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status)) && go_on;
        continue;
      }
      events.waiting(running.size());
      std::this_thread::sleep_for(poll_interval);
    }
  } catch (...) {
    stop_all();
    for (const auto& [pid, index] : running) ::waitpid(pid, nullptr, 0);
    throw;
  }
}

}  // namespace grit
