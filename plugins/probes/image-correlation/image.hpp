// Grey values on a grid of pixels. See README.md.
#pragma once

#include <cstddef>
#include <vector>

namespace grit {

/// Pixel (column, row) has its middle at (column, row); rows go upwards.
struct Image {
  std::ptrdiff_t width = 0, height = 0;
  std::vector<float> grey;  ///< row by row, 0 black

  Image() = default;
  Image(std::ptrdiff_t columns, std::ptrdiff_t rows)
      : width(columns), height(rows), grey(static_cast<std::size_t>(columns * rows)) {}
  float* row(std::ptrdiff_t j) { return grey.data() + j * width; }
  const float* row(std::ptrdiff_t j) const { return grey.data() + j * width; }
};

}  // namespace grit
