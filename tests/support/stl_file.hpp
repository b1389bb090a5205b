// Meshes written to files for tests.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include "grit/vec.hpp"

namespace grit::test {

/// A file that lives as long as this object.
class StlFile {
 public:
  explicit StlFile(std::string_view bytes) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("grit-test-" + std::to_string(getpid()) + '-' + std::to_string(++count) + ".stl");
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  StlFile(const StlFile&) = delete;
  StlFile& operator=(const StlFile&) = delete;
  ~StlFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Three corners a facet, with the normals that they have, exact to the last bit.
inline std::string stl_text(std::span<const Vec3> corners) {
  std::ostringstream text;
  text.precision(17);
  text << "solid made\n";
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Vec3 normal = (corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]).normalized();
    text << "facet normal " << normal.transpose() << "\n outer loop\n";
    for (std::size_t k = i; k < i + 3; ++k) text << "  vertex " << corners[k].transpose() << '\n';
    text << " endloop\nendfacet\n";
  }
  return text.str() + "endsolid made\n";
}

/// The same in single precision, without normals.
inline std::string stl_binary(std::span<const Vec3> corners, std::string_view header = "") {
  std::string bytes(header);
  bytes.resize(80);
  const auto count = static_cast<std::uint32_t>(corners.size() / 3);
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  for (std::uint32_t i = 0; i < count; ++i) {
    float numbers[12] = {};
    for (std::uint32_t k = 0; k < 9; ++k) numbers[3 + k] = static_cast<float>(corners[3 * i + k / 3][k % 3]);
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace grit::test
