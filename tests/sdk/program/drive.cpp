// Drops a ball, follows its height, slows gravity down on the way, and goes on from a checkpoint.
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "grit/simulation.hpp"

int main(int, char** arguments) try {
  grit::Simulation drop = grit::Simulation::open(arguments[1]);
  const grit::Forecast forecast = drop.check();
  std::printf("%zu body, %.3g s a step\n", forecast.bodies, forecast.time_step);

  std::vector<double> heights;
  drop.every_steps(10, [&](const grit::World& world) { heights.push_back(world.positions()[0].z); });
  drop.run_stage();
  std::printf("stage \"fall\": %zu heights, the last %.3g m\n", heights.size(), heights.back());

  drop.set("/engines/gravity/acceleration", {0, 0, -1.0});
  const grit::Checkpoint there = drop.save();
  drop.run();
  const double end = drop.world().positions()[0].z;

  grit::Simulation again = grit::Simulation::open(arguments[1]);
  again.resume(there);
  again.run();
  std::printf("%s after a checkpoint\n", again.world().positions()[0].z == end ? "the same bits" : "other bits");
  return drop.done() && again.done() ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
