// Where the parts of one picture are in another. See README.md.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "image.hpp"

namespace grit {

/// The first picture, and what later ones are compared with.
struct ReferenceImage {
  ReferenceImage() = default;
  explicit ReferenceImage(Image image);
  Image full, coarse;  ///< coarse: of half the size
  Image across, up;    ///< slopes of the picture's B-splines at its pixels, grey values a pixel; not at its sides
};

/// A later picture, between its pixels: B-splines of third degree (Unser 1999, doi:10.1109/79.799930).
class DeformedImage {
 public:
  explicit DeformedImage(Image image);
  const Image& coarse() const { return coarse_; }
  /// Weights of the splines at pixels, over 36: the splines are to be taken six times.
  const Image& weights() const { return weights_; }
  /// Whether a place is two pixels or more off the picture's sides, where grey values are known between pixels.
  bool has(double x, double y) const {
    return x >= 2 && y >= 2 && x < static_cast<double>(weights_.width - 3) &&
           y < static_cast<double>(weights_.height - 3);
  }

 private:
  Image coarse_, weights_;
};

/// Where a square of one picture is in another, to first order.
struct Match {
  Eigen::Vector2d moved = Eigen::Vector2d::Zero();     ///< its middle, pixels
  Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();  ///< of the displacement
  double correlation = 0;                              ///< zero-mean normalised, up to 1
};

/// Two pictures of one size, of the same things before and after.
class Correlation {
 public:
  /// `half`: a square has 2 half + 1 pixels a side; at least 2.
  /// `before` must outlive it.
  Correlation(const ReferenceImage& before, DeformedImage after, std::ptrdiff_t half);
  Correlation(ReferenceImage&& before, DeformedImage after, std::ptrdiff_t half) = delete;

  /// Whether the square around a pixel has its slopes inside the picture.
  bool has(std::ptrdiff_t column, std::ptrdiff_t row) const;
  /// The best match of the square within `reach` pixels along each axis, to two pixels: the guess for refined(). None
  /// where the square is of one grey. Where has().
  std::optional<Match> search(std::ptrdiff_t column, std::ptrdiff_t row, std::ptrdiff_t reach) const;
  /// The match next to a guess that has the least sum of squared differences, by Gauss and Newton's steps. None where
  /// they lead out of the picture or to no end, or where a square is of one grey; nor, perhaps, where the match would
  /// have a correlation below `least`. Where has().
  std::optional<Match> refined(std::ptrdiff_t column, std::ptrdiff_t row, Match guess, double least = 0) const;

 private:
  const ReferenceImage& before_;
  DeformedImage after_;
  std::ptrdiff_t half_;
  Image sums_, squares_;  ///< of the coarse square whose lower left pixel it is, of grey values and of their squares
};

/// Whether the square around a pixel is of more than one grey: it is found in its own picture then. Where
/// Correlation::has().
bool has_pattern(const ReferenceImage& image, std::ptrdiff_t column, std::ptrdiff_t row, std::ptrdiff_t half);

/// Squares in rows and columns, and where they were found.
struct MatchGrid {
  std::ptrdiff_t columns = 0, rows = 0;
  std::vector<std::optional<Match>> match;  ///< row by row
};
struct SquareGrid {
  std::ptrdiff_t columns, rows;
  std::ptrdiff_t left, bottom, apart;  ///< middle of the first square, distance between neighbours [pixels]
};

/// Matches of a correlation of `least` or more. Some squares, `sparse` apart in the grid, are searched for within
/// `reach` pixels; from the best of them on, each that is found is a guess for its neighbours (Pan 2009,
/// doi:10.1364/AO.48.001535).
MatchGrid matches(const Correlation& pictures, const SquareGrid& squares, std::ptrdiff_t sparse, std::ptrdiff_t reach,
                  double least);

}  // namespace grit
