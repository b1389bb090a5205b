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
  /// `keys` lead there from the root.
  PlacedError(std::vector<std::string> keys, const std::string& what) : Error(what), keys_(std::move(keys)) {}
  const std::vector<std::string>& keys() const { return keys_; }
  /// How many stages had begun, each of which may have changed what is wrong.
  std::size_t stages() const { return stages_; }
  void begun(std::size_t stages) { stages_ = stages; }

 private:
  std::vector<std::string> keys_;
  std::size_t stages_ = 0;
};

}  // namespace grit
