#include "scene/clump_shape.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "grit/error.hpp"

namespace grit {
namespace {

constexpr int rays = 1000;  // along either axis

bool encloses(const Ball& large, std::span<const Ball> balls) {
  return std::ranges::all_of(
      balls, [&](const Ball& one) { return (xyz(one) - xyz(large)).norm() + one.w <= large.w * (1 + 1e-12); });
}

/// Has `best` be the smallest ball that all of `on` touch from inside, if it is smaller and encloses all balls.
void try_on(std::span<const Ball* const> on, std::span<const Ball> balls, Ball& best) {
  const Ball& base = *on[0];
  const auto others = static_cast<Eigen::Index>(on.size()) - 1;
  // The centre is base + span · weights, both linear in the radius R that is sought: u + R w.
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
    const Ball found{centre.x(), centre.y(), centre.z(), radius};
    if (encloses(found, balls)) best = found;
  }
}

bool hang_together(std::span<const Ball> balls) {
  std::vector<std::size_t> reached{0};
  std::vector<bool> seen(balls.size(), false);
  seen[0] = true;
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (std::size_t j = 0; j < balls.size(); ++j) {
      const Ball &a = balls[reached[k]], &b = balls[j];
      if (seen[j] || (xyz(a) - xyz(b)).norm() >= a.w + b.w) continue;
      seen[j] = true;
      reached.push_back(j);
    }
  return reached.size() == balls.size();
}

/// Integrals over the union of 1, r and r rᵀ, and over each ball of one over the number of balls there.
struct Moments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  std::vector<double> of_ball;
};

Moments moments(std::span<const Ball> balls) {
  Moments all;
  all.of_ball.assign(balls.size(), 0);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  for (const Ball& ball : balls)
    low = low.cwiseMin((xyz(ball).array() - ball.w).matrix()),
    high = high.cwiseMax((xyz(ball).array() + ball.w).matrix());
  const double dx = (high.x() - low.x()) / rays, dy = (high.y() - low.y()) / rays;
  struct End {
    double z;
    std::size_t ball;
    bool enters;
  };
  std::vector<End> ends;
  std::vector<std::size_t> inside;
  for (int i = 0; i < rays; ++i)
    for (int j = 0; j < rays; ++j) {
      const double x = low.x() + (i + 0.5) * dx, y = low.y() + (j + 0.5) * dy;
      ends.clear(), inside.clear();
      for (std::size_t k = 0; k < balls.size(); ++k) {
        const Ball& ball = balls[k];
        const double square = ball.w * ball.w - (x - ball.x) * (x - ball.x) - (y - ball.y) * (y - ball.y);
        if (square <= 0) continue;
        ends.push_back({ball.z - std::sqrt(square), k, true}), ends.push_back({ball.z + std::sqrt(square), k, false});
      }
      std::ranges::sort(ends, {}, &End::z);
      for (std::size_t e = 0; e < ends.size(); ++e) {
        if (!inside.empty()) {
          const double a = ends[e - 1].z, b = ends[e].z;
          const double length = b - a, line = 0.5 * (b * b - a * a), square = (b * b * b - a * a * a) / 3;
          all.volume += length;
          all.first += Vec3(x * length, y * length, line);
          all.second(0, 0) += x * x * length, all.second(0, 1) += x * y * length, all.second(0, 2) += x * line;
          all.second(1, 1) += y * y * length, all.second(1, 2) += y * line, all.second(2, 2) += square;
          for (const std::size_t k : inside) all.of_ball[k] += length / static_cast<double>(inside.size());
        }
        if (ends[e].enters) inside.push_back(ends[e].ball);
        else std::erase(inside, ends[e].ball);
      }
    }
  const double area = dx * dy;
  all.volume *= area, all.first *= area, all.second *= area;
  for (double& volume : all.of_ball) volume *= area;
  all.second = Mat3(all.second.selfadjointView<Eigen::Upper>());
  return all;
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
    throw Error("no sphere was found that encloses a clump; give its spheres in another unit");
  return best;
}

void check_clump(std::span<const Ball> spheres) {
  if (spheres.empty()) throw Error("a clump needs a sphere at least");
  if (spheres.size() > 64)
    throw Error("a clump of " + std::to_string(spheres.size()) + " spheres: 64 at most are allowed");
  if (!hang_together(spheres)) throw Error("spheres of a clump must overlap so that they hang together");
}

ClumpShape make_clump_shape(std::span<const Ball> spheres) {
  check_clump(spheres);
  const Ball enclosing = smallest_enclosing(spheres);
  std::vector<Ball> balls;
  for (const Ball& one : spheres) {
    const Vec3 place = (xyz(one) - xyz(enclosing)) / enclosing.w;
    balls.push_back({place.x(), place.y(), place.z(), one.w / enclosing.w});
  }
  const Moments all = moments(balls);
  const Vec3 centre = all.first / all.volume;
  const Mat3 spread = all.second / all.volume - centre * centre.transpose();
  const Mat3 inertia = spread.trace() * Mat3::Identity() - spread;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) *= -1;

  ClumpShape shape;
  shape.volume = all.volume, shape.inertia = solver.eigenvalues(), shape.axes = axes;
  shape.middle = axes.transpose() * -centre;
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const Vec3 place = axes.transpose() * (xyz(balls[k]) - centre);
    const double r = balls[k].w;
    shape.spheres.push_back({place.x(), place.y(), place.z(), r});
    shape.shares.push_back(all.of_ball[k] / (4.0 / 3.0 * std::numbers::pi * r * r * r));
  }
  return shape;
}

}  // namespace grit
