// Density, momentum, velocity and stress of the continuum that grains make. See README.md.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "coarse_fields.hpp"
#include "grit/probe.hpp"
#include "grit/toolkit/limited_fields.hpp"

namespace grit {

class CoarseGraining final : public Probe, public LimitedFields {
 public:
  double cutoff = 2, spacing = 1;  ///< mean diameters
  std::string slice = "none";
  std::optional<Vec3> region_low, region_high;  ///< m

  void declare(Parameters& parameters) override;
  /// Throws ParameterError where the grid has too many points.
  void prepare(const World& world) override { check_fields(world); }
  void check_fields(const World& world) const override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  std::vector<Field> fields(const World& world) override;

 private:
  Region box(const World& world) const;
  /// Of points along each axis; 0 where there is no mean diameter or no box.
  std::array<double, 3> counts(const World& world) const;
  /// None where there are no points, or too many.
  std::optional<PointGrid> grid(const World& world) const;
  std::vector<CoarseFields> smoothed(const World& world, const PointGrid& points) const {
    return coarse_fields(world, points, cutoff * world.mean_diameter());
  }
};

}  // namespace grit
