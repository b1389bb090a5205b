#include "bodies/clump_shape.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "format/number.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

constexpr double largest_error = 1e-3;
// A sphere that protrudes from another by less than this fraction of its radius only adds round-off.
constexpr double least_out = 1e-9;

double reach(const Vec3& from, std::span<const Ball> balls) {
  double most = 0;
  for (const Ball& one : balls) most = std::max(most, (xyz(one) - from).norm() + one.w);
  return most;
}
bool encloses(const Ball& large, std::span<const Ball> balls) {
  return reach(xyz(large), balls) <= large.w * (1 + 1e-12);
}

/// Sets `best` to the smallest ball that all of `on` touch from inside, enlarged to enclose all balls, if it is
/// smaller.
void try_on(std::span<const Ball* const> on, std::span<const Ball> balls, Ball& best) {
  const Ball& base = *on[0];
  const auto others = static_cast<Eigen::Index>(on.size()) - 1;
  // The centre is base + span · weights, both linear in the unknown radius R: u + R w.
  Eigen::Matrix3Xd span(3, others);
  Eigen::VectorXd fixed(others), growing(others);
  for (Eigen::Index k = 0; k < others; ++k) {
    const Ball& other = *on[static_cast<std::size_t>(k) + 1];
    span.col(k) = xyz(other) - xyz(base);
    fixed[k] = 0.5 * (span.col(k).squaredNorm() - other.w * other.w + base.w * base.w);
    growing[k] = other.w - base.w;
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> gram(span.transpose() * span);
  if (!gram.isInvertible()) return;
  const Vec3 u = span * gram.solve(fixed), w = span * gram.solve(growing);
  const double a = w.squaredNorm() - 1, b = u.dot(w) + base.w, c = u.squaredNorm() - base.w * base.w;
  const double square = b * b - a * c;
  if (square < 0) return;
  for (const double root : {-std::sqrt(square), std::sqrt(square)}) {
    const double radius = (-b + root) / a;
    if (!(radius > 0 && radius < best.w)) continue;
    const Vec3 centre = xyz(base) + u + radius * w;
    Ball found{centre.x(), centre.y(), centre.z(), radius};
    // If one ball hardly protrudes from another, the root has few correct digits.
    if (!encloses(found, balls)) found.w = reach(centre, balls);
    if (found.w < best.w) best = found;
  }
}

/// The largest group of connected balls, the first if there are several; sorted.
std::vector<std::size_t> largest_group(std::span<const Ball> balls) {
  std::vector<std::size_t> largest;
  std::vector<bool> seen(balls.size(), false);
  for (std::size_t first = 0; first < balls.size(); ++first) {
    if (seen[first]) continue;
    std::vector<std::size_t> group{first};
    seen[first] = true;
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::size_t j = 0; j < balls.size(); ++j) {
        const Ball &a = balls[group[k]], &b = balls[j];
        if (seen[j] || (xyz(a) - xyz(b)).norm() >= a.w + b.w) continue;
        seen[j] = true;
        group.push_back(j);
      }
    if (group.size() > largest.size()) largest = std::move(group);
  }
  std::ranges::sort(largest);
  return largest;
}

bool is_inside(const Ball& inner, const Ball& outer) {
  return (xyz(inner) - xyz(outer)).norm() + inner.w <= outer.w * (1 + least_out);
}

/// Integrals of 1, r and r rᵀ.
struct Moments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();

  /// Adds a piece of the line at x, y.
  void add_piece(double x, double y, double low, double high) {
    const double length = high - low, line = 0.5 * (high * high - low * low);
    volume += length;
    first += Vec3(x * length, y * length, line);
    second(0, 0) += x * x * length, second(0, 1) += x * y * length, second(0, 2) += x * line;
    second(1, 1) += y * y * length, second(1, 2) += y * line;
    second(2, 2) += (high * high * high - low * low * low) / 3;
  }
  /// `area` times these pieces about `centre`, relative to the origin.
  Moments moved(const Vec3& centre, double area) const {
    const Mat3 about = second.selfadjointView<Eigen::Upper>(), mixed = centre * first.transpose();
    return {area * volume, area * (first + volume * centre),
            area * (about + mixed + mixed.transpose() + volume * centre * centre.transpose())};
  }
  Moments plus(const Moments& other, double times = 1) const {
    return {volume + times * other.volume, first + times * other.first, second + times * other.second};
  }
  Vec3 centre() const { return first / volume; }
  /// About the centre, for a mass of 1.
  Mat3 inertia() const {
    const Mat3 spread = second / volume - centre() * centre().transpose();
    return spread.trace() * Mat3::Identity() - spread;
  }
};

