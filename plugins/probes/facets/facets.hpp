// Pressure and shear on each facet of a mesh. See README.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class FacetsProbe final : public Probe {
 public:
  std::string wall;

  void declare(Parameters& parameters) override;
  /// Throws ParameterError for a wall that does not exist, or whose surface does not consist of triangles.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  /// Area, pressure and shear of each facet, as means of the samples since the previous frame; without a sample, at
  /// this instant.
  std::vector<Field> fields(const World& world) override;
  void serialize(Archive& archive) override {
    archive.part("facets", 1);
    archive(sum_, samples_);
  }

 private:
  struct Facet {
    double area;  ///< m²
    Vec3 normal;  ///< unit, towards the bodies, at the present position; zero without an area
  };
  /// Forces on a facet [N].
  struct Load {
    double normal = 0;  ///< into the surface
    Vec3 shear = Vec3::Zero();
    void serialize(Archive& archive) { archive(normal, shear); }
  };
  /// A stage or ramp may replace the geometry.
  std::vector<Facet> facets(const World& world) const;
  std::vector<Load> loads(const World& world, const std::vector<Facet>& facets) const;

  std::size_t index_ = 0;
  std::vector<Load> sum_;  // of the samples since the previous frame
  std::uint64_t samples_ = 0;
};

}  // namespace grit
