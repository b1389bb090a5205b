#include "camera.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <tuple>

#include "floats.hpp"

namespace grit {
namespace {

constexpr std::ptrdiff_t rays = 5;        // a pixel, along each axis; odd. Three double the error of displacements
constexpr std::ptrdiff_t band_rows = 10;  // of rays, drawn at a time: they stay in the cache
constexpr std::uint32_t tile = 512;       // samples of the pattern along each axis
constexpr float samples_per_pixel = 2;    // of the pattern
constexpr std::uint32_t finer = 2;        // than that is what rays see of it; its steps then vanish in their mean
constexpr std::uint32_t fine_tile = finer * tile;
constexpr double speckle_deviation = 1.2;  // of the Gauss bell that noise is smoothed with, pixels: speckles of four
constexpr float darkest = 0.35f, lightest = 0.65f;  // grains, at the face
constexpr float contrast = 0.12f;                   // standard deviation of the speckles
constexpr float most_contrast = 5 * contrast;       // what is told apart, in 127 steps

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

/// Where sample (i, j) of the fine pattern is kept, around and around: squares of 8 by 8 after each other, as what a
/// grain shows of it then is on few lines of the cache, whichever way it has turned.
template <class Index>
Index kept_at(const Index& i, const Index& j) {
  constexpr int squares = (int{fine_tile} - 1) & ~7;
  return (j & squares) * int{fine_tile} + ((i & squares) << 3) + ((j & 7) << 3) + (i & 7);
}

/// The pattern with samples between by linear interpolation, in parts of `most_contrast`.
std::vector<std::int8_t> refined(const std::vector<float>& pattern) {
  std::vector<std::int8_t> fine(fine_tile * fine_tile);
  for (std::uint32_t j = 0; j < fine_tile; ++j)
    for (std::uint32_t i = 0; i < fine_tile; ++i) {
      const std::uint32_t left = i / finer, low = j / finer, right = (left + 1) % tile, high = (low + 1) % tile;
      const float a = static_cast<float>(i % finer) / finer, b = static_cast<float>(j % finer) / finer;
      const float grey = (1 - b) * ((1 - a) * pattern[low * tile + left] + a * pattern[low * tile + right]) +
                         b * ((1 - a) * pattern[high * tile + left] + a * pattern[high * tile + right]);
      fine[kept_at(i, j)] = static_cast<std::int8_t>(std::lround(127 * std::clamp(grey / most_contrast, -1.0f, 1.0f)));
    }
  return fine;
}

std::vector<std::int8_t> speckled(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<float> pattern(tile * tile);
  // Twelve bits are as good as a bell once they are smoothed, and the same with every standard library.
  for (float& one : pattern) one = static_cast<float>(random() >> 52) - 2047.5f;
  smooth(pattern, 1, tile), smooth(pattern, tile, 1);
  double square = 0;
  for (const float one : pattern) square += one * one;
  const auto scale = static_cast<float>(contrast / std::sqrt(square / (tile * tile)));
  for (float& one : pattern) one *= scale;
  return refined(pattern);
}

}  // namespace

/// What a disc looks like; places in samples of the fine pattern.
struct Camera::Skin {
  float grey, cosine, sine, right, up;
};

Camera::Camera(std::uint64_t seed, double fade)
    : seed_(seed), fade_(static_cast<float>(fade)), speckles_(speckled(mixed(seed))) {}

Camera::Skin Camera::skin(const Disc& disc) const {
  const std::uint64_t drawn = mixed(mixed(seed_) + disc.id), more = mixed(drawn);
  const auto share = [](std::uint64_t bits) { return static_cast<double>(bits & 0xffffff) * 0x1p-24; };
  const double angle = disc.angle + 2 * std::numbers::pi * share(drawn);
  return {darkest + (lightest - darkest) * static_cast<float>(share(drawn >> 32)),
          finer * samples_per_pixel * static_cast<float>(std::cos(angle)),
          finer * samples_per_pixel * static_cast<float>(std::sin(angle)), static_cast<float>(fine_tile * share(more)),
          static_cast<float>(fine_tile * share(more >> 32))};
}

namespace {

constexpr auto lanes = static_cast<std::ptrdiff_t>(floats_at_once);

/// 0, 1, 2 …
Floats counted() {
  return Floats([](std::size_t k) { return k; });
}

Ints floor(const Floats& numbers) {
  const Ints whole = __builtin_convertvector(numbers.numbers, Ints);
  // All bits set are −1.
  return whole + (__builtin_convertvector(whole, Floats::Numbers) > numbers.numbers);
}

}  // namespace

/// The light of rays side by side that all meet one disc, the first of them at (x, y) from its centre. Whole registers
/// are read and written.
void Camera::shade(const Skin& skin, float x, float y, std::span<const float> depth, float* light) const {
  // The nearest sample; half a one on, so that what is cut off is the floor.
  const float u = skin.right + skin.cosine * x + skin.sine * y + 0.5f,
              v = skin.up - skin.sine * x + skin.cosine * y + 0.5f;
  const Floats right = skin.cosine / rays, up = -skin.sine / rays, fade = fade_;
  constexpr std::ptrdiff_t most = 64;
  // Of 64 bits, which loads take as they are: the compiler was seen to make them of fewer by more instructions than
  // that saves.
  using Places = detail::Register<std::int64_t, floats_at_once * sizeof(std::int64_t)>::type;
  std::array<std::int64_t, most> from;
  using Bytes = detail::Register<std::int8_t, floats_at_once>::type;
  std::array<std::int8_t, most> speckle{};
  const auto size = static_cast<std::ptrdiff_t>(depth.size());
  for (std::ptrdiff_t done = 0; done < size; done += most) {
    const std::ptrdiff_t count = std::min(most, size - done);
    for (std::ptrdiff_t k = 0; k < count; k += lanes) {
      const Floats along = counted() + static_cast<double>(done + k);
      const Ints at = kept_at(floor(multiply_add(right, along, Floats(u))), floor(multiply_add(up, along, Floats(v))));
      const Places wide = __builtin_convertvector(at, Places);
      std::memcpy(from.data() + k, &wide, sizeof wide);
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      speckle[k] = speckles_[static_cast<std::size_t>(from[k])];
    for (std::ptrdiff_t k = 0; k < count; k += lanes) {
      Bytes steps;
      std::memcpy(&steps, speckle.data() + k, sizeof steps);
      const Floats grey = multiply_add(Floats(most_contrast / 127),
                                       Floats(__builtin_convertvector(steps, Floats::Numbers)), Floats(skin.grey));
      store(grey * fade / (fade + max(Floats(0.0), load(depth.data() + done + k))), light + done + k);
    }
  }
}

namespace {

constexpr std::uint32_t nobody = ~0u;

// Rays of column or row k meet the picture at (k + ½) / rays − ½; those of the first and the last that meet a disc.
std::ptrdiff_t first_ray(double low, std::ptrdiff_t from) {
  return static_cast<std::ptrdiff_t>(std::max(std::ceil((low + 0.5) * rays - 0.5), static_cast<double>(from)));
}
std::ptrdiff_t last_ray(double high, std::ptrdiff_t end) {
  return static_cast<std::ptrdiff_t>(std::min(std::floor((high + 0.5) * rays - 0.5), static_cast<double>(end - 1)));
}
double place(std::ptrdiff_t ray) { return (static_cast<double>(ray) + 0.5) / rays - 0.5; }

/// What the rays of one row meet. Behind its last ray there is room for a register more.
struct RayRow {
  float* depth;        ///< infinite where nothing
  std::uint32_t* who;  ///< index of the disc, or nobody
};

/// Columns of rays that may meet a disc, from the first to the last.
struct RayColumns {
  std::ptrdiff_t first, last;
};

/// Whether all that the rays of these columns have met is in front of a disc.
bool is_hidden(const Disc& disc, const RayColumns& reach, const float* depth) {
  const Floats front = disc.depth - disc.radius;
  for (std::ptrdiff_t i = reach.first; i <= reach.last; i += lanes) {
    const auto in_sight = !(load(depth + i) < front) && counted() <= static_cast<double>(reach.last - i);
    if (detail::bits(in_sight) != 0) return false;
  }
  return true;
}

/// Where disc n is in front of what they have met so far.
void meet(const Disc& disc, std::uint32_t n, const RayColumns& reach, double y, std::ptrdiff_t columns,
          const RayRow& row) {
  if (is_hidden(disc, reach, row.depth)) return;
  const double dy = y - disc.y, square = disc.radius * disc.radius - dy * dy;
  if (!(square > 0)) return;
  const double half = std::sqrt(square);
  const std::ptrdiff_t left = first_ray(disc.x - half, 0), right = last_ray(disc.x + half, columns);
  const Floats depth = disc.depth, most = square, from = place(left) - disc.x;
  for (std::ptrdiff_t i = left; i <= right; i += lanes) {
    const Floats dx = multiply_add(counted() + static_cast<double>(i - left), Floats(1.0f / rays), from);
    const Floats surface = depth - sqrt(max(Floats(0.0), multiply_add(-dx, dx, most))), met = load(row.depth + i);
    const auto nearer = surface < met && counted() <= static_cast<double>(right - i);
    store(select(nearer, surface, met), row.depth + i);
    Ints who;
    std::memcpy(&who, row.who + i, sizeof who);
    who = nearer.bits ? static_cast<int>(n) - Ints{} : who;
    std::memcpy(row.who + i, &who, sizeof who);
  }
}

/// Where those end that meet the same as ray i does.
std::ptrdiff_t end_of_run(const std::uint32_t* who, std::ptrdiff_t i, std::ptrdiff_t end) {
  const Ints same = static_cast<int>(who[i]) - Ints{};
  for (; i < end; i += lanes) {
    Ints here;
    std::memcpy(&here, who + i, sizeof here);
    if (const std::uint32_t others = detail::bits(Floats::Mask{here != same}); others != 0)
      return std::min(end, i + std::countr_zero(others));
  }
  return end;
}

/// Light of rays to grey values of pixels. A pixel is lit by rays of its own and of its neighbours, by a tent: edges of
/// grains then move in grey values.
class Exposure {
 public:
  explicit Exposure(Image& image) : image_(image) {
    for (auto& row : rows_) row.assign(static_cast<std::size_t>(rays * image.width + 2 * wing), 0);
    for (std::ptrdiff_t k = 0; k < 2 * rays - 1; ++k)
      tent_[static_cast<std::size_t>(k)] =
          static_cast<float>(std::min(k + 1, 2 * rays - 1 - k)) / static_cast<float>(rays * rays);
  }
  /// Row j of rays, in rising order: the light of those from column `first` on; there is none elsewhere.
  void add(std::ptrdiff_t j, std::ptrdiff_t first, std::span<const float> light) {
    const std::ptrdiff_t middle = j / rays;
    for (const std::ptrdiff_t pixel : {middle - 1, middle, middle + 1}) {
      const std::ptrdiff_t k = j - rays * pixel + wing;  // of the tent
      if (pixel < 0 || pixel >= image_.height || k < 0 || k > 2 * (rays - 1)) continue;
      float* const sum = rows_[static_cast<std::size_t>(pixel % 3)].data() + wing + first;
      const float weight = tent_[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < light.size(); ++i) sum[i] += weight * light[i];
      if (k == 2 * (rays - 1) || j == rays * image_.height - 1) finish(pixel);
    }
  }

 private:
  static constexpr std::ptrdiff_t wing = (rays - 1) / 2;  // of the tent that is beyond the pixel

  void finish(std::ptrdiff_t pixel) {
    std::vector<float>& sum = rows_[static_cast<std::size_t>(pixel % 3)];
    float* const row = image_.row(pixel);
    for (std::ptrdiff_t i = 0; i < image_.width; ++i) {
      const float* const from = sum.data() + rays * i;
      float grey = 0;
      for (std::size_t k = 0; k < tent_.size(); ++k) grey += tent_[k] * from[k];
      row[i] = grey;
    }
    std::ranges::fill(sum, 0.0f);
  }

  Image& image_;
  std::array<float, 2 * rays - 1> tent_;
  std::array<std::vector<float>, 3> rows_;  ///< of pixel rows that are not finished, a number a ray
};

}  // namespace

Image Camera::picture(std::span<const Disc> discs, std::ptrdiff_t width, std::ptrdiff_t height) const {
  std::vector<Disc> near(discs.begin(), discs.end());
  std::ranges::sort(near, {}, [](const Disc& d) { return std::tuple(d.depth, d.id, d.x, d.y); });
  std::vector<Skin> skins;
  for (const Disc& disc : near) skins.push_back(skin(disc));

  const std::ptrdiff_t columns = rays * width, rows = rays * height, bands = (rows + band_rows - 1) / band_rows;
  std::vector<std::vector<std::uint32_t>> in_band(static_cast<std::size_t>(bands));
  for (std::size_t n = 0; n < near.size(); ++n) {
    const auto low = first_ray(near[n].y - near[n].radius, 0), high = last_ray(near[n].y + near[n].radius, rows);
    for (std::ptrdiff_t band = low / band_rows; low <= high && band <= high / band_rows; ++band)
      in_band[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(n));
  }

  // Around the specimen rays meet nothing: half of a picture.
  std::ptrdiff_t left = columns, right = 0;
  for (const Disc& disc : near) {
    left = std::min(left, first_ray(disc.x - disc.radius, 0));
    right = std::max(right, last_ray(disc.x + disc.radius, columns) + 1);
  }

  Image image(width, height);
  Exposure exposure(image);
  std::vector<float> depth(static_cast<std::size_t>(columns * band_rows + lanes)),
      light(static_cast<std::size_t>(columns + lanes));
  std::vector<float> deepest(light.size());  // of each column's rays in a band: most discs are behind that
  std::vector<std::uint32_t> who(depth.size());
  for (std::ptrdiff_t band = 0; band < bands; ++band) {
    const std::ptrdiff_t begin = band * band_rows, end = std::min(begin + band_rows, rows);
    if (in_band[static_cast<std::size_t>(band)].empty()) {
      for (std::ptrdiff_t j = begin; j < end; ++j) exposure.add(j, 0, {});
      continue;
    }
    for (std::ptrdiff_t row = 0; row < band_rows; ++row) {
      std::fill(depth.begin() + row * columns + left, depth.begin() + row * columns + right,
                std::numeric_limits<float>::infinity());
      std::fill(who.begin() + row * columns + left, who.begin() + row * columns + right, nobody);
    }
    std::fill(deepest.begin() + left, deepest.begin() + right, std::numeric_limits<float>::infinity());
    const auto row = [&](std::ptrdiff_t j) -> RayRow {
      return {depth.data() + (j - begin) * columns, who.data() + (j - begin) * columns};
    };
    for (const std::uint32_t n : in_band[static_cast<std::size_t>(band)]) {
      const Disc& disc = near[n];
      const RayColumns reach{first_ray(disc.x - disc.radius, 0), last_ray(disc.x + disc.radius, columns)};
      if (is_hidden(disc, reach, deepest.data())) continue;
      const auto low = first_ray(disc.y - disc.radius, begin), high = last_ray(disc.y + disc.radius, end);
      for (std::ptrdiff_t j = low; j <= high; ++j) meet(disc, n, reach, place(j), columns, row(j));
      for (std::ptrdiff_t i = reach.first; i <= reach.last; i += lanes) {
        Floats most = load(row(begin).depth + i);
        for (std::ptrdiff_t j = begin + 1; j < end; ++j) most = max(most, load(row(j).depth + i));
        store(most, deepest.data() + i);
      }
    }
    for (std::ptrdiff_t j = begin; j < end; ++j) {
      const RayRow met = row(j);
      for (std::ptrdiff_t i = left, after; i < right; i = after) {
        const std::uint32_t n = met.who[i];
        after = end_of_run(met.who, i, right);
        if (n == nobody) std::fill(light.begin() + i, light.begin() + after, 0.0f);
        else
          shade(skins[n], static_cast<float>(place(i) - near[n].x), static_cast<float>(place(j) - near[n].y),
                {met.depth + i, met.depth + after}, light.data() + i);
      }
      exposure.add(j, left,
                   std::span(light).subspan(static_cast<std::size_t>(left), static_cast<std::size_t>(right - left)));
    }
  }
  return image;
}

}  // namespace grit
