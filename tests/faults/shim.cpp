// A library for LD_PRELOAD that lets system calls fail, clocks jump, or memory end. scripts/faults.py sets:
//   FAULTS_BELOW   an absolute path: only calls on files below it, or on itself, are counted and fail
//   FAULTS_FAIL    CALL:N:ERROR:once or CALL:N:ERROR:on. The N-th call of this kind fails with this errno, 1 for the
//                  first; with "on", so do later calls of all kinds that a full disk, a read-only or a broken one
//                  refuses. KILL, TERM or STOP: the process gets this signal before the call
//   FAULTS_CLOCK   SEED:CALLS. About every so many calls the time of day jumps by up to a day, forwards or backwards,
//                  and the monotonic clock by up to an hour, forwards
//   FAULTS_MEMORY  0: the first exception finds no memory, nor a reserve; all ends there, as in the C++ library
//   FAULTS_LOG     a file: gets a line when the first call fails, and the number of calls of each kind at the end
//
// Kinds of calls: write (also shortening a file, and closing a stream), fsync, rename, open (any), create (opening for
// writing, making folders), remove.
#include <cxxabi.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <stdio_ext.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <mutex>
#include <string>
#include <utility>

namespace {

enum Call { write_call, fsync_call, rename_call, open_call, create_call, remove_call, calls };
constexpr std::array<const char*, calls> names{"write", "fsync", "rename", "open", "create", "remove"};

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// NAME is the function of the C library that this one stands before.
#define REAL(NAME) static auto* const real = next<decltype(NAME)>(#NAME)

/// The settings, and what has been counted.
class Faults {
 public:
  Faults() {
    if (const char* text = std::getenv("FAULTS_BELOW")) below_ = text;
    if (const char* text = std::getenv("FAULTS_LOG")) log_ = text;
    if (const char* text = std::getenv("FAULTS_FAIL")) read_fail(text);
    if (const char* text = std::getenv("FAULTS_CLOCK"); text && std::sscanf(text, "%lu:%lu", &random_, &every_) != 2)
      refuse("FAULTS_CLOCK");
    if (const char* text = std::getenv("FAULTS_MEMORY")) has_memory_ = std::strcmp(text, "0") != 0;
  }
  /// The number of calls of each kind.
  void report() const {
    char line[256];
    int size = 0;
    for (std::size_t i = 0; i < calls; ++i)
      size += std::snprintf(line + size, sizeof line - static_cast<std::size_t>(size), "%s %lu\n", names[i],
                            counts_[i].load());
    log(line, size);
  }

  bool is_below(const char* path) const {
    if (below_.empty() || path == nullptr) return false;
    std::string whole;
    if (*path != '/') {
      char here[PATH_MAX];
      if (::getcwd(here, sizeof here) == nullptr) return false;
      whole = std::string(here) + '/' + path;
      path = whole.c_str();
    }
    const std::size_t size = below_.size();
    return std::strncmp(path, below_.c_str(), size) == 0 && (path[size] == 0 || path[size] == '/');
  }
  bool is_below(int file) const {
    if (below_.empty()) return false;
    char link[32], path[PATH_MAX];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t size = ::readlink(link, path, sizeof path - 1);
    if (size <= 0) return false;
    path[size] = 0;
    return is_below(path);
  }

  /// Counts a call. Whether it is to fail; errno is then set. `half` does half of it, if the process is killed in it.
  template <class Half>
  bool fails(Call call, Half half) {
    const std::uint64_t count = ++counts_[call];
    const bool first = call == call_ && count == number_;
    if (first) {
      failing_ = on_ && signal_ == 0;
      char line[64];
      log(line, std::snprintf(line, sizeof line, "failed %s %lu\n", names[call], count));
      if (signal_ == SIGKILL) half();
      if (signal_ != 0) ::kill(::getpid(), signal_);
    }
    if (signal_ != 0 || (!first && !(failing_ && refuses(call)))) return false;
    errno = error_;
    return true;
  }
  bool fails(Call call) {
    return fails(call, [] {});
  }

  bool has_memory() const { return has_memory_; }

  /// The jumps up to now [s] of a clock.
  double jumped(clockid_t clock) {
    if (every_ == 0 || (clock != CLOCK_REALTIME && clock != CLOCK_MONOTONIC)) return 0;
    const std::lock_guard lock(mutex_);
    if (++asked_ % every_ == 0) {
      real_ += 86400 * (2 * uniform() - 1);
      monotonic_ += 3600 * uniform();
    }
    return clock == CLOCK_REALTIME ? real_ : monotonic_;
  }

