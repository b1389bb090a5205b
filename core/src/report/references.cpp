#include "report/references.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "input/document.hpp"
#include "output/reference_curve.hpp"

namespace grit {
namespace {

/// Reads a file in the folder of results. Others are not read, as the folder may come from a stranger.
ReferencePoints read_inside(const std::filesystem::path& folder, const ReferenceCurve& curve) {
  std::error_code error;
  const auto file = std::filesystem::weakly_canonical(curve.file, error),
             inside = std::filesystem::weakly_canonical(folder / "run.json", error).parent_path();
  if (error || std::ranges::mismatch(inside, file).in1 != inside.end())
    throw FileError(curve.file + ": cannot be read, as it is not in " + folder.string() +
                    "; a report shows the curves that 'grit run' has kept in run.json, or files in the folder");
  return read_reference(curve);
}

}  // namespace

std::vector<Reference> references_of(RunResults& run) {
  std::vector<Reference> all;
  for (const auto& [name, json] : run.at("/description/output/references").items()) try {
      Reference reference{
          .name = spelled(name), .of = json.at("of"), .against = json.value("against", ""), .value = {}};
      if (json.contains("value") && json.at("value").is_number()) {
        reference.value = json.at("value").get<double>();
      } else {
        const Description& curve = json.at("curve");
        const Description& kept = run.at("/references/" + pointer_token(name));
        const ReferenceCurve written{curve.at("file"), curve.at("x"), curve.at("y")};
        ReferencePoints read = kept.is_object() ? kept_reference(kept) : read_inside(run.folder, written);
        reference.x = std::move(read.x), reference.y = std::move(read.y);
      }
      all.push_back(std::move(reference));
    } catch (const std::exception& error) {
      run.problems.push_back("reference " + name + ": " + error.what());
    }
  return all;
}

}  // namespace grit
