// Strain in a plane, fitted to how far bodies have gone. See README.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/sliding_lengths.hpp"

namespace grit {

class Strain final : public Probe {
 public:
  std::string depth_axis = "y";
  double subset = 5, step = 1;  ///< mean diameters
  std::optional<SlidingLengths> sliding;

  void declare(Parameters& parameters) override;
  StateRequest needs() const override { return BodyState::displacement; }
  /// Throws ParameterError for a wall that cannot be slid along in the plane.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  std::vector<Field> fields(const World& world) override;

 private:
  using Vec2 = Eigen::Vector2d;
  struct Body {
    Vec2 place, moved;  ///< at the start of the stage, and since [m]
  };
  struct Subset {
    Vec2 began, moved;            ///< its centre at the start of the stage, and since [m]
    int bodies;                   ///< that lay in it
    std::array<double, 3> green;  ///< E_11, E_22, E_12
  };
  std::array<int, 2> plane() const;
  std::vector<Body> bodies(const World& world) const;
  std::vector<Subset> subsets(const World& world) const;
};

}  // namespace grit
