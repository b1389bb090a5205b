// How the specimen is packed: void ratio, coordination, stress, unrest; and the same over averaging cells.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/averaging_cells.hpp"
#include "grit/toolkit/limited_fields.hpp"

namespace grit {

class PackingProbe : public Probe, public LimitedFields {
 public:
  std::optional<double> shear_rate;
  std::string driven_by, driven_axis;
  double cell_size = 5, cell_step = 1;
  std::string depth_axis = "y";

  void declare(Parameters& parameters) override;
  /// Throws ParameterError if there is no wall `driven_by`.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  /// The averaging cells.
  std::vector<Field> fields(const World& world) override;
  void check_fields(const World& world) const override;

 private:
  double shear_rate_of(const World& world) const;
  Averaging averaging() const;
  std::optional<std::size_t> driving_wall_;
};

}  // namespace grit
