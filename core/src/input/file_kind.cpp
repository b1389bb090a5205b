#include "input/file_kind.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <string>

#include "grit/error.hpp"

namespace grit {
namespace {

struct KindText {
  const char *found, *allowed, *command;
};

const KindText& text_of(FileKind kind) {
  static constexpr std::array<KindText, 3> texts{
      {{"a description of a simulation", "a description", "'grit run {}' runs this one"},
       {"a study", "a study, which names a description in \"scene\" and varies it",
        "'grit study {}' runs a study; with --dry-run it lists the runs"},
       {"a calibration", "a calibration, which names a description in \"base\" and the parameters to find",
        "'grit calibrate {}' runs a calibration; with --dry-run it prints the number of runs"}}};
  return texts[static_cast<std::size_t>(kind)];
}

}  // namespace

void refuse_other_kinds(const Document& document, const std::filesystem::path& path, FileKind wanted) {
  const auto has = [&](const char* key) { return document.json().contains(key); };
  const auto refuse = [&](FileKind found, const std::string& key) {
    if (found == wanted) return;
    throw DescriptionError({document.problem(
        '/' + key, fmt::format("found {}; allowed is {}. {}", text_of(found).found, text_of(wanted).allowed,
                               fmt::format(fmt::runtime(text_of(found).command), path.string())))});
  };
  if (has("scene") && (has("settings") || has("metrics"))) return refuse(FileKind::study, "scene");
  if (has("base") && (has("parameters") || has("targets"))) return refuse(FileKind::calibration, "base");
  if (has("scene") || has("base")) return;
  for (const char* key : {"scenario", "contacts", "bodies", "stages"})
    if (has(key)) return refuse(FileKind::description, key);
}

}  // namespace grit
