#include "correlation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <queue>
#include <tuple>
#include <utility>

#include "floats.hpp"

namespace grit {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double flat = 1e-8;     // variance of grey values below which a square has nothing to see
constexpr double settled = 1e-3;  // what a corner of a square still moves when it is found, pixels
constexpr int most_steps = 30;
// Steps that go on in one direction, each shorter than the last by one ratio, are taken to the end of their series
// (Aitken): below `straight` pixels, where the cosine of the angle between two of them is `aligned` at least. From 0.4
// pixel on that would save a quarter of the steps instead of a sixth, but settle squares of grains that have turned
// apart.
constexpr double straight = 0.02, aligned = 0.95, largest_ratio = 0.9;
// Whoever is to be beyond so many times `settled` after most_steps, at the rate of the last few, is given up; but what
// still wanders by so many pixels may be near its end all the same, for some steps.
constexpr double hopeless = 10, wandering = 0.1;
constexpr int rated = 5, first_rated = 10, first_rated_wandering = 18;
// Correlation grows by less than that from here on.
constexpr int first_compared = 4;
constexpr double most_growth = 0.1;

constexpr std::size_t width = floats_at_once;

double sum(const Floats& lanes) {
  double all = 0;
  for (std::size_t k = 0; k < width; ++k) all += lanes[k];
  return all;
}

/// From values of a line to weights of B-splines, a sixth of the usual ones, its ends mirrored. `several` lines at
/// once, whose values are next to each other; what follows on a value along its line is `stride` further.
void filter(float* lines, std::ptrdiff_t several, std::ptrdiff_t count, std::ptrdiff_t stride) {
  if (count < 2) return;
  const float pole = std::sqrt(3.0f) - 2;
  const std::ptrdiff_t reach = std::min<std::ptrdiff_t>(count, 16);  // |pole|^16 is round-off
  const auto each = [=](const auto& act) {
    for (std::ptrdiff_t n = 0; n < several; ++n) act(n);
  };
  const auto at = [=](std::ptrdiff_t i) { return lines + i * stride; };
  float power = 1;
  for (std::ptrdiff_t i = 1; i < reach; ++i) {
    power *= pole;
    each([=, to = at(0), from = at(i)](std::ptrdiff_t n) { to[n] += power * from[n]; });
  }
  for (std::ptrdiff_t i = 1; i < count; ++i)
    each([=, to = at(i), from = at(i - 1)](std::ptrdiff_t n) { to[n] += pole * from[n]; });
  each([=, to = at(count - 1), from = at(count - 2)](std::ptrdiff_t n) {
    to[n] = pole / (pole * pole - 1) * (pole * from[n] + to[n]);
  });
  for (std::ptrdiff_t i = count - 2; i >= 0; --i)
    each([=, to = at(i), from = at(i + 1)](std::ptrdiff_t n) { to[n] = pole * (from[n] - to[n]); });
}

Image spline_weights(Image image) {
  for (std::ptrdiff_t j = 0; j < image.height; ++j) filter(image.row(j), 1, image.width, 1);
  filter(image.row(0), image.width, image.height, image.width);
  return image;
}

/// The B-splines of the four pixels around a place, six times each, by the part of a pixel that it is on.
std::array<Floats, 4> splines(const Floats& part) {
  const Floats rest = 1 - part, square = part * part, last = square * part, first = rest * rest * rest;
  const Floats second = 4 + square * (3 * part - 6);
  return {first, second, 6 - second - (first + last), last};
}

/// Lane k is lane from(k) of a and b, one after the other.
template <auto from, std::size_t... k>
Floats shuffled(const Floats& a, const Floats& b, std::index_sequence<k...>) {
  return Floats(__builtin_shufflevector(a.numbers, b.numbers, from(k)...));
}
template <auto from>
Floats shuffled(const Floats& a, const Floats& b) {
  return shuffled<from>(a, b, std::make_index_sequence<width>{});
}
/// Four lanes from each of width / 4 places.
Floats fours(const float* const* from) {
  Floats lanes;
  for (std::size_t g = 0; g < width / 4; ++g) std::memcpy(reinterpret_cast<float*>(&lanes) + 4 * g, from[g], 16);
  return lanes;
}
/// Each lane's number in all of its group of four.
template <std::size_t a>
Floats of_group(const Floats& lanes) {
  return shuffled<[](std::size_t k) { return k / 4 * 4 + a; }>(lanes, lanes);
}
/// Turns rows of each group of four to columns.
void transpose(std::array<Floats, 4>& rows) {
  constexpr auto low = [](std::size_t k) { return k / 4 * 4 + k % 4 / 2 + (k % 2) * width; };
  constexpr auto high = [](std::size_t k) { return k / 4 * 4 + k % 4 / 2 + 2 + (k % 2) * width; };
  constexpr auto front = [](std::size_t k) { return k / 4 * 4 + k % 2 + (k % 4 / 2) * width; };
  constexpr auto back = [](std::size_t k) { return k / 4 * 4 + k % 2 + 2 + (k % 4 / 2) * width; };
  const Floats a = shuffled<low>(rows[0], rows[1]), b = shuffled<high>(rows[0], rows[1]);
  const Floats c = shuffled<low>(rows[2], rows[3]), d = shuffled<high>(rows[2], rows[3]);
  rows = {shuffled<front>(a, c), shuffled<back>(a, c), shuffled<front>(b, d), shuffled<back>(b, d)};
}

/// Grey values at places right of and above `corner`, in pixels; of the first `used` of them.
[[gnu::always_inline]] inline Floats greys(const float* corner, std::ptrdiff_t stride, const Floats& x, const Floats& y,
                                           std::ptrdiff_t used) {
  const Ints column = __builtin_convertvector(x.numbers, Ints), row = __builtin_convertvector(y.numbers, Ints);
  const auto across = splines(x - Floats(__builtin_convertvector(column, Floats::Numbers)));
  const auto upwards = splines(y - Floats(__builtin_convertvector(row, Floats::Numbers)));
  const Ints offsets = row * static_cast<int>(stride) + column;
  std::array<int, width> offset;
  std::memcpy(offset.data(), &offsets, sizeof offsets);
  std::array<Floats, 4> sums;
  const auto add_across = [&] {
    return across[0] * sums[0] + across[1] * sums[1] + (across[2] * sums[2] + across[3] * sums[3]);
  };
  // Most squares are hardly stretched: their places follow one another, a pixel each.
  const Ints next = offset[0] + __builtin_convertvector(Floats([](std::size_t k) { return k; }).numbers, Ints);
  if (detail::bits(Floats::Mask{offsets != next}) << (32 - used) == 0) {
    for (std::size_t c = 0; c < 4; ++c) {
      const float* const from = corner + offset[0] + c;
      sums[c] = upwards[0] * load(from);
      sums[c] = sums[c] + upwards[1] * load(from + stride);
      sums[c] = sums[c] + upwards[2] * load(from + 2 * stride);
      sums[c] = sums[c] + upwards[3] * load(from + 3 * stride);
    }
    return add_across();
  }
  // Place 4 g + a is in group g of sums[a], once for each of four columns.
  const auto add_up = [&]<std::size_t a>(std::integral_constant<std::size_t, a>) {
    std::array<const float*, width / 4> from;
    for (std::size_t g = 0; g < width / 4; ++g) from[g] = corner + offset[4 * g + a];
    const auto next = [&] {
      for (const float*& one : from) one += stride;
    };
    sums[a] = of_group<a>(upwards[0]) * fours(from.data()), next();
    sums[a] = sums[a] + of_group<a>(upwards[1]) * fours(from.data()), next();
    sums[a] = sums[a] + of_group<a>(upwards[2]) * fours(from.data()), next();
    sums[a] = sums[a] + of_group<a>(upwards[3]) * fours(from.data());
  };
  add_up(std::integral_constant<std::size_t, 0>{}), add_up(std::integral_constant<std::size_t, 1>{});
  add_up(std::integral_constant<std::size_t, 2>{}), add_up(std::integral_constant<std::size_t, 3>{});
  transpose(sums);
  return add_across();
}

constexpr std::ptrdiff_t most_together = 4 * width;  // places whose sums are worked on together

/// Of half the size. Behind its last pixel there is room, so that whole registers can be read from any pixel on.
Image halved(const Image& image) {
  Image small(image.width / 2, image.height / 2);
  small.grey.resize(small.grey.size() + most_together);
  for (std::ptrdiff_t j = 0; j < small.height; ++j) {
    const float *low = image.row(2 * j), *high = image.row(2 * j + 1);
    for (std::ptrdiff_t i = 0; i < small.width; ++i)
      small.row(j)[i] = 0.25f * (low[2 * i] + low[2 * i + 1] + high[2 * i] + high[2 * i + 1]);
  }
  return small;
}

/// Sums of of(grey) over squares of `side` pixels a side, each at its lower left pixel.
template <class Of>
Image square_sums(const Image& image, std::ptrdiff_t side, const Of& of) {
  Image sums(std::max<std::ptrdiff_t>(0, image.width - side + 1), std::max<std::ptrdiff_t>(0, image.height - side + 1));
  std::vector<double> column(static_cast<std::size_t>(image.width));
  for (std::ptrdiff_t j = 0; j < image.height; ++j) {
    const float* const coming = image.row(j);
    for (std::size_t i = 0; i < column.size(); ++i) column[i] += of(coming[i]);
    if (j < side - 1 || sums.width == 0) continue;
    const float* const going = image.row(j - side + 1);
    float* const to = sums.row(j - side + 1);
    double sum = 0;
    for (std::ptrdiff_t i = 0; i < image.width; ++i) {
      sum += column[static_cast<std::size_t>(i)];
      if (i < side - 1) continue;
      to[i - side + 1] = static_cast<float>(sum);
      sum -= column[static_cast<std::size_t>(i - side + 1)];
    }
    for (std::size_t i = 0; i < column.size(); ++i) column[i] -= of(going[i]);
  }
  return sums;
}

/// By how much a step is shorter than the one before; 0 where they do not go one way.
double steady_ratio(const Vec6& before, const Vec6& now) {
  const double together = before.dot(now), ratio = together / before.squaredNorm();
  if (!(together > aligned * before.norm() * now.norm() && ratio < 1)) return 0;
  return std::min(ratio, largest_ratio);
}

/// Sums over a square of something times 1, x and y.
struct Moments {
  Floats one = 0, x = 0, y = 0;
  /// Of a row: sums of it and of its products with x.
  void add(const Floats& row, const Floats& row_x, float at) {
    one = one + row, x = x + row_x, y = y + Floats(at) * row;
  }
  Eigen::Vector3d all() const { return {sum(one), sum(x), sum(y)}; }
};

/// Pixels of a square of the first picture.
class Square {
 public:
  Square(const ReferenceImage& image, std::ptrdiff_t column, std::ptrdiff_t row, std::ptrdiff_t half);
  /// None where the picture has one grey, or edges along one direction only.
  bool has_pattern() const { return has_pattern_; }
  double variance() const { return variance_; }

