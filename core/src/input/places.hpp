// Where in its files a description says something.
#pragma once

#include <cstddef>
#include <string>

#include "input/document.hpp"
#include "scene/placed_error.hpp"

namespace grit {

/// The pointer under which what stands at `pointer` in a stage, counted from 0, was written last: by that stage, by one
/// before it, or at the beginning.
inline std::string written_last(const Document& document, const std::string& pointer, std::size_t stage) {
  for (std::size_t k = stage + 1; k-- > 0;) {
    const std::string changed = "/stages/" + std::to_string(k) + "/change" + pointer;
    if (document.json().contains(Description::json_pointer(changed))) return changed;
  }
  return pointer;
}

/// Does the work, and tells of a PlacedError in which file and line it is: throws DescriptionError.
template <class Work>
auto at_its_place(const Document& document, const Work& work) {
  try {
    return work();
  } catch (const PlacedError& error) {
    std::string pointer;
    for (const std::string& key : error.keys()) pointer += '/' + pointer_token(key);
    throw DescriptionError({document.problem(written_last(document, pointer, error.stage), error.what())});
  }
}

}  // namespace grit
