#include "app/early_exit.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <span>
#include <string>

#include "format/resources.hpp"

namespace grit {
namespace {

std::atomic<bool> work_done{false};
std::terminate_handler by_default = std::abort;

/// The file whose code is at an address.
std::string file_of(const void* address) {
  Dl_info info{};
  return ::dladdr(address, &info) != 0 && info.dli_fname != nullptr ? info.dli_fname : "";
}

/// The file that called exit(): behind this program, whose handler runs, come the frames of the C library.
std::string caller() {
  std::array<void*, 32> frames{};
  const int count = ::backtrace(frames.data(), static_cast<int>(frames.size()));
  const std::string library = file_of(::dlsym(RTLD_DEFAULT, "exit"));
  bool in_exit = false;
  for (const void* frame : std::span(frames).first(static_cast<std::size_t>(count))) {
    const std::string file = file_of(frame);
    if (in_exit && file != library) return file;
    in_exit = in_exit || file == library;
  }
  return "a plugin or a library";
}

void on_early_exit() {
  if (work_done.load()) return;
  std::cout.flush();
  std::cerr << "grit: " << caller()
            << " called exit() before grit was done\n  fix the plugin, or choose another one; a run continues from its "
               "last checkpoint with 'grit run --resume'"
            << std::endl;
  ::_exit(static_cast<int>(ExitStatus::defect));
}

/// Where memory ends while the program is loaded, the C++ library has no reserve for std::bad_alloc itself, and ends
/// the program instead of throwing it.
[[noreturn]] void on_terminate() {
  constexpr std::size_t at_once = 1 << 21;  // malloc() takes up to 1 MB for the smallest object
  if (!std::current_exception() && !can_take(at_once)) {
    constexpr const char* text = "grit: out of memory as the program began; 'ulimit -v' prints its limit in kB\n";
    static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text)));
    ::_exit(static_cast<int>(ExitStatus::files));
  }
  by_default();
  std::abort();
}

}  // namespace

void refuse_early_exit() {
  by_default = std::set_terminate(on_terminate);
  std::atexit(on_early_exit);
  std::at_quick_exit(on_early_exit);
}

int finish(ExitStatus status) {
  work_done.store(true);
  return static_cast<int>(status);
}

}  // namespace grit
