#include "kernel/device_obstacles.hpp"

#include "description/placed_error.hpp"

namespace grit {

std::vector<PlacedError::Fault> device_obstacles(const Settings& settings, const std::vector<std::string>& walls,
                                                 const StateRequest& bodies) {
  std::vector<PlacedError::Fault> found;
  const auto refuse = [&found](std::vector<std::string> keys, const std::string& what) {
    found.push_back({std::move(keys), what + "; run it without --device"});
  };
  if (!settings.law->device()) {
    const bool single = settings.law->loop().precision == "single";
    refuse(single ? std::vector<std::string>{"contacts", "precision"} : std::vector<std::string>{"contacts"},
           single ? "devices evaluate contacts in double precision only" : "devices cannot evaluate this contact law");
  }
  for (const std::string& wall : walls) refuse({"walls", wall}, "devices have no walls yet");
  if (settings.may_clump) refuse({"bodies"}, "devices have no clumps yet");
  for (const auto& [name, engine] : settings.engines)
    if (engine->phase() != Phase::settings)
      refuse({"engines", name}, "devices have no engines yet except those that set gravity, damping and held bodies");
  if (!settings.motion_of_groups.empty()) refuse({"engines"}, "devices treat all groups of bodies alike yet");
  else if (settings.motion.prescribed) refuse({"engines"}, "devices cannot prescribe the motion of bodies yet");
  if (settings.cell_servo) refuse({"domain", "servo"}, "devices have no servo of the cell yet");
  if (!settings.open_sides.empty()) refuse({"domain", "open_sides"}, "devices have no open sides yet");
  if (settings.growth_rate > 0) refuse({"stages"}, "devices cannot let bodies grow yet");
  if (bodies.has(BodyState::energy)) refuse({"probes"}, "devices have no energy balance yet");
  return found;
}

void refuse_obstacles(const State& state) {
  std::vector<std::string> walls;
  for (std::size_t w = 0; w < state.walls.size(); ++w) walls.push_back(state.walls.name(w));
  if (auto found = device_obstacles(state.settings, walls, state.bodies.state); !found.empty())
    throw PlacedError(std::move(found));
}

}  // namespace grit