 private:
  [[noreturn]] static void refuse(const char* name) {
    std::fprintf(stderr, "faults: %s cannot be read\n", name);
    ::_exit(99);
  }
  void read_fail(const char* text) {
    char call[16], error[16], how[8];
    if (std::sscanf(text, "%15[a-z]:%lu:%15[A-Z]:%7[a-z]", call, &number_, error, how) != 4) refuse("FAULTS_FAIL");
    for (call_ = 0; call_ < calls && std::strcmp(call, names[call_]) != 0; ++call_) {
    }
    for (const auto& [name, value] : {std::pair{"ENOSPC", ENOSPC}, {"EROFS", EROFS}, {"EIO", EIO}})
      if (std::strcmp(error, name) == 0) error_ = value;
    for (const auto& [name, value] : {std::pair{"KILL", SIGKILL}, {"TERM", SIGTERM}, {"STOP", SIGSTOP}})
      if (std::strcmp(error, name) == 0) signal_ = value;
    on_ = std::strcmp(how, "on") == 0;
    if (call_ == calls || error_ + signal_ == 0 || (!on_ && std::strcmp(how, "once") != 0)) refuse("FAULTS_FAIL");
  }
  /// Whether such a disk refuses a call.
  bool refuses(Call call) const {
    if (error_ == EIO) return true;
    if (call == write_call || call == create_call) return true;
    return error_ == ENOSPC ? call == fsync_call : call == rename_call || call == remove_call;
  }
  /// Not by the functions of this file.
  void log(const char* line, int size) const {
    if (log_.empty()) return;
    const int file = static_cast<int>(
        ::syscall(SYS_openat, AT_FDCWD, log_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
    if (file < 0) return;
    ::syscall(SYS_write, file, line, static_cast<std::size_t>(size));
    ::close(file);
  }
  /// From 0 to 1, by Knuth's generator.
  double uniform() {
    random_ = random_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(random_ >> 11) * 0x1p-53;
  }

  std::string below_, log_;
  std::size_t call_ = calls;
  int error_ = 0, signal_ = 0;
  std::uint64_t number_ = 0;
  bool on_ = false, has_memory_ = true;
  std::array<std::atomic<std::uint64_t>, calls> counts_{};
  std::atomic<bool> failing_{false};
  std::mutex mutex_;
  std::uint64_t random_ = 0, every_ = 0, asked_ = 0;
  double real_ = 0, monotonic_ = 0;  // s
};

/// Never destroyed, as the destructors of others call the functions below.
Faults& faults() {
  static Faults& one = *new Faults;
  return one;
}

[[gnu::constructor]] void begin() { faults(); }  // before the first thread
[[gnu::destructor]] void end() { faults().report(); }

bool creates(int flags) { return (flags & O_ACCMODE) != O_RDONLY || (flags & (O_CREAT | O_TRUNC)) != 0; }

bool open_fails(const char* path, bool create) {
  return faults().is_below(path) && (faults().fails(open_call) || (create && faults().fails(create_call)));
}

template <class File>
bool call_fails(Call call, File file) {
  return faults().is_below(file) && faults().fails(call);
}

void add(timespec& time, double seconds) {
  const double whole = static_cast<double>(static_cast<std::int64_t>(seconds));
  time.tv_sec += static_cast<time_t>(whole);
  time.tv_nsec += static_cast<long>(1e9 * (seconds - whole));
  if (time.tv_nsec < 0) --time.tv_sec, time.tv_nsec += 1'000'000'000;
  if (time.tv_nsec >= 1'000'000'000) ++time.tv_sec, time.tv_nsec -= 1'000'000'000;
}

}  // namespace

// A function that takes a mode only if it creates a file.
#define OPEN(NAME)                                                          \
  int NAME(const char* path, int flags, ...) {                              \
    REAL(NAME);                                                             \
    std::va_list more;                                                      \
    va_start(more, flags);                                                  \
    const mode_t mode = va_arg(more, mode_t);                               \
    va_end(more);                                                           \
    return open_fails(path, creates(flags)) ? -1 : real(path, flags, mode); \
  }
#define OPEN_AT(NAME)                                                               \
  int NAME(int folder, const char* path, int flags, ...) {                          \
    REAL(NAME);                                                                     \
    std::va_list more;                                                              \
    va_start(more, flags);                                                          \
    const mode_t mode = va_arg(more, mode_t);                                       \
    va_end(more);                                                                   \
    return open_fails(path, creates(flags)) ? -1 : real(folder, path, flags, mode); \
  }
#define FOPEN(NAME)                                                        \
  FILE* NAME(const char* path, const char* mode) {                         \
    REAL(NAME);                                                            \
    const bool create = *mode != 'r' || std::strchr(mode, '+') != nullptr; \
    return open_fails(path, create) ? nullptr : real(path, mode);          \
  }

extern "C" {

OPEN(open)
OPEN(open64)
OPEN_AT(openat)
OPEN_AT(openat64)
FOPEN(fopen)
FOPEN(fopen64)

int mkdir(const char* path, mode_t mode) {
  REAL(mkdir);
  return call_fails(create_call, path) ? -1 : real(path, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
  REAL(write);
  const auto half = [&] { static_cast<void>(!real(file, bytes, size / 2)); };
  return faults().is_below(file) && faults().fails(write_call, half) ? -1 : real(file, bytes, size);
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  REAL(pwrite);
  const auto half = [&] { static_cast<void>(!real(file, bytes, size / 2, at)); };
  return faults().is_below(file) && faults().fails(write_call, half) ? -1 : real(file, bytes, size, at);
}
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  REAL(pwrite64);
  const auto half = [&] { static_cast<void>(!real(file, bytes, size / 2, at)); };
  return faults().is_below(file) && faults().fails(write_call, half) ? -1 : real(file, bytes, size, at);
}
ssize_t writev(int file, const iovec* pieces, int count) {
  REAL(writev);
  return call_fails(write_call, file) ? -1 : real(file, pieces, count);
}
int ftruncate(int file, off_t size) noexcept {
  REAL(ftruncate);
  return call_fails(write_call, file) ? -1 : real(file, size);
}
int ftruncate64(int file, off64_t size) noexcept {
  REAL(ftruncate64);
  return call_fails(write_call, file) ? -1 : real(file, size);
}
/// What the stream has not written yet is lost, as on a full disk.
int fclose(FILE* stream) {
  REAL(fclose);
  if (!__fwritable(stream) || !faults().is_below(::fileno(stream))) return real(stream);
  if (!faults().fails(write_call)) return real(stream);
  const int error = errno;
  __fpurge(stream);
  real(stream);
  errno = error;
  return EOF;
}

int fsync(int file) {
  REAL(fsync);
  return call_fails(fsync_call, file) ? -1 : real(file);
}
int fdatasync(int file) {
  REAL(fdatasync);
  return call_fails(fsync_call, file) ? -1 : real(file);
}
int syncfs(int file) noexcept {
  REAL(syncfs);
  return call_fails(fsync_call, file) ? -1 : real(file);
}

int rename(const char* from, const char* to) noexcept {
  REAL(rename);
  return call_fails(rename_call, to) ? -1 : real(from, to);
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  REAL(renameat);
  return call_fails(rename_call, to) ? -1 : real(from_folder, from, to_folder, to);
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  REAL(renameat2);
  return call_fails(rename_call, to) ? -1 : real(from_folder, from, to_folder, to, flags);
}

int unlink(const char* path) noexcept {
  REAL(unlink);
  return call_fails(remove_call, path) ? -1 : real(path);
}
int remove(const char* path) noexcept {
  REAL(remove);
  return call_fails(remove_call, path) ? -1 : real(path);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  REAL(clock_gettime);
  const int result = real(clock, time);
  if (const double by = result == 0 ? faults().jumped(clock) : 0; by != 0) add(*time, by);
  return result;
}
time_t time(time_t* out) noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}
int gettimeofday(timeval* __restrict out, void* __restrict zone) noexcept {
  REAL(gettimeofday);
  const int result = real(out, zone);
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  out->tv_sec = now.tv_sec, out->tv_usec = now.tv_nsec / 1000;
  return result;
}

}  // extern "C"

void* __cxxabiv1::__cxa_allocate_exception(std::size_t size) noexcept {
  static auto* const real = next<decltype(__cxa_allocate_exception)>("__cxa_allocate_exception");
  if (!faults().has_memory()) {
    constexpr rlimit none{0, 0};
    ::setrlimit(RLIMIT_AS, &none);
    std::terminate();
  }
  return real(size);
}
