#include "camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <tuple>

namespace grit {
namespace {

constexpr std::ptrdiff_t rays = 5;         // a pixel, along each axis; odd. Three double the error of displacements
constexpr std::ptrdiff_t band_rows = 8;    // of pixels, drawn at a time
constexpr std::uint32_t tile = 512;        // samples of the pattern along each axis
constexpr float samples_per_pixel = 2;     // of the pattern
constexpr double speckle_deviation = 1.2;  // of the Gauss bell that noise is smoothed with, pixels: speckles of four
constexpr float darkest = 0.35f, lightest = 0.65f;  // grains, at the face
constexpr float contrast = 0.12f;                   // standard deviation of the speckles

/// Steele, Lea and Flood's mixer, doi:10.1145/2660193.2660195.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Of a periodic pattern, along one axis with `stride` between samples.
void smooth(std::vector<float>& pattern, std::uint32_t stride, std::uint32_t line_stride) {
  const double deviation = speckle_deviation * samples_per_pixel;
  const int reach = static_cast<int>(std::ceil(4 * deviation));
  std::vector<double> bell;
  for (int k = -reach; k <= reach; ++k) bell.push_back(std::exp(-0.5 * k * k / (deviation * deviation)));
  std::vector<float> before(tile);
  for (std::uint32_t line = 0; line < tile; ++line) {
    for (std::uint32_t i = 0; i < tile; ++i) before[i] = pattern[line * line_stride + i * stride];
    for (std::uint32_t i = 0; i < tile; ++i) {
      double sum = 0;
      for (int k = -reach; k <= reach; ++k)
        sum += bell[static_cast<std::size_t>(k + reach)] * before[(i + static_cast<std::uint32_t>(k)) % tile];
      pattern[line * line_stride + i * stride] = static_cast<float>(sum);
    }
  }
}

std::vector<float> speckled(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<float> pattern(tile * tile);
  // Twelve bits are as good as a bell once they are smoothed, and the same with every standard library.
  for (float& one : pattern) one = static_cast<float>(random() >> 52) - 2047.5f;
  smooth(pattern, 1, tile), smooth(pattern, tile, 1);
  double square = 0;
  for (const float one : pattern) square += one * one;
  const auto scale = static_cast<float>(contrast / std::sqrt(square / (tile * tile)));
  for (float& one : pattern) one *= scale;
  return pattern;
}

}  // namespace

/// What a disc looks like, in single precision.
struct Camera::Skin {
  float x, y, grey, cosine, sine, right, up;
};

Camera::Camera(std::uint64_t seed, double fade)
    : seed_(seed), fade_(static_cast<float>(fade)), speckles_(speckled(mixed(seed))) {}

Camera::Skin Camera::skin(const Disc& disc) const {
  const std::uint64_t drawn = mixed(mixed(seed_) + disc.id), more = mixed(drawn);
  const auto share = [](std::uint64_t bits) { return static_cast<double>(bits & 0xffffff) * 0x1p-24; };
  const double angle = disc.angle + 2 * std::numbers::pi * share(drawn);
  return {static_cast<float>(disc.x),
          static_cast<float>(disc.y),
          darkest + (lightest - darkest) * static_cast<float>(share(drawn >> 32)),
          samples_per_pixel * static_cast<float>(std::cos(angle)),
          samples_per_pixel * static_cast<float>(std::sin(angle)),
          static_cast<float>(tile * share(more)),
          static_cast<float>(tile * share(more >> 32))};
}

/// At a place relative to the centre of the disc.
float Camera::grey(const Skin& skin, float x, float y, float depth) const {
  // 64 tiles on, so that what is cut off is the floor.
  const float u = skin.right + skin.cosine * x + skin.sine * y + 64 * tile;
  const float v = skin.up - skin.sine * x + skin.cosine * y + 64 * tile;
  const auto i = static_cast<std::uint32_t>(u), j = static_cast<std::uint32_t>(v);
  const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
  const std::uint32_t left = i % tile, right = (i + 1) % tile, low = j % tile * tile, high = (j + 1) % tile * tile;
  const float lower = (1 - a) * speckles_[low + left] + a * speckles_[low + right];
  const float upper = (1 - a) * speckles_[high + left] + a * speckles_[high + right];
  return (skin.grey + (1 - b) * lower + b * upper) * fade_ / (fade_ + std::max(0.0f, depth));
}

Image Camera::picture(std::span<const Disc> discs, std::ptrdiff_t width, std::ptrdiff_t height) const {
  std::vector<Disc> near(discs.begin(), discs.end());
  std::ranges::sort(near, {}, [](const Disc& d) { return std::tuple(d.depth, d.id, d.x, d.y); });
  std::vector<Skin> skins;
  for (const Disc& disc : near) skins.push_back(skin(disc));

  // Rays of column or row k meet the picture at (k + ½) / rays − ½; those of the first and the last that meet a disc.
  const auto first = [](double low, std::ptrdiff_t from) {
    return static_cast<std::ptrdiff_t>(std::max(std::ceil((low + 0.5) * rays - 0.5), static_cast<double>(from)));
  };
  const auto last = [](double high, std::ptrdiff_t to) {
    return static_cast<std::ptrdiff_t>(std::min(std::floor((high + 0.5) * rays - 0.5), static_cast<double>(to - 1)));
  };
  const auto place = [](std::ptrdiff_t k) { return (static_cast<double>(k) + 0.5) / rays - 0.5; };

  const std::ptrdiff_t bands = (height + band_rows - 1) / band_rows;
  std::vector<std::vector<std::uint32_t>> in_band(static_cast<std::size_t>(bands));
  for (std::size_t n = 0; n < near.size(); ++n) {
    const auto low = first(near[n].y - near[n].radius, 0), high = last(near[n].y + near[n].radius, rays * height);
    for (std::ptrdiff_t band = low / (rays * band_rows); low <= high && band <= high / (rays * band_rows); ++band)
      in_band[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(n));
  }

  constexpr std::uint32_t nobody = ~0u;
  // A pixel is lit by rays of its own and of its neighbours, by a tent: edges of grains then move in grey values.
  constexpr std::ptrdiff_t wing = (rays - 1) / 2;  // of the tent that is beyond the pixel
  std::array<float, 2 * rays - 1> tent;
  for (std::ptrdiff_t k = 0; k < 2 * rays - 1; ++k)
    tent[static_cast<std::size_t>(k)] =
        static_cast<float>(std::min(k + 1, 2 * rays - 1 - k)) / static_cast<float>(rays * rays);
  Image image(width, height);
  const std::ptrdiff_t columns = rays * width;
  std::vector<float> depth(static_cast<std::size_t>(columns * rays * band_rows)),
      light(static_cast<std::size_t>(columns + 2 * wing)), reduced(static_cast<std::size_t>(width));
  std::vector<std::uint32_t> who(depth.size());
  for (std::ptrdiff_t band = 0; band < bands; ++band) {
    std::ranges::fill(depth, std::numeric_limits<float>::infinity());
    std::ranges::fill(who, nobody);
    const std::ptrdiff_t begin = rays * band * band_rows, end = std::min(begin + rays * band_rows, rays * height);
    for (const std::uint32_t n : in_band[static_cast<std::size_t>(band)]) {
      const Disc& disc = near[n];
      const auto low = first(disc.y - disc.radius, begin), high = last(disc.y + disc.radius, end);
      for (std::ptrdiff_t j = low; j <= high; ++j) {
        const double dy = place(j) - disc.y, square = disc.radius * disc.radius - dy * dy;
        if (!(square > 0)) continue;
        const double half = std::sqrt(square);
        const auto left = first(disc.x - half, 0), right = last(disc.x + half, columns);
        float* const depths = &depth[static_cast<std::size_t>((j - begin) * columns)];
        std::uint32_t* const whose = &who[static_cast<std::size_t>((j - begin) * columns)];
        for (std::ptrdiff_t i = left; i <= right; ++i) {
          const double dx = place(i) - disc.x;
          const auto surface = static_cast<float>(disc.depth - std::sqrt(std::max(0.0, square - dx * dx)));
          if (surface < depths[i]) depths[i] = surface, whose[i] = n;
        }
      }
    }
    for (std::ptrdiff_t j = begin; j < end; ++j) {
      const auto at = static_cast<std::size_t>((j - begin) * columns);
      const auto y = static_cast<float>(place(j));
      for (std::ptrdiff_t i = 0; i < columns; ++i) {
        const std::uint32_t n = who[at + static_cast<std::size_t>(i)];
        light[static_cast<std::size_t>(i + wing)] = n == nobody
                                                        ? 0
                                                        : grey(skins[n], static_cast<float>(place(i)) - skins[n].x,
                                                               y - skins[n].y, depth[at + static_cast<std::size_t>(i)]);
      }
      for (std::ptrdiff_t i = 0; i < width; ++i) {
        float sum = 0;
        for (std::size_t k = 0; k < tent.size(); ++k) sum += tent[k] * light[static_cast<std::size_t>(rays * i) + k];
        reduced[static_cast<std::size_t>(i)] = sum;
      }
      const std::ptrdiff_t middle = j / rays, off = j % rays;
      for (std::ptrdiff_t pixel = std::max<std::ptrdiff_t>(0, middle - 1); pixel <= std::min(height - 1, middle + 1);
           ++pixel) {
        const std::ptrdiff_t k = rays * (middle - pixel) + off + wing;  // of the tent
        if (k < 0 || k >= static_cast<std::ptrdiff_t>(tent.size())) continue;
        float* const row = image.row(pixel);
        for (std::ptrdiff_t i = 0; i < width; ++i)
          row[i] += tent[static_cast<std::size_t>(k)] * reduced[static_cast<std::size_t>(i)];
      }
    }
  }
  return image;
}

}  // namespace grit
