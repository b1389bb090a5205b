// Where in its files a description says something.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "description/placed_error.hpp"
#include "input/document.hpp"

namespace grit {

/// Where what stands at one of the pointers was written last: by the changes of one of the first `stages` stages, by a
/// ramp of one, or at the beginning, and then at the first pointer.
std::string written_last(const Document& document, const std::vector<std::string>& pointers, std::size_t stages);

/// Does the work, and tells of a PlacedError in which file and line it is: throws DescriptionError.
template <class Work>
auto at_its_place(const Document& document, const Work& work) {
  try {
    return work();
  } catch (const PlacedError& error) {
    std::string pointer;
    for (const std::string& key : error.keys()) pointer += '/' + pointer_token(key);
    throw DescriptionError({document.problem(written_last(document, {pointer}, error.stages()), error.what())});
  }
}

}  // namespace grit
