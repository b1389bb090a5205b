#include "report/packed.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "format/base64.hpp"

namespace grit {

std::string packed(std::span<const std::byte> bytes) {
  // Level 1: higher levels take three times as long and save a few percent.
  uLongf size = compressBound(bytes.size());
  std::vector<unsigned char> deflated(size);
  if (compress2(deflated.data(), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 1) != Z_OK)
    throw std::runtime_error("data of the page cannot be compressed");
  deflated.resize(size);
  return base64(std::move(deflated));
}

std::vector<std::byte> byte_planes(std::span<const std::uint16_t> numbers) {
  std::vector<std::byte> bytes(2 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    bytes[i] = static_cast<std::byte>(numbers[i] & 0xff);
    bytes[numbers.size() + i] = static_cast<std::byte>(numbers[i] >> 8);
  }
  return bytes;
}

std::uint16_t quantised(double value, double low, double high) {
  if (!(high > low) || std::isnan(value)) return 0;
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp((value - low) / (high - low), 0.0, 1.0)));
}

DataElements DataElements::next() const {
  DataElements later;
  later.before_ = texts_;
  for (const auto& [number, text] : later.before_) later.known_.emplace(*text, number);
  later.end_ = end_ + 1;
  return later;
}

std::size_t DataElements::add(std::span<const std::byte> bytes) {
  auto text = std::make_shared<const std::string>(packed(bytes));
  const auto same = known_.find(*text);
  const std::size_t number = same == known_.end() ? end_++ : same->second;
  texts_[number] = std::move(text);
  return number;
}

std::string DataElements::html() const {
  std::string html;
  for (const auto& [number, text] : texts_) {
    html += "<script type=\"application/octet-stream\" id=\"data-" + std::to_string(number) + "\">";
    html += *text;
    html += "</script>\n";
  }
  return html;
}

}  // namespace grit