/// By each ball.
struct Integrals {
  std::vector<Moments> fine, coarse;  ///< contribution to the union; the same with every third line in both directions
  std::vector<double> shared;         ///< integral of 1 / (number of balls that contain a point)
};

/// Ball by ball, each with its own lines and about its own centre, so that errors are small relative to its
/// contribution: with common lines for a long rod the moment of inertia about its axis would be wrong by a third.
Integrals integrate(std::span<const Ball> balls, int rays) {
  Integrals result;
  struct End {
    double z;
    int balls, earlier;  ///< change in the number of balls that cover the line from here on; the same for balls before
                         ///< this one
  };
  std::vector<End> ends;
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const Ball& own = balls[k];
    std::vector<std::pair<Ball, bool>> others;  // relative to its centre; whether it comes before
    for (std::size_t j = 0; j < balls.size(); ++j) {
      const Vec3 place = xyz(balls[j]) - xyz(own);
      if (j != k && place.norm() < balls[j].w + own.w)
        others.push_back({{place.x(), place.y(), place.z(), balls[j].w}, j < k});
    }
    const double apart = 2 * own.w / rays;
    Moments fine, coarse;
    double shared = 0;
    for (int i = 0; i < rays; ++i)
      for (int j = 0; j < rays; ++j) {
        const double x = (i + 0.5) * apart - own.w, y = (j + 0.5) * apart - own.w;
        const double square = own.w * own.w - x * x - y * y;
        if (square <= 0) continue;
        const double half = std::sqrt(square);
        ends.clear();
        for (const auto& [other, before] : others) {
          const double its_square = other.w * other.w - (x - other.x) * (x - other.x) - (y - other.y) * (y - other.y);
          if (its_square <= 0) continue;
          const double low = std::max(other.z - std::sqrt(its_square), -half),
                       high = std::min(other.z + std::sqrt(its_square), half);
          if (low >= high) continue;
          ends.push_back({low, 1, before}), ends.push_back({high, -1, -before});
        }
        std::ranges::sort(ends, {}, &End::z);
        ends.push_back({half, 0, 0});
        double from = -half;
        int there = 1, earlier = 0;
        for (const End& end : ends) {
          shared += (end.z - from) / there;
          if (earlier == 0) {
            fine.add_piece(x, y, from, end.z);
            if (i % 3 == 1 && j % 3 == 1) coarse.add_piece(x, y, from, end.z);
          }
          from = end.z, there += end.balls, earlier += end.earlier;
        }
      }
    const double area = apart * apart;
    result.fine.push_back(fine.moved(xyz(own), area)), result.coarse.push_back(coarse.moved(xyz(own), 9 * area));
    result.shared.push_back(area * shared);
  }
  return result;
}

/// Sum of the absolute changes with the coarse lines of each ball, so that errors do not cancel.
ShapeErrors errors_of(const Moments& all, const Integrals& integrals) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(all.inertia());
  const Mat3 axes = solver.eigenvectors();
  double mass = 0, centre = 0;
  Vec3 inertia = Vec3::Zero();
  for (std::size_t k = 0; k < integrals.fine.size(); ++k) {
    const Moments other = all.plus(integrals.fine[k], -1).plus(integrals.coarse[k]);
    mass += std::abs(other.volume / all.volume - 1);
    centre += (other.centre() - all.centre()).norm();
    const Mat3 change = axes.transpose() * (other.inertia() - all.inertia()) * axes;
    inertia += change.diagonal().cwiseAbs().cwiseQuotient(solver.eigenvalues());
  }
  return {mass, centre, inertia.maxCoeff()};
}

}  // namespace

