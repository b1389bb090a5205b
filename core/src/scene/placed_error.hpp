// What shows to be wrong in a description once it is a scene.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "grit/error.hpp"

namespace grit {

/// Knows where in the description it stands, not in which file: `input` finds that.
class PlacedError : public Error {
 public:
  /// `keys` lead there from the root; what a stage changes them to may be what is wrong.
  PlacedError(std::vector<std::string> keys, const std::string& what) : Error(what), keys_(std::move(keys)) {}
  const std::vector<std::string>& keys() const { return keys_; }
  /// The stage that it shows in, counted from 0.
  std::size_t stage = 0;

 private:
  std::vector<std::string> keys_;
};

}  // namespace grit
