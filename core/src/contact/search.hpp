// Neighbour search on cell grids, one per size class.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "contact/skins.hpp"
#include "grit/world.hpp"
#include "threads/team.hpp"

namespace grit {

/// A pair whose surfaces are nearer than the sum of both skins and the reach of the law; a < b by index.
struct Candidate {
  std::uint32_t a, b;
  float gap;           ///< lower bound of the distance of the surfaces beyond the reach [m]; 0 within it, or in contact
  std::uint8_t image;  ///< periodic image of b, see image_shift()
  bool touching() const { return gap == 0; }
};

/// Numbers of images: sums of 3^axis × (0, 1, 2 for a shift of 0, +1, −1 periods); after these, those two periods away
/// along x, which exist in a skewed cell only.
inline constexpr std::uint8_t straight_images = 27, all_images = 45;
/// The shift of an image, in periods.
inline std::array<int, 3> image_shift(std::uint8_t image) {
  const auto one = [](int digit) { return digit == 2 ? -1 : digit; };
  if (image < straight_images) return {one(image % 3), one(image / 3 % 3), one(image / 9)};
  const int two = image - straight_images;
  return {two % 2 == 0 ? 2 : -2, one(two / 2 % 3), one(two / 6)};
}
/// The image with this shift.
inline std::uint8_t image_with(const std::array<int, 3>& shift) {
  const auto digit = [](int one) { return one < 0 ? 2 : one; };
  const int across = digit(shift[1]) + 3 * digit(shift[2]);
  return static_cast<std::uint8_t>(std::abs(shift[0]) == 2 ? straight_images + (shift[0] < 0 ? 1 : 0) + 2 * across
                                                           : digit(shift[0]) + 3 * across);
}

/// Finds all pairs nearer than their skins. Bodies must be inside the periods of `cell`, if any. Bodies are sorted into
/// size classes that span a factor of 2.5 in radius, so that small grains need not search the cells of large ones.
class NeighbourSearch {
 public:
  /// Periods must be at least shortest_period() of the largest body, skin and reach.
  void build(const Bodies& bodies, const Cell& cell, const Skins& skins, Team& team);
  /// The same for the bodies of some chunks, in ascending order.
  void build(const Bodies& bodies, std::span<const std::uint32_t> chunks, const Cell& cell, const Skins& skins,
             Team& team);
  /// Twice the largest distance of the centres of a pair [m]: in a shorter period one body would meet another twice.
  static double shortest_period(double radius, double skin, double reach) { return 4 * (radius + skin) + 2 * reach; }
  /// The largest reach of the law [m].
  double reach() const { return skins_.reach(); }
  const Cell& cell() const { return cell_; }
  const Skins& skins() const { return skins_; }
  /// Appends the candidates with a = `body`, in ascending order of b.
  void neighbours(const Bodies& bodies, std::uint32_t body, std::vector<Candidate>& candidates) const;
  /// Appends the candidates with b = `body` and a < `below`, in no order.
  void neighbours_below(const Bodies& bodies, std::uint32_t body, std::uint32_t below,
                        std::vector<Candidate>& candidates) const;

 private:
  struct Grid {
    double largest_radius = 0, largest_reach = 0;  ///< m, without and with the skin
    Vec3 origin, per_length;                       ///< cell index = (x − origin) · per_length
    std::array<int, 3> size{1, 1, 1};
    std::vector<std::uint32_t> start, body;    ///< bodies of cell c: body[start[c]] … body[start[c + 1]]
    std::vector<std::uint32_t> members, next;  ///< of build(), kept for the next one
    std::vector<double> x, y, z, reach;        ///< of `body`: centres, and radii with skins [m]; padded by a register

    int index(int axis, double x) const;
    void place(const Bodies& bodies, const Skins& skins, Team& team);
  };
  /// The candidate of a and b, if they are near enough.
  template <bool skewed>
  std::optional<Candidate> pair(const Bodies& bodies, std::uint32_t a, std::uint32_t b) const;
  /// Calls take(other) for all bodies that may be near `body`.
  template <bool skewed, class Take>
  void each_around(const Bodies& bodies, std::uint32_t body, Take take) const;
  /// Calls use(n) for bodies n of `begin` … `end` of the grid whose centre, or an image of it, is nearer to `centre`
  /// than the sum of their reach and `reach`, and perhaps for some that are farther by a rounding error.
  template <class Use>
  void each_near(const Grid& grid, std::uint32_t begin, std::uint32_t end, const Row& centre, double reach,
                 Use use) const;

  Cell cell_;
  Vec3 period_, per_period_;      // m, 1/m; 0 along axes that are not periodic
  std::array<Vec3, 3> to_image_;  // Cell::period
  bool any_periodic_ = false;
  Skins skins_;
  std::vector<Grid> grids_;  // their memory is used again
};

}  // namespace grit
