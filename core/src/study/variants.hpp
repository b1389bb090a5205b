// Which runs a study asks for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/description.hpp"

namespace grit {

/// One combination of levels, in the order of the study's settings.
struct Variant {
  std::vector<std::size_t> levels;
  std::string name;  ///< what differs from the usual, e.g. "safety=0.4"; "usual"; "finest"
};

/// The usual, then what varies, the finest last; none twice.
std::vector<Variant> variants(const StudyDescription& study);

/// What `grit run --set` is given for one sample of a variant.
std::vector<std::string> sets_of(const StudyDescription& study, const Variant& variant, double seed);

/// Where its results go, below the study's own folder.
std::filesystem::path folder_of(const Variant& variant, double seed);

}  // namespace grit
