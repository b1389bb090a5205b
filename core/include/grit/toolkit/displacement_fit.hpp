// Strain in a plane from the displacements of points.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <limits>
#include <vector>

namespace grit {

/// Linear displacement field of points, u = ū + H (X − X̄), by least squares.
class DisplacementFit {
 public:
  void add(const Eigen::Vector2d& place, const Eigen::Vector2d& moved) {
    places_.push_back(place), moves_.push_back(moved);
  }
  /// Removes all points; keeps their memory.
  void clear() { places_.clear(), moves_.clear(); }
  int points() const { return static_cast<int>(places_.size()); }
  /// Mean displacement; 0 without points.
  Eigen::Vector2d moved() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& one : moves_) sum += one;
    return moves_.empty() ? sum : Eigen::Vector2d(sum / static_cast<double>(moves_.size()));
  }
  /// Green–Lagrange strain (H + Hᵀ + HᵀH) / 2: E_11, E_22, E_12. NaN with fewer than `least` points, or if they lie
  /// nearly on a line: the determinant of their scatter matrix over the square of its trace is at most `flat`.
  std::array<double, 3> green(std::size_t least, double flat) const {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    if (places_.size() < least) return {unknown, unknown, unknown};
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& one : places_) place += one;
    place /= static_cast<double>(places_.size());
    const Eigen::Vector2d moved = this->moved();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero(), together = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Eigen::Vector2d x = places_[i] - place;
      spread += x * x.transpose(), together += (moves_[i] - moved) * x.transpose();
    }
    if (!(spread.determinant() > flat * spread.trace() * spread.trace())) return {unknown, unknown, unknown};
    const Eigen::Matrix2d gradient = together * spread.inverse();
    const Eigen::Matrix2d green = 0.5 * (gradient + gradient.transpose() + gradient.transpose() * gradient);
    return {green(0, 0), green(1, 1), green(0, 1)};
  }

 private:
  std::vector<Eigen::Vector2d> places_, moves_;
};

}  // namespace grit
