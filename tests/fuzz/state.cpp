// Altered states of checkpoints, with right checksums. An input is a list of changes of a state that grit wrote:
// records of twelve bytes, a place and the number that is written there.
#include <cstring>

#include "fuzz.hpp"
#include "simulation/no_recorder.hpp"
#include "support/packing.hpp"
#include "support/recorded.hpp"

namespace grit::fuzz {
namespace {

/// Grains that fall on a floor in a periodic cell, and a probe that keeps data.
Description scene() {
  const double spacing = 1e-3;
  Description d = test::description("linear-rolling", {{"contact_modulus", 1e6}, {"density", 2600}},
                                    test::jumble({4, 4, 4}, spacing, 0.1, 6));
  d["walls"]["floor"] = test::plane({0, 0, -0.5e-3}, Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["domain"] = {{"low", {0, 0, -0.01}}, {"high", {4 * spacing, 4 * spacing, 0.02}}, {"periodic", {true, true, false}}};
  d["probes"]["force-chains"] = {{"type", "force-chains"}, {"every_steps", 7}};
  d["probes"]["packing"] = {{"type", "packing"}, {"every_steps", 5}};
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  d["stages"] = {{{"name", "fall"}, {"until", {{"type", "steps"}, {"value", 100000}}}, {"limit", 10}}};
  return d;
}

const Checkpoint& saved() {
  static const Checkpoint checkpoint = [] {
    NoRecorder recorder;
    Simulation simulation = test::recorded(test::scene_of(scene()), recorder);
    simulation.step(60);
    return simulation.save();
  }();
  return checkpoint;
}

}  // namespace
}  // namespace grit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  Checkpoint altered = fuzz::saved();
  for (; size >= 12; data += 12, size -= 12) {
    std::uint32_t place = 0;
    std::uint64_t number = 0;
    std::memcpy(&place, data, sizeof place), std::memcpy(&number, data + sizeof place, sizeof number);
    std::memcpy(altered.state.data() + place % (altered.state.size() - sizeof number), &number, sizeof number);
  }
  fuzz::allow_refusal([&] {
    NoRecorder recorder;
    Simulation simulation = test::recorded(test::scene_of(fuzz::scene()), recorder);
    simulation.resume(altered);
    simulation.step(8);
  });
  return 0;
}