  /// How the other picture compares, at places middle + stretch · (those of the square).
  struct Sight {
    double variance = 0, together = 0;  ///< a pixel
    Vec6 change;                        ///< the step of Gauss and Newton: displacement and its gradient
  };
  Sight seen(const DeformedImage& image, const Vec2& middle, const Mat2& stretch) const;

 private:
  const float* grey(std::ptrdiff_t j) const { return pixels_.data() + j * stride_; }
  const float* across(std::ptrdiff_t j) const { return grey(j) + side_ * stride_; }
  const float* up(std::ptrdiff_t j) const { return across(j) + side_ * stride_; }
  /// Of columns: their numbers from the middle, those beyond the square as its last one's.
  const float* column() const { return grey(3 * side_); }
  /// Of columns: 1 in the square, 0 beyond it.
  const float* inside() const { return grey(3 * side_ + 1); }
  double count() const { return static_cast<double>(side_ * side_); }

  std::ptrdiff_t half_, side_, stride_;  ///< stride: of rows, whole registers
  std::vector<float> pixels_;  ///< grey less its mean, then slopes across and up, 0 beyond the side; then of columns
  double variance_ = 0;
  bool has_pattern_ = false;
  Vec6 steepest_, with_grey_;  ///< sums of the steepest descent, and of its products with grey values
  Eigen::LLT<Mat6> normal_;
};

Square::Square(const ReferenceImage& image, std::ptrdiff_t column, std::ptrdiff_t row, std::ptrdiff_t half)
    : half_(half), side_(2 * half + 1) {
  constexpr auto lanes = static_cast<std::ptrdiff_t>(width);
  stride_ = (side_ + lanes - 1) / lanes * lanes;
  pixels_.resize(static_cast<std::size_t>((3 * side_ + 2) * stride_));
  for (std::ptrdiff_t j = 0; j < side_; ++j) {
    const std::ptrdiff_t from = column - half, at = row - half + j;
    std::copy_n(image.full.row(at) + from, side_, pixels_.data() + j * stride_);
    std::copy_n(image.across.row(at) + from, side_, pixels_.data() + (side_ + j) * stride_);
    std::copy_n(image.up.row(at) + from, side_, pixels_.data() + (2 * side_ + j) * stride_);
  }
  float* const columns = pixels_.data() + 3 * side_ * stride_;
  for (std::ptrdiff_t i = 0; i < stride_; ++i) {
    columns[i] = static_cast<float>(std::min(i, side_ - 1) - half);
    columns[stride_ + i] = i < side_ ? 1 : 0;
  }
  Floats all = 0;
  for (std::ptrdiff_t j = 0; j < side_; ++j)
    for (std::ptrdiff_t i = 0; i < stride_; i += lanes) all = all + load(grey(j) + i);
  const auto mean = static_cast<float>(sum(all) / count());
  for (std::ptrdiff_t j = 0; j < side_; ++j)
    for (std::ptrdiff_t i = 0; i < side_; ++i) pixels_[static_cast<std::size_t>(j * stride_ + i)] -= mean;

  Floats squares = 0;
  // Of slopes, of their products with grey values, and of products of two slopes times 1, x, y, x², x y, y².
  Moments slope_across, slope_up, grey_across, grey_up;
  struct Products {
    Moments product, product_x;
    Floats yy = 0;
  };
  std::array<Products, 3> products;
  for (std::ptrdiff_t j = 0; j < side_; ++j) {
    const auto y = static_cast<float>(j - half_);
    for (std::ptrdiff_t i = 0; i < stride_; i += lanes) {
      const Floats f = load(grey(j) + i), a = load(across(j) + i), u = load(up(j) + i), x = load(columns + i);
      squares = squares + f * f;
      slope_across.add(a, a * x, y), slope_up.add(u, u * x, y);
      grey_across.add(f * a, f * a * x, y), grey_up.add(f * u, f * u * x, y);
      const std::array<Floats, 3> pairs{a * a, a * u, u * u};
      for (std::size_t n = 0; n < 3; ++n) {
        const Floats q = pairs[n], qx = q * x;
        products[n].product.add(q, qx, y), products[n].product_x.add(qx, qx * x, y);
        products[n].yy = products[n].yy + Floats(y * y) * q;
      }
    }
  }
  variance_ = sum(squares) / count();
  if (!(variance_ > flat)) return;
  steepest_ << slope_across.all(), slope_up.all();
  with_grey_ << grey_across.all(), grey_up.all();
  std::array<Eigen::Matrix3d, 3> blocks;
  for (std::size_t n = 0; n < 3; ++n) {
    const Eigen::Vector3d of_one = products[n].product.all(), of_x = products[n].product_x.all();
    blocks[n] << of_one[0], of_one[1], of_one[2], of_one[1], of_x[1], of_x[2], of_one[2], of_x[2], sum(products[n].yy);
  }
  Mat6 normal;
  normal << blocks[0], blocks[1], blocks[1], blocks[2];
  normal_.compute(normal);
  has_pattern_ = normal_.info() == Eigen::Success;
}

Square::Sight Square::seen(const DeformedImage& image, const Vec2& middle, const Mat2& stretch) const {
  constexpr auto lanes = static_cast<std::ptrdiff_t>(width);
  // Places count from a pixel left of and below all of them: single precision is then fine, and what is cut off the
  // floor.
  const Vec2 reach = static_cast<double>(half_) * stretch.cwiseAbs().rowwise().sum();
  const std::ptrdiff_t left = static_cast<std::ptrdiff_t>(middle.x() - reach.x()),
                       low = static_cast<std::ptrdiff_t>(middle.y() - reach.y());
  const Image& weights = image.weights();
  const float* const corner = weights.row(low - 1) + left - 1;
  const Vec2 from = middle - Vec2(static_cast<double>(left), static_cast<double>(low));
  // Grey values count from one of the picture's, so that those of one grey vanish.
  const Floats zero = greys(corner, weights.width, from.x(), from.y(), 1)[0];
  const Floats xx = stretch(0, 0), yx = stretch(1, 0);

  Floats all = 0, squares = 0, together = 0;
  Moments by_across, by_up;
  for (std::ptrdiff_t j = 0; j < side_; ++j) {
    const auto y = static_cast<double>(j - half_);
    const Floats start_x = from.x() + stretch(0, 1) * y, start_y = from.y() + stretch(1, 1) * y;
    for (std::ptrdiff_t i = 0; i < stride_; i += lanes) {
      const Floats x = load(column() + i);
      const Floats seen = greys(corner, weights.width, start_x + xx * x, start_y + yx * x, std::min(lanes, side_ - i));
      const Floats g = load(inside() + i) * (seen - zero);
      all = all + g, squares = squares + g * g, together = together + load(grey(j) + i) * g;
      const Floats a = load(across(j) + i) * g, u = load(up(j) + i) * g;
      by_across.add(a, a * x, static_cast<float>(y)), by_up.add(u, u * x, static_cast<float>(y));
    }
  }
  const double average = sum(all) / count();
  Sight sight;
  sight.variance = sum(squares) / count() - average * average;
  sight.together = sum(together) / count();
  Vec6 with_seen;
  with_seen << by_across.all(), by_up.all();
  const double scale = std::sqrt(variance_ / std::max(sight.variance, flat));
  sight.change = -normal_.solve(with_grey_ - scale * (with_seen - average * steepest_));
  return sight;
}

}  // namespace

