#include "kernel/specimen.hpp"

#include "grit/error.hpp"

namespace grit {

Region specimen_region(const State& state, double margin, SurfaceSide side_of_walls) {
  Region region{state.cell.cell().low, state.cell.cell().high};
  const Walls& walls = state.walls;
  const auto wall = [&](const std::string& name) -> std::size_t {
    for (std::size_t w = 0; w < walls.size(); ++w)
      if (walls.name(w) == name) return w;
    throw Error("the specimen is bounded by wall \"" + name + "\", which does not exist");
  };
  const auto outer = [&](std::size_t w) { return side_of_walls == SurfaceSide::far || walls.geometry(w).hollow(); };
  for (int k = 0; k < 3; ++k) {
    const auto side = [&](const std::vector<std::string>& names) {
      return names.size() == 3 ? names[static_cast<std::size_t>(k)] : std::string();
    };
    if (const std::string name = side(state.settings.specimen.low); !name.empty()) {
      const std::size_t w = wall(name);
      const Bounds bounds = walls.geometry(w).bounds();
      region.low[k] = (outer(w) ? bounds.low : bounds.high)[k] + walls.pose(w).shift[k] + margin;
    }
    if (const std::string name = side(state.settings.specimen.high); !name.empty()) {
      const std::size_t w = wall(name);
      const Bounds bounds = walls.geometry(w).bounds();
      region.high[k] = (outer(w) ? bounds.high : bounds.low)[k] + walls.pose(w).shift[k] - margin;
    }
  }
  return region;
}

void update_cross_section(State& state) {
  if (!state.walls.presses_on_specimen()) return;
  const Region specimen = specimen_region(state, 0);
  state.walls.set_specimen(specimen.high - specimen.low);
}

}  // namespace grit
