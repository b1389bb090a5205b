// Numbers as text in a page, which a browser decodes without libraries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace grit {

/// Bytes deflated (zlib's format, which DecompressionStream("deflate") takes) and in base64.
std::string packed(std::span<const std::byte> bytes);

/// Low bytes of all 16-bit numbers, then the high bytes: neighbouring bytes are similar and deflate better.
std::vector<std::byte> byte_planes(std::span<const std::uint16_t> numbers);

/// A number in [low, high] rounded to 0 … 65535; clamped outside, 0 for NaN or an empty range.
std::uint16_t quantised(double value, double low, double high);

/// The data elements of a page: <script type="application/octet-stream" id="data-0">…
class DataElements {
 public:
  /// For a later version of the page: common elements keep their number, new ones get a number never used before.
  DataElements next() const;
  /// Returns the number in the element's id.
  std::size_t add(std::span<const std::byte> bytes);
  template <class T>
  std::size_t add_numbers(std::span<const T> numbers) {
    return add(std::as_bytes(numbers));
  }
  /// Above all numbers so far, including earlier versions of the page.
  std::size_t end() const { return end_; }
  /// Texts by number.
  const std::map<std::size_t, std::shared_ptr<const std::string>>& texts() const { return texts_; }
  std::string html() const;

 private:
  using Texts = std::map<std::size_t, std::shared_ptr<const std::string>>;
  Texts texts_, before_;
  std::unordered_map<std::string_view, std::size_t> known_;  ///< earlier numbers, by text
  std::size_t end_ = 0;
};

}  // namespace grit
