#include "app/rank_facts.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>

#include <array>
#include <boost/crc.hpp>
#include <cmath>

#include "output/own_files.hpp"
#include "output/plugins_used.hpp"
#include "plugins/build_facts.hpp"
#include "storage/file_checksum.hpp"

namespace grit {
namespace {

/// The functions of the C library depend on its version and, by their last bits, on the processor. All ranks evaluate
/// some of them, and must find the same.
std::string mathematics() {
  boost::crc_32_type sum;
  for (int k = 1; k < 1000; ++k) {
    const double x = 0.0137 * k;
    const std::array values{std::sin(x),  std::cos(x),         std::tan(x),      std::atan(x),
                            std::exp(x),  std::log(x),         std::cbrt(x),     std::sinh(x),
                            std::tanh(x), std::acos(0.07 * x), std::pow(x, 1.5), std::hypot(x, 1.0)};
    sum.process_bytes(values.data(), sizeof(values));
  }
  return fmt::format("version {} with functions of checksum {:08x}", ::gnu_get_libc_version(), sum.checksum());
}

std::string plugins(const RunJob& job) {
  std::string lines;
  for (const PluginUsed& one : plugins_used(*job.opened->scene.description, *job.opened->registry))
    lines += fmt::format("{}/{} {} for {}{}\n", one.kind, one.name, one.version, one.tag.instruction_set,
                         one.file.empty() ? "" : fmt::format(", checksum {:08x}", file_checksum(one.file)));
  return lines;
}

std::string files(const Description& description) {
  std::string lines;
  std::error_code error;
  for (const std::filesystem::path& path : paths_in(description))
    if (std::filesystem::is_regular_file(path, error))
      lines += fmt::format("{}, checksum {:08x}\n", path.string(), file_checksum(path));
  return lines;
}

}  // namespace

std::vector<RankFact> facts_to_agree_on(const RunJob& job) {
  const BuildFacts& build = build_facts();
  const Description description = resolved(*job.opened->scene.description);
  return {{"grit", fmt::format("{} {}, {}, {}", build.version, build.revision, build.compiler, build.instruction_set)},
          {"C library", mathematics()},
          {"plugins", plugins(job)},
          {"description", description.dump(1)},
          {"files", files(description)}};
}

}  // namespace grit
