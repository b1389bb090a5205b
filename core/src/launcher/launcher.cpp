// The command that is installed. It is compiled for any processor, and becomes the program of the best instruction set
// that is installed and that this processor has, or of the one that GRIT_ISA names.
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

/// Whether the processor has it, and the system keeps its registers. A build for one processor has no name to ask for.
/// Of each level those instructions are asked for that came last: there are compilers that do not know a level's name.
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

/// Every folder with a program in it, best first: builds for one processor, made on purpose, then the levels downwards.
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
  const std::string remedy = "\n  there are: " + listed(levels) + "; this processor has: " + listed(possible) +
                             "\n  set GRIT_ISA to one that it has, unset it for the best of them, or install another " +
                             "with scripts/package.sh";
  if (!wanted.empty() && std::ranges::find(levels, wanted) == levels.end())
    return refuse("GRIT_ISA=" + wanted + ": this instruction set is not installed in " + folder.string() + remedy,
                  wrong_instruction_set);
  if (!wanted.empty() && !runs_here(wanted))
    return refuse("GRIT_ISA=" + wanted + ": this processor lacks this instruction set" + remedy, wrong_instruction_set);
  if (possible.empty())
    return refuse("this processor has none of the instruction sets installed in " + folder.string() + remedy,
                  wrong_instruction_set);

  const auto program = folder / (wanted.empty() ? possible.front() : wanted) / "grit";
  ::execv(program.c_str(), arguments);
  return refuse(program.string() + ": cannot be run: " + std::strerror(errno), not_executable);
}
