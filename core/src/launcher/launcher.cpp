// The installed command. It is compiled for any processor and executes the program of the best installed instruction
// set that the processor supports, or of the one named by GRIT_ISA.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

enum ExitStatus { wrong_instruction_set = 2, not_executable = 5 };

/// Whether processor and system support a level. Other names are builds for a specific processor and cannot be tested.
/// Each level is tested by its newest instructions, as some compilers do not know the names of the levels.
bool runs_here(const std::string& level) {
#if defined(__x86_64__)
  const bool v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
  const bool v3 =
      v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  if (level == "x86-64-v4") return v4;
  if (level == "x86-64-v3") return v3;
  if (level == "x86-64-v2") return v2;
#endif
  return true;
}

/// Every folder with a program, best first: builds for a specific processor, then the levels in descending order.
std::vector<std::string> installed(const fs::path& folder) {
  std::vector<std::string> all;
  std::error_code error, none;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (fs::is_regular_file(entry->path() / "grit", none)) all.push_back(entry->path().filename().string());
  std::ranges::sort(all, std::greater());
  std::ranges::stable_partition(all, [](const auto& one) { return !one.starts_with("x86-64"); });
  return all;
}

std::string listed(const std::vector<std::string>& all) {
  std::string text;
  for (const auto& one : all) text += (text.empty() ? "" : ", ") + one;
  return all.empty() ? "none" : text;
}

int refuse(const std::string& text, ExitStatus status) {
  std::cerr << "grit: " << text << std::endl;
  return status;
}

}  // namespace

int main(int, char** arguments) {
  std::error_code error;
  const fs::path folder =
      (fs::read_symlink("/proc/self/exe", error).parent_path() / GRIT_INSTRUCTION_SETS).lexically_normal();
  const auto levels = installed(folder);
  std::vector<std::string> possible;
  std::ranges::copy_if(levels, std::back_inserter(possible), runs_here);

  const char* const variable = std::getenv("GRIT_ISA");
  const std::string wanted = variable == nullptr ? "" : variable;
  const std::string remedy = "\n  installed: " + listed(levels) + "; supported by this processor: " + listed(possible) +
                             "\n  set GRIT_ISA to a supported one, unset it to use the best, or install another with " +
                             "scripts/package.sh";
  if (!wanted.empty() && std::ranges::find(levels, wanted) == levels.end())
    return refuse("GRIT_ISA=" + wanted + ": this instruction set is not installed in " + folder.string() + remedy,
                  wrong_instruction_set);
  if (!wanted.empty() && !runs_here(wanted))
    return refuse("GRIT_ISA=" + wanted + ": this processor does not support this instruction set" + remedy,
                  wrong_instruction_set);
  if (possible.empty())
    return refuse("this processor supports none of the instruction sets installed in " + folder.string() + remedy,
                  wrong_instruction_set);

  const auto program = folder / (wanted.empty() ? possible.front() : wanted) / "grit";
  ::execv(program.c_str(), arguments);
  return refuse(program.string() + ": cannot be executed: " + std::strerror(errno), not_executable);
}
