// Position in the input files of a part of the description.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "description/placed_error.hpp"
#include "input/document.hpp"

namespace grit {

/// Pointer to the last assignment of the values at `pointers`: in the changes or ramps of one of the first `stages`
/// stages, otherwise the first of `pointers`.
std::string written_last(const Document& document, const std::vector<std::string>& pointers, std::size_t stages);

/// Runs `work`. A PlacedError becomes a DescriptionError with file and line of each fault.
template <class Work>
auto at_its_place(const Document& document, const Work& work) {
  try {
    return work();
  } catch (const PlacedError& error) {
    std::vector<Problem> problems;
    for (const PlacedError::Fault& fault : error.faults()) {
      std::string pointer;
      for (const std::string& key : fault.keys) pointer += '/' + pointer_token(key);
      problems.push_back(document.problem(written_last(document, {pointer}, error.stages()), fault.message));
    }
    throw DescriptionError(std::move(problems));
  }
}

}  // namespace grit