ReferenceImage::ReferenceImage(Image image)
    : full(std::move(image)), coarse(halved(full)), across(full.width, full.height), up(full.width, full.height) {
  const Image weights = spline_weights(full);
  std::vector<float> value(static_cast<std::size_t>(full.width)), slope(value.size());
  for (std::ptrdiff_t j = 1; j < full.height - 1; ++j) {
    const float *const low = weights.row(j - 1), *const here = weights.row(j), *const high = weights.row(j + 1);
    for (std::size_t i = 0; i < value.size(); ++i)
      value[i] = low[i] + 4 * here[i] + high[i], slope[i] = 3 * (high[i] - low[i]);
    for (std::size_t i = 1; i + 1 < value.size(); ++i) {
      across.row(j)[i] = 3 * (value[i + 1] - value[i - 1]);
      up.row(j)[i] = slope[i - 1] + 4 * slope[i] + slope[i + 1];
    }
  }
}

DeformedImage::DeformedImage(Image image) : coarse_(halved(image)), weights_(spline_weights(std::move(image))) {}

Correlation::Correlation(const ReferenceImage& before, DeformedImage after, std::ptrdiff_t half)
    : before_(before),
      after_(std::move(after)),
      half_(half),
      sums_(square_sums(after_.coarse(), half, [](double grey) { return grey; })),
      squares_(square_sums(after_.coarse(), half, [](double grey) { return grey * grey; })) {}

