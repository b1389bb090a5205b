// The runs of a study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/description.hpp"

namespace grit {

/// One combination of levels, in the order of the study's settings.
struct Variant {
  std::vector<std::size_t> levels;
  std::string name;  ///< the differences from the usual levels, e.g. "safety=0.4"; "usual"; "finest". All levels in a
                     ///< sweep that is crossed or of one setting
};

/// Without duplicates; in a study of accuracy the finest last. One at a time the usual is first, except in a sweep of
/// one setting, which has the order of its levels.
std::vector<Variant> variants(const StudyDescription& study);

/// The values of `grit run --set` for one sample of a variant.
std::vector<std::string> sets_of(const StudyDescription& study, const Variant& variant, double seed);

/// The folder of a sample's results, relative to that of the study.
std::filesystem::path folder_of(const Variant& variant, double seed);

}  // namespace grit
