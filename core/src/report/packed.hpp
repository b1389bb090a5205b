// Numbers as text that a page carries and a browser takes apart by itself.
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

/// Every other byte of 16-bit numbers together, all low ones first: neighbours are alike then, and deflate better.
std::vector<std::byte> byte_planes(std::span<const std::uint16_t> numbers);

/// A number of [low, high] as 0 … 65535, the nearest; what is outside as the end, what is no number as 0. `low` where
/// the range is empty.
std::uint16_t quantised(double value, double low, double high);

/// The data elements of a page: <script type="application/octet-stream" id="data-0">…
class DataElements {
 public:
  /// For the same page later: what both have keeps its number, what is new gets one that no earlier page has used.
  DataElements next() const;
  /// Returns the number in the element's id.
  std::size_t add(std::span<const std::byte> bytes);
  template <class T>
  std::size_t add_numbers(std::span<const T> numbers) {
    return add(std::as_bytes(numbers));
  }
  /// Above all numbers so far, and above that of every earlier page.
  std::size_t end() const { return end_; }
  /// Texts by their numbers.
  const std::map<std::size_t, std::shared_ptr<const std::string>>& texts() const { return texts_; }
  std::string html() const;

 private:
  using Texts = std::map<std::size_t, std::shared_ptr<const std::string>>;
  Texts texts_, before_;
  std::unordered_map<std::string_view, std::size_t> known_;  ///< those before, by their texts
  std::size_t end_ = 0;
};

}  // namespace grit
