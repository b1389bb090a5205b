// What walls do and bear: displacement, velocity, force, moment, pressure, touches.
#pragma once

#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class WallsProbe : public Probe {
 public:
  /// The walls to report, in this order; empty: all.
  std::vector<std::string> walls;
  bool spin = false;  ///< whether to report angular velocities

  void declare(Parameters& parameters) override;
  /// Throws ParameterError for a wall that does not exist, or for two that would get the same channels.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;

 private:
  struct Reported {
    std::string stem;
    std::size_t index;                  ///< in World::walls()
    std::vector<std::string> channels;  ///< names, one a quantity
  };
  std::vector<Reported> reported_;
};

}  // namespace grit
