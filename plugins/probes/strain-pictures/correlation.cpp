#include "correlation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>

namespace grit {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double flat = 1e-8;     // variance of grey values below which a square has nothing to see
constexpr double settled = 1e-3;  // what a corner of a square still moves when it is found, pixels
constexpr int most_steps = 30;

/// From values of a line to weights of B-splines, its ends mirrored.
void filter(float* line, std::ptrdiff_t count, std::ptrdiff_t stride) {
  if (count < 2) return;
  const auto at = [=](std::ptrdiff_t i) -> float& { return line[i * stride]; };
  const float pole = std::sqrt(3.0f) - 2;
  const std::ptrdiff_t reach = std::min<std::ptrdiff_t>(count, 16);  // |pole|^16 is round-off
  float sum = 0, power = 1;
  for (std::ptrdiff_t i = 0; i < reach; ++i, power *= pole) sum += power * at(i);
  at(0) = sum;
  for (std::ptrdiff_t i = 1; i < count; ++i) at(i) += pole * at(i - 1);
  at(count - 1) = pole / (pole * pole - 1) * (pole * at(count - 2) + at(count - 1));
  for (std::ptrdiff_t i = count - 2; i >= 0; --i) at(i) = pole * (at(i + 1) - at(i));
  for (std::ptrdiff_t i = 0; i < count; ++i) at(i) *= 6;
}

std::array<float, 4> splines(float part) {
  const float rest = 1 - part, square = part * part, cube = square * part;
  return {rest * rest * rest / 6, (4 - 6 * square + 3 * cube) / 6, (1 + 3 * part + 3 * square - 3 * cube) / 6,
          cube / 6};
}

/// Of half the size.
Image halved(const Image& image) {
  Image small(image.width / 2, image.height / 2);
  for (std::ptrdiff_t j = 0; j < small.height; ++j) {
    const float *low = image.row(2 * j), *high = image.row(2 * j + 1);
    for (std::ptrdiff_t i = 0; i < small.width; ++i)
      small.row(j)[i] = 0.25f * (low[2 * i] + low[2 * i + 1] + high[2 * i] + high[2 * i + 1]);
  }
  return small;
}

}  // namespace

SmoothImage::SmoothImage(const Image& image) : weights_(image) {
  for (std::ptrdiff_t j = 0; j < weights_.height; ++j) filter(weights_.row(j), weights_.width, 1);
  for (std::ptrdiff_t i = 0; i < weights_.width; ++i) filter(weights_.row(0) + i, weights_.height, weights_.width);
}

double SmoothImage::grey(double x, double y) const {
  const auto column = static_cast<std::ptrdiff_t>(x), row = static_cast<std::ptrdiff_t>(y);
  const auto across = splines(static_cast<float>(x - static_cast<double>(column)));
  const auto up = splines(static_cast<float>(y - static_cast<double>(row)));
  float sum = 0;
  for (std::ptrdiff_t j = 0; j < 4; ++j) {
    const float* const line = weights_.row(row + j - 1) + column - 1;
    sum += up[static_cast<std::size_t>(j)] *
           (across[0] * line[0] + across[1] * line[1] + across[2] * line[2] + across[3] * line[3]);
  }
  return sum;
}

Vec2 SmoothImage::slope(std::ptrdiff_t column, std::ptrdiff_t row) const {
  constexpr std::array<double, 3> value{1.0 / 6, 4.0 / 6, 1.0 / 6}, slope{-0.5, 0, 0.5};
  Vec2 sum = Vec2::Zero();
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const double weight =
          weights_.row(row + static_cast<std::ptrdiff_t>(j) - 1)[column + static_cast<std::ptrdiff_t>(i) - 1];
      sum += weight * Vec2(slope[i] * value[j], value[i] * slope[j]);
    }
  return sum;
}

FilteredImage::FilteredImage(Image image) : full(std::move(image)), coarse(halved(full)), smooth(full) {}

Correlation::Correlation(const FilteredImage& before, FilteredImage after, std::ptrdiff_t half)
    : before_(before), after_(std::move(after)), half_(half) {}

bool Correlation::has(std::ptrdiff_t column, std::ptrdiff_t row) const {
  return column - half_ >= 1 && row - half_ >= 1 && column + half_ < before_.full.width - 1 &&
         row + half_ < before_.full.height - 1;
}

