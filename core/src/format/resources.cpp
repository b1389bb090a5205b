#include "format/resources.hpp"

#include <spdlog/fmt/fmt.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <system_error>

namespace grit {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number that a file begins with; infinite for another text, e.g. "max", or without the file.
double first_number(const std::filesystem::path& file) {
  double number = unlimited;
  if (!(std::ifstream(file) >> number)) return unlimited;
  return number;
}

/// The number of the line that begins with `name`; `otherwise` without one.
double number_after(const std::filesystem::path& file, const std::string& name, double otherwise) {
  std::ifstream text(file);
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string word;
    if (double number = 0; words >> word && word == name && words >> number) return number;
  }
  return otherwise;
}

double left_by_machine() {
  constexpr double kibibyte = 1024;
  return kibibyte * number_after("/proc/meminfo", "MemAvailable:", unlimited);
}

/// What a control group leaves. Pages of files that it can drop are not in use.
double left_by_group(const std::filesystem::path& folder, const char* limit, const char* used, const char* of_files) {
  const double most = first_number(folder / limit), now = first_number(folder / used);
  if (!(most < unlimited && now < unlimited)) return unlimited;
  return std::max(0.0, most - std::max(0.0, now - number_after(folder / "memory.stat", of_files, 0)));
}

/// What the control groups of this process leave, from its own up to the root.
double left_by_groups() {
  double least = unlimited;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    const bool unified = controllers == ",,";
    if (!unified && controllers.find(",memory,") == std::string::npos) continue;
    const std::filesystem::path root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    for (std::filesystem::path at = std::filesystem::path(line.substr(second + 1)).relative_path();;
         at = at.parent_path()) {
      least = std::min(least, unified ? left_by_group(root / at, "memory.max", "memory.current", "inactive_file")
                                      : left_by_group(root / at, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                                      "total_inactive_file"));
      if (at.empty()) break;
    }
  }
  return least;
}

double left_by_address_space() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double pages = first_number("/proc/self/statm");
  return std::max(0.0, static_cast<double>(limit.rlim_cur) -
                           (pages < unlimited ? pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) : 0));
}

}  // namespace

double available_memory() { return std::min({left_by_machine(), left_by_groups(), left_by_address_space()}); }

bool can_take(std::size_t bytes) {
  void* const taken = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return taken != MAP_FAILED && ::munmap(taken, bytes) == 0;
}

double peak_memory() {
  constexpr double kibibyte = 1024;
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return kibibyte * static_cast<double>(usage.ru_maxrss);
}

double available_disk(const std::filesystem::path& folder) {
  std::error_code error;
  auto at = std::filesystem::absolute(folder, error).lexically_normal();
  while (!std::filesystem::exists(at, error) && at.has_relative_path()) at = at.parent_path();
  const auto space = std::filesystem::space(at, error);
  return error ? unlimited : static_cast<double>(space.available);
}

std::string bytes_text(double bytes) {
  constexpr const char* units[] = {"bytes", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; bytes >= 999.5 && unit + 1 < std::size(units); ++unit) bytes /= 1000;
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

std::string out_of_memory() {
  return "out of memory: " + bytes_text(peak_memory()) + " were in use at most, and " + bytes_text(available_memory()) +
         " are available now; use fewer bodies, facets or averaging cells, or a machine with more memory";
}

}  // namespace grit
