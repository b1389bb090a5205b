// What fuzz targets share. A target reads one input; it ends a process that crashes, hangs, or throws anything but an
// error in words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "grit/error.hpp"
#include "support/own_folder.hpp"

/// Called by libFuzzer, or by replay.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace grit::fuzz {

inline std::string_view text_of_input(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The input as a file, for readers of files.
inline std::filesystem::path file_of_input(const std::string& name, const std::uint8_t* data, std::size_t size) {
  static const OwnFolder folder;
  const auto path = folder / name;
  {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  std::filesystem::last_write_time(path, {});  // readers wait until a file has rested
  return path;
}

/// Runs `act`, which may refuse its input in words.
template <class Act>
void allow_refusal(Act act) {
  try {
    act();
  } catch (const Error&) {
  }
}

}  // namespace grit::fuzz
