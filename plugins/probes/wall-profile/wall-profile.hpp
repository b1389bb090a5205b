// What bodies press and rub on walls, by height. See README.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class WallProfile final : public Probe {
 public:
  std::vector<std::string> walls, bottom;
  std::string along = "z";
  double width = 0;  ///< m
  std::optional<double> low, high;
  std::int64_t strips = 20;

  void declare(Parameters& parameters) override;
  /// Throws ParameterError for a wall that does not exist, or one of `walls` that has no normal of its own or one with
  /// a part along the height.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;

 private:
  struct Ends {
    double low, high;
  };
  Ends ends(const World& world) const;
  /// Of all bodies that are there, against `along` [N]; NaN where it is nothing, or points the other way.
  double weight(const World& world) const;
  int axis() const { return along[0] - 'x'; }

  std::vector<bool> chosen_, below_;  // by wall: of `walls`, of `bottom`
};

}  // namespace grit