bool Correlation::has(std::ptrdiff_t column, std::ptrdiff_t row) const {
  return column - half_ >= 1 && row - half_ >= 1 && column + half_ < before_.full.width - 1 &&
         row + half_ < before_.full.height - 1;
}

std::optional<Match> Correlation::search(std::ptrdiff_t column, std::ptrdiff_t row, std::ptrdiff_t reach) const {
  const std::ptrdiff_t left = (column - half_ + 1) / 2, low = (row - half_ + 1) / 2, side = half_, range = reach / 2;
  const Image &from = before_.coarse, &to = after_.coarse();
  std::vector<float> square;
  for (std::ptrdiff_t j = 0; j < side; ++j)
    square.insert(square.end(), from.row(low + j) + left, from.row(low + j) + left + side);
  const auto count = static_cast<float>(square.size());
  float mean = 0, variance = 0;
  for (const float one : square) mean += one / count;
  for (float& one : square) one -= mean, variance += one * one / count;
  if (!(variance > flat)) return std::nullopt;

  const std::ptrdiff_t first = std::max(-range, -left), places = std::min(range, to.width - side - left) - first + 1;
  if (places <= 0) return std::nullopt;
  std::optional<Match> best;
  std::vector<float> together(static_cast<std::size_t>(places + most_together));
  for (std::ptrdiff_t v = std::max(-range, -low); v <= std::min(range, to.height - side - low); ++v) {
    for (std::ptrdiff_t u = 0; u < places; u += most_together) {
      std::array<Floats, most_together / width> sum;
      sum.fill(0);
      for (std::ptrdiff_t j = 0; j < side; ++j)
        for (std::ptrdiff_t i = 0; i < side; ++i) {
          const Floats f = square[static_cast<std::size_t>(j * side + i)];
          const float* const g = to.row(low + v + j) + left + first + u + i;
          for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = sum[k] + f * load(g + k * width);
        }
      std::memcpy(together.data() + u, sum.data(), sizeof sum);
    }
    const float *const sums = sums_.row(low + v) + left + first, *const squares = squares_.row(low + v) + left + first;
    for (std::size_t n = 0; n < static_cast<std::size_t>(places); ++n) {
      const float average = sums[n] / count, spread = squares[n] / count - average * average;
      if (!(spread > flat)) continue;
      const double correlation = together[n] / count / std::sqrt(spread * variance);
      if (!best || correlation > best->correlation)
        best = Match{
            .moved = {2.0 * static_cast<double>(first + static_cast<std::ptrdiff_t>(n)), 2.0 * static_cast<double>(v)},
            .correlation = correlation};
    }
  }
  return best;
}

