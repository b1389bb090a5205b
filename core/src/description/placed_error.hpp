// Faults of a description that are found after it was read into a scene.
#pragma once

#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "grit/error.hpp"

namespace grit {

/// Holds the position in the description, not the file and line: `input` finds these.
class PlacedError : public Error {
 public:
  struct Fault {
    std::vector<std::string> keys;  ///< path from the root
    std::string message;
  };
  PlacedError(std::vector<std::string> keys, const std::string& what) : PlacedError({{std::move(keys), what}}) {}
  /// Needs at least one fault.
  explicit PlacedError(std::vector<Fault> faults) : Error(faults.front().message), faults_(std::move(faults)) {}
  const std::vector<Fault>& faults() const { return faults_; }
  /// Path of the first fault, the one that what() describes.
  const std::vector<std::string>& keys() const { return faults_.front().keys; }
  /// Number of stages that had begun; each may have changed the faulty value.
  std::size_t stages() const { return stages_; }
  void begun(std::size_t stages) { stages_ = stages; }

 private:
  std::vector<Fault> faults_;
  std::size_t stages_ = 0;
};

/// The faults of the component described at `keys`.
inline std::vector<PlacedError::Fault> placed(const ParameterError& error, const std::vector<std::string>& keys) {
  std::vector<PlacedError::Fault> all;
  for (const ParameterError::Fault& fault : error.faults()) {
    std::vector<std::string> path = keys;
    std::istringstream deeper(fault.key);
    for (std::string key; std::getline(deeper, key, '/');) path.push_back(key);
    all.push_back({std::move(path), fault.message()});
  }
  return all;
}

/// The message for a file that the description names and that cannot be read.
inline std::string missing_file_text(const FileError& error, const std::string& path) {
  std::error_code none;
  const bool exists = std::filesystem::exists(path, none);
  return error.what() + std::string(exists ? "" : "; allowed is the path of a file, relative to the description");
}

}  // namespace grit
