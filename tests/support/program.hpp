// Runs the built command as a user does, and keeps what it says.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/own_folder.hpp"

namespace grit {

/// What a program said and how it ended: its exit status, or minus the signal that killed it.
struct Outcome {
  int status = -1;
  std::string out, err;
};

/// A program while it runs, in a folder, standard input empty.
class Program {
 public:
  /// `out`: a file that takes standard output; "": it is kept.
  Program(const std::vector<std::string>& words, const std::filesystem::path& folder, const std::string& out = "") {
    if (::pipe(out_) != 0 || ::pipe(err_) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
      std::vector<char*> arguments;
      for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
      arguments.push_back(nullptr);
      const int input = ::open("/dev/null", O_RDONLY);
      const int output = out.empty() ? out_[1] : ::open(out.c_str(), O_WRONLY);
      if (::chdir(folder.c_str()) != 0 || input < 0 || output < 0) ::_exit(127);
      ::dup2(input, 0), ::dup2(output, 1), ::dup2(err_[1], 2);
      for (const int end : {out_[0], out_[1], err_[0], err_[1]}) ::close(end);
      ::execvp(arguments[0], arguments.data());
      ::_exit(127);
    }
    ::close(out_[1]), ::close(err_[1]);
  }
  Program(const Program&) = delete;
  ~Program() {
    if (pid_ > 0) ::kill(pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
    ::close(out_[0]), ::close(err_[0]);
  }

  /// Reads until standard error has this text. False if the program ended without it.
  bool wait_for(const std::string& text) {
    while (outcome_.err.find(text) == std::string::npos)
      if (!read()) return false;
    return true;
  }
  void interrupt(int signal = SIGINT) const { ::kill(pid_, signal); }
  Outcome finish() {
    while (read()) {
    }
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    outcome_.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return outcome_;
  }

 private:
  /// Takes what is there, waiting for it. False at the end of both.
  bool read() {
    pollfd ends[] = {{out_open_ ? out_[0] : -1, POLLIN, 0}, {err_open_ ? err_[0] : -1, POLLIN, 0}};
    if (!out_open_ && !err_open_) return false;
    ::poll(ends, 2, -1);
    const auto take = [](const pollfd& end, bool& open, std::string& text) {
      if (!open || (end.revents & (POLLIN | POLLHUP)) == 0) return;
      char buffer[4096];
      const auto count = ::read(end.fd, buffer, sizeof buffer);
      if (count <= 0) open = false;
      else text.append(buffer, static_cast<std::size_t>(count));
    };
    take(ends[0], out_open_, outcome_.out);
    take(ends[1], err_open_, outcome_.err);
    return true;
  }

  pid_t pid_ = -1;
  int out_[2] = {-1, -1}, err_[2] = {-1, -1};
  bool out_open_ = true, err_open_ = true;
  Outcome outcome_;
};

/// The built command with these words.
inline std::vector<std::string> grit_with(std::vector<std::string> words) {
  words.insert(words.begin(), GRIT_BINARY);
  return words;
}

inline Outcome grit_in(const std::filesystem::path& folder, std::vector<std::string> words,
                       const std::string& out = "") {
  return Program(grit_with(std::move(words)), folder, out).finish();
}

/// Waits until the only program that runs meets a condition. Fails if it ends first.
template <class Condition>
void wait_until(Condition holds, const std::string& what) {
  siginfo_t ended{};
  while (!holds() && ended.si_pid == 0) {
    ASSERT_EQ(::waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT), 0);
    std::this_thread::yield();
  }
  ASSERT_TRUE(holds()) << "the run has ended without " << what << "; does it still take long enough?";
}

/// Interrupts a run of grit when it has written a file.
inline void interrupt_after(Program& program, const std::filesystem::path& file, Outcome& outcome) {
  ASSERT_NO_FATAL_FAILURE(wait_until([&] { return std::filesystem::exists(file); }, file.filename().string()));
  program.interrupt();
  outcome = program.finish();
  ASSERT_EQ(outcome.status, 130) << outcome.err;
}

inline Outcome shell(const std::filesystem::path& folder, const std::string& script) {
  return Program({"bash", "-euo", "pipefail", "-c", script}, folder).finish();
}

}  // namespace grit