// The inverse compositional way (Baker and Matthews 2004, doi:10.1023/B:VISI.0000011205.11775.fd) with the zero-mean
// normalised sum of squared differences (Pan, Li and Tong 2013, doi:10.1007/s11340-013-9717-6).
std::optional<Match> Correlation::refined(std::ptrdiff_t column, std::ptrdiff_t row, Match guess, double least) const {
  const Square square(before_, column, row, half_);
  if (!square.has_pattern()) return std::nullopt;
  const auto half = static_cast<double>(half_);
  Mat2 stretch = Mat2::Identity() + guess.gradient;
  Vec2 moved = guess.moved;
  std::array<double, most_steps> corners;  // what they moved in each step
  std::optional<Vec6> before;              // the last step, where it was taken as it was
  for (int step = 0; step < most_steps; ++step) {
    const Vec2 middle = moved + Vec2(static_cast<double>(column), static_cast<double>(row));
    for (const double x : {-half, half})
      for (const double y : {-half, half})
        if (const Vec2 corner = middle + stretch * Vec2(x, y); !after_.has(corner.x(), corner.y())) return std::nullopt;
    const Square::Sight seen = square.seen(after_, middle, stretch);
    if (!(seen.variance > flat)) return std::nullopt;
    Vec6 change = seen.change, way;
    way << change[0], half * change[1], half * change[2], change[3], half * change[4], half * change[5];
    const double correlation = seen.together / std::sqrt(square.variance() * seen.variance);
    if (step >= first_compared && correlation < least - most_growth) return std::nullopt;
    const double corner = std::max(std::abs(way[0]), std::abs(way[3])) + std::abs(way[1]) + std::abs(way[2]) +
                          std::abs(way[4]) + std::abs(way[5]);
    const double ratio = before && corner < straight ? steady_ratio(*before, way) : 0;
    if (ratio > 0) before.reset();
    else before = way;
    change /= 1 - ratio;
    Mat2 turn = Mat2::Identity();
    turn(0, 0) += change[1], turn(0, 1) += change[2], turn(1, 0) += change[4], turn(1, 1) += change[5];
    const Vec2 shift(change[0], change[3]);
    // W(p) ← W(p) ∘ W(Δp)⁻¹
    if (!(std::abs(turn.determinant()) > 0.1)) return std::nullopt;
    stretch = stretch * turn.inverse();
    moved -= stretch * shift;
    if (corner < settled)
      return Match{.moved = moved, .gradient = stretch - Mat2::Identity(), .correlation = correlation};
    corners[static_cast<std::size_t>(step)] = corner;
    if (step < (corner < wandering ? first_rated : first_rated_wandering)) continue;
    const double rate = corner / corners[static_cast<std::size_t>(step - rated)];
    if (corner * std::pow(rate, static_cast<double>(most_steps - 1 - step) / rated) > hopeless * settled)
      return std::nullopt;
  }
  return std::nullopt;
}

