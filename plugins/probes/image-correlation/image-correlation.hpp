// Strain in a plane, found from pictures of the grains alone. See README.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "camera.hpp"
#include "correlation.hpp"
#include "grit/probe.hpp"
#include "grit/toolkit/sliding_lengths.hpp"

namespace grit {

class ImageCorrelation final : public Probe {
 public:
  std::string depth_axis = "y";
  double pixels_per_diameter = 25;
  double subset = 1.2, step = 0.5, window = 3, search_range = 4;  ///< mean diameters
  double min_correlation = 0.7;
  std::int64_t seed = 1;
  std::optional<SlidingLengths> sliding;

  void declare(Parameters& parameters) override;
  StateRequest needs() const override { return BodyState::rotation; }
  /// Throws ParameterError where the domain is periodic along the depth axis, where the picture would have too many
  /// pixels, or for a wall that cannot be slid along in the plane.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  std::vector<Field> fields(const World& world) override;
  void serialize(Archive& archive) override;

  /// Of what is there now, through the camera as it stood at the first look of the stage.
  Image picture(const World& world);

 private:
  using Vec2 = Eigen::Vector2d;
  /// Where the camera stands, and what it takes.
  struct View {
    Vec2 corner;          ///< middle of the lower left pixel [m]
    double pixel = 0;     ///< side [m]
    double face = 0;      ///< of the specimen, along the depth axis [m]
    double diameter = 0;  ///< mean [m]
    std::ptrdiff_t width = 0, height = 0;
    SquareGrid subsets{};
    void serialize(Archive& archive) {
      archive(corner, pixel, face, diameter, width, height);
      archive(subsets.columns, subsets.rows, subsets.left, subsets.bottom, subsets.apart);
    }
  };
  struct Subset {
    Vec2 start, moved;            ///< middle when the stage began, and how far it has gone since; NaN if it is lost [m]
    std::array<double, 3> green;  ///< E_11, E_22, E_12
    double correlation;           ///< NaN if it is lost
    void serialize(Archive& archive) { archive(start, moved, green, correlation); }
  };
  struct Axes {
    int right, up, depth;
    double away;  ///< sign of the depth axis along the line of sight
  };
  Axes axes() const;
  /// Throws Error unless the restored picture and its subsets fit the restored view.
  void check_restored(const Image& start) const;
  std::optional<View> view(const World& world) const;
  double pixels(const World& world) const;
  Image picture(const World& world, const View& view) const;
  void look(const World& world);
  std::ptrdiff_t half() const;  ///< of a subset's side, pixels
  /// Where subsets are that do not move: all that have something to see.
  MatchGrid unmoved() const;
  MatchGrid found(Image now) const;
  std::vector<Subset> subsets_of(const MatchGrid& found) const;

  std::optional<Camera> camera_;
  // Kept from the first look of a stage on, and from the last one.
  bool began_ = false;
  std::string stage_;
  std::uint64_t step_ = 0;
  std::optional<View> view_;
  ReferenceImage start_;
  SlidingLengths::Start walls_;
  std::vector<Subset> subsets_;
};

}  // namespace grit