Ball smallest_enclosing(std::span<const Ball> balls) {
  Ball best = *std::ranges::max_element(balls, {}, &Ball::w);
  if (encloses(best, balls)) return best;
  best.w = std::numeric_limits<double>::infinity();
  std::vector<const Ball*> on;
  const auto choose = [&](auto&& self, std::size_t from) -> void {
    if (on.size() >= 2) try_on(on, balls, best);
    if (on.size() == 4) return;
    for (std::size_t k = from; k < balls.size(); ++k) {
      on.push_back(&balls[k]);
      self(self, k + 1);
      on.pop_back();
    }
  };
  choose(choose, 0);
  if (!std::isfinite(best.w))
    throw Error("no sphere was found that encloses the clump; give its spheres in another unit");
  return best;
}

std::vector<ClumpDefect> clump_defects(std::span<const Ball> spheres) {
  if (spheres.empty() || spheres.size() > 64) return {{{}, std::to_string(spheres.size()) + " spheres", "1 to 64"}};
  const auto sphere = [](std::size_t k) { return "sphere " + std::to_string(k + 1); };
  std::vector<ClumpDefect> defects;
  const auto group = largest_group(spheres);
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const auto around = [&](std::size_t j) {
      const bool is_first_of_equals = k < j && is_inside(spheres[j], spheres[k]);
      return j != k && is_inside(spheres[k], spheres[j]) && !is_first_of_equals;
    };
    std::size_t outer = 0;
    while (outer < spheres.size() && !around(outer)) ++outer;
    if (outer < spheres.size())
      defects.push_back(
          {k, sphere(k) + ", which is inside " + sphere(outer), "a sphere that is not inside another; remove it"});
    else if (!std::ranges::binary_search(group, k))
      defects.push_back({k, sphere(k) + ", which is not connected with " + sphere(group.front()),
                         "spheres that overlap, so that all are connected"});
  }
  return defects;
}

ClumpShape make_clump_shape(std::span<const Ball> spheres, int rays) {
  if (const auto defects = clump_defects(spheres); !defects.empty())
    throw Error(fault_text(defects.front().found, defects.front().allowed));
  const Ball enclosing = smallest_enclosing(spheres);
  std::vector<Ball> balls;
  for (const Ball& one : spheres) {
    const Vec3 place = (xyz(one) - xyz(enclosing)) / enclosing.w;
    balls.push_back({place.x(), place.y(), place.z(), one.w / enclosing.w});
  }
  const Integrals integrals = integrate(balls, rays);
  Moments all;
  for (const Moments& one : integrals.fine) all = all.plus(one);
  const ShapeErrors errors = errors_of(all, integrals);
  if (const double most = std::max({errors.mass, errors.centre, errors.inertia}); !(most <= largest_error))
    throw Error("the error of mass, centre or inertia of a clump may be " + number(100 * most) +
                " %; allowed is 0.1 %; reduce the overlaps of its spheres");
  const Vec3 centre = all.centre();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(all.inertia());
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) *= -1;

  ClumpShape shape;
  shape.errors = errors, shape.given_radius = enclosing.w;
  shape.volume = all.volume, shape.inertia = solver.eigenvalues(), shape.axes = axes;
  shape.middle = axes.transpose() * -centre;
  // The fractions have their own errors; they are scaled so that their sum is the volume of the union.
  const double parts = std::accumulate(integrals.shared.begin(), integrals.shared.end(), 0.0);
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const Vec3 place = axes.transpose() * (xyz(balls[k]) - centre);
    const double r = balls[k].w;
    shape.spheres.push_back({place.x(), place.y(), place.z(), r});
    shape.volume_fractions.push_back(integrals.shared[k] * all.volume / parts /
                                     (4.0 / 3.0 * std::numbers::pi * r * r * r));
  }
  return shape;
}

}  // namespace grit