bool has_pattern(const ReferenceImage& image, std::ptrdiff_t column, std::ptrdiff_t row, std::ptrdiff_t half) {
  return Square(image, column, row, half).has_pattern();
}

MatchGrid matches(const Correlation& pictures, const SquareGrid& squares, std::ptrdiff_t sparse, std::ptrdiff_t reach,
                  double least) {
  MatchGrid found{squares.columns, squares.rows, {}};
  found.match.resize(static_cast<std::size_t>(squares.columns * squares.rows));
  struct Found {
    double correlation;
    std::ptrdiff_t i, j;
    bool operator<(const Found& other) const {
      return std::tie(correlation, j, i) < std::tie(other.correlation, other.j, other.i);
    }
  };
  std::priority_queue<Found> best;
  const auto at = [&](std::ptrdiff_t i, std::ptrdiff_t j) -> std::optional<Match>& {
    return found.match[static_cast<std::size_t>(j * squares.columns + i)];
  };
  const auto look = [&](std::ptrdiff_t i, std::ptrdiff_t j, const std::optional<Match>& guess) {
    if (!guess || at(i, j)) return;
    const auto match =
        pictures.refined(squares.left + i * squares.apart, squares.bottom + j * squares.apart, *guess, least);
    if (!match || match->correlation < least) return;
    at(i, j) = match;
    best.push({match->correlation, i, j});
  };
  for (std::ptrdiff_t j = std::min(sparse, squares.rows) / 2; j < squares.rows; j += sparse)
    for (std::ptrdiff_t i = std::min(sparse, squares.columns) / 2; i < squares.columns; i += sparse)
      look(i, j, pictures.search(squares.left + i * squares.apart, squares.bottom + j * squares.apart, reach));
  while (!best.empty()) {
    const Found from = best.top();
    best.pop();
    for (const auto& [right, up] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
      const std::ptrdiff_t i = from.i + right, j = from.j + up;
      if (i < 0 || j < 0 || i >= squares.columns || j >= squares.rows) continue;
      Match guess = *at(from.i, from.j);
      guess.moved += guess.gradient * Vec2(right, up) * static_cast<double>(squares.apart);
      look(i, j, guess);
    }
  }
  return found;
}

}  // namespace grit
