// Folders of results written by tests, and data of pages, decoded independently of the page.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "grit/testing/fake_world.hpp"
#include "output/folder.hpp"
#include "output/results_folder.hpp"

namespace grit {

/// Three grains at two instants, two in contact with each other and one with a wall; a probe with three channels.
struct SmallRun {
  FakeWorld world;
  std::vector<double> ratio{0, 0.1 + 0.2, std::numeric_limits<double>::quiet_NaN(), -1e-310, 1.0 / 3};
  std::vector<WallShape> walls{{"floor", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
  ResultsOptions options;

  explicit SmallRun(const std::filesystem::path& folder) {
    world.add({0, 0, 1}, 0.5, {3, 4, 0});
    world.add({1, 0, 2}, 0.25);
    world.add({2, 1, 3}, 0.125);
    world.id = {7, 2, 5};  // not in the order of bodies
    world.rotation = {{0, 0.5, 0}, {0, -1, 0}, {0, 0, 0}};
    world.add_contact(0, 1, {1, 0, 1}, {4, 0, 4});
    world.add_contact(1, 2, {1, 1, 1}, {0.1, 0.1, 0.1});
    world.add_wall_contact(0, 0, {0, 0, -0.5}, {0, 0, -20});
    const Vec3 zero = Vec3::Zero();
    world.wall.push_back({"floor", zero, zero, zero, zero, zero, zero, 0, 0, zero, 0, false, {}});
    world.stage_name = "shear";
    options.folder = folder;
    options.title = "a small run";
    options.facts.description = {{"title", options.title}};
    options.walls = walls;
  }

  /// Writes all files.
  void write(const RunSummary& summary = {}) {
    const std::vector<ProbeGroup> probes{
        {"packing", {{"largest_overlap", "m", "largest overlap", {}}}},
        {"test", {{"stress_ratio", "1", "shear over normal", {}}, {"stress", "Pa", "mean stress", {3}}}}};
    ResultsFolder results(options);
    results.begin(world, probes);
    for (std::size_t i = 0; i < ratio.size(); ++i) {
      world.now = 0.25 * static_cast<double>(i), world.steps = i;
      const double stress[] = {ratio[i], 1e5, 2e5}, overlap[] = {0.01};
      const std::span<const double> test[] = {{&ratio[i], 1}, stress}, packing[] = {overlap};
      results.sample(0, world, packing);
      results.sample(1, world, test);
    }
    results.frame(world, {});
    world.position[0].x = 0.5, world.now = 2;
    world.wall[0].position = {0, 0, -0.25};
    results.frame(world, {});
    results.finish(world, summary);
  }
};

inline std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto first = text.find(from);
  if (first == std::string::npos) throw std::runtime_error("the page has no " + from);
  const auto begin = first + from.size();
  return text.substr(begin, text.find(to, begin) - begin);
}

/// The JSON of a page.
inline nlohmann::json json_of(const std::string& page) {
  return nlohmann::json::parse(between(page, "id=\"report\">", "</script>"));
}

/// Decodes base64 and zlib's format.
inline std::string unpacked(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string deflated;
  unsigned bits = 0, count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<unsigned>(letters.find(c)), count += 6;
    if (count >= 8) count -= 8, deflated += static_cast<char>(bits >> count & 0xff);
  }
  if (text.size() % 4 != 0) throw std::runtime_error("base64 without its end");
  std::string all;
  z_stream stream{};
  inflateInit(&stream);
  stream.next_in = reinterpret_cast<Bytef*>(deflated.data());
  stream.avail_in = static_cast<uInt>(deflated.size());
  int status = Z_OK;
  while (status == Z_OK) {
    char piece[4096];
    stream.next_out = reinterpret_cast<Bytef*>(piece), stream.avail_out = sizeof piece;
    status = inflate(&stream, Z_NO_FLUSH);
    all.append(piece, sizeof piece - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::runtime_error("data that cannot be inflated");
  return all;
}

inline std::string bytes_of(const std::string& page, std::size_t element) {
  return unpacked(between(page, "id=\"data-" + std::to_string(element) + "\">", "</script>"));
}

template <class T>
std::vector<T> numbers_of(const std::string& page, std::size_t element) {
  const std::string bytes = bytes_of(page, element);
  std::vector<T> numbers(bytes.size() / sizeof(T));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(T));
  return numbers;
}

/// 16-bit numbers from their low and high bytes.
inline std::vector<std::uint16_t> planes_of(const std::string& page, std::size_t element) {
  const std::string bytes = bytes_of(page, element);
  std::vector<std::uint16_t> numbers(bytes.size() / 2);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[i]) |
                                            static_cast<unsigned char>(bytes[numbers.size() + i]) << 8);
  return numbers;
}

}  // namespace grit