std::optional<Match> Correlation::search(std::ptrdiff_t column, std::ptrdiff_t row, std::ptrdiff_t reach) const {
  const std::ptrdiff_t left = (column - half_ + 1) / 2, low = (row - half_ + 1) / 2, side = half_, range = reach / 2;
  const Image &from = before_.coarse, &to = after_.coarse;
  std::vector<float> square;
  for (std::ptrdiff_t j = 0; j < side; ++j)
    square.insert(square.end(), from.row(low + j) + left, from.row(low + j) + left + side);
  const auto count = static_cast<float>(square.size());
  float mean = 0, variance = 0;
  for (const float one : square) mean += one / count;
  for (float& one : square) one -= mean, variance += one * one / count;
  if (!(variance > flat)) return std::nullopt;

  const std::ptrdiff_t first = std::max(-range, -left), places = std::min(range, to.width - side - left) - first + 1;
  std::optional<Match> best;
  std::vector<float> sum, squares, together;  // of all places of a row at once, which vectorises
  for (std::ptrdiff_t v = std::max(-range, -low); v <= std::min(range, to.height - side - low); ++v) {
    for (auto* one : {&sum, &squares, &together}) one->assign(static_cast<std::size_t>(places), 0);
    for (std::ptrdiff_t j = 0; j < side; ++j)
      for (std::ptrdiff_t i = 0; i < side; ++i) {
        const float f = square[static_cast<std::size_t>(j * side + i)];
        const float* const g = to.row(low + v + j) + left + first + i;
        for (std::ptrdiff_t u = 0; u < places; ++u) {
          const auto n = static_cast<std::size_t>(u);
          sum[n] += g[u], squares[n] += g[u] * g[u], together[n] += f * g[u];
        }
      }
    for (std::size_t n = 0; n < sum.size(); ++n) {
      const float average = sum[n] / count, spread = squares[n] / count - average * average;
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
std::optional<Match> Correlation::refined(std::ptrdiff_t column, std::ptrdiff_t row, Match guess) const {
  const std::ptrdiff_t side = 2 * half_ + 1;
  const auto count = static_cast<double>(side * side);
  struct Pixel {
    double grey, across, up;
  };
  std::vector<Pixel> square;
  square.reserve(static_cast<std::size_t>(side * side));
  double mean = 0, variance = 0;
  Mat6 normal = Mat6::Zero();
  for (std::ptrdiff_t j = -half_; j <= half_; ++j)
    for (std::ptrdiff_t i = -half_; i <= half_; ++i) {
      const Vec2 slope = before_.smooth.slope(column + i, row + j);
      square.push_back({before_.full.row(row + j)[column + i], slope.x(), slope.y()});
      mean += square.back().grey / count;
      const auto x = static_cast<double>(i), y = static_cast<double>(j);
      Vec6 steepest;
      steepest << slope.x(), slope.x() * x, slope.x() * y, slope.y(), slope.y() * x, slope.y() * y;
      normal += steepest * steepest.transpose();
    }
  for (Pixel& pixel : square) pixel.grey -= mean, variance += pixel.grey * pixel.grey / count;
  if (!(variance > flat)) return std::nullopt;
  const Eigen::LDLT<Mat6> solver(normal);
  if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;

  const auto width = static_cast<double>(half_);
  std::vector<double> seen(square.size());
  Mat2 stretch = Mat2::Identity() + guess.gradient;
  Vec2 moved = guess.moved;
  for (int step = 0; step < most_steps; ++step) {
    const Vec2 middle = moved + Vec2(static_cast<double>(column), static_cast<double>(row));
    for (const double x : {-width, width})
      for (const double y : {-width, width})
        if (const Vec2 corner = middle + stretch * Vec2(x, y); !after_.smooth.has(corner.x(), corner.y()))
          return std::nullopt;
    double average = 0, squares = 0, together = 0;
    auto to = seen.begin();
    for (std::ptrdiff_t j = -half_; j <= half_; ++j)
      for (std::ptrdiff_t i = -half_; i <= half_; ++i) {
        const Vec2 place = middle + stretch * Vec2(static_cast<double>(i), static_cast<double>(j));
        average += (*to++ = after_.smooth.grey(place.x(), place.y())) / count;
      }
    for (std::size_t n = 0; n < seen.size(); ++n) {
      seen[n] -= average;
      squares += seen[n] * seen[n] / count, together += seen[n] * square[n].grey / count;
    }
    if (!(squares > flat)) return std::nullopt;
    const double scale = std::sqrt(variance / squares);
    Vec6 slope = Vec6::Zero();
    auto pixel = square.begin();
    to = seen.begin();
    for (std::ptrdiff_t j = -half_; j <= half_; ++j)
      for (std::ptrdiff_t i = -half_; i <= half_; ++i, ++pixel, ++to) {
        const double difference = pixel->grey - scale * *to;
        const double x = static_cast<double>(i), y = static_cast<double>(j);
        const double across = difference * pixel->across, up = difference * pixel->up;
        slope[0] += across, slope[1] += across * x, slope[2] += across * y;
        slope[3] += up, slope[4] += up * x, slope[5] += up * y;
      }
    const Vec6 change = -solver.solve(slope);
    Mat2 turn = Mat2::Identity();
    turn(0, 0) += change[1], turn(0, 1) += change[2], turn(1, 0) += change[4], turn(1, 1) += change[5];
    const Vec2 shift(change[0], change[3]);
    // W(p) ← W(p) ∘ W(Δp)⁻¹
    if (!(std::abs(turn.determinant()) > 0.1)) return std::nullopt;
    stretch = stretch * turn.inverse();
    moved -= stretch * shift;
    const double corner = shift.lpNorm<Eigen::Infinity>() + width * (std::abs(change[1]) + std::abs(change[2]) +
                                                                     std::abs(change[4]) + std::abs(change[5]));
    if (corner < settled)
      return Match{.moved = moved,
                   .gradient = stretch - Mat2::Identity(),
                   .correlation = together / std::sqrt(variance * squares)};
  }
  return std::nullopt;
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
    const auto match = pictures.refined(squares.left + i * squares.apart, squares.bottom + j * squares.apart, *guess);
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
