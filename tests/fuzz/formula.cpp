// Formulas of the probe `formula` and of the engine `force-field`.
#include "fuzz.hpp"
#include "simulation/no_recorder.hpp"
#include "support/recorded.hpp"

namespace grit::fuzz {
namespace {

Description scene() {
  return test::description("linear-rolling", {{"contact_modulus", 1e6}, {"density", 2600}},
                           {{{0, 0, 0}, 1e-3}, {{0, 0, 1.99e-3}, 1e-3}});
}

void run(const Description& description) {
  NoRecorder recorder;
  Simulation simulation = test::recorded(test::scene_of(description), recorder);
  simulation.run();
}

}  // namespace
}  // namespace grit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  const std::string formula(fuzz::text_of_input(data, size));
  try {
    Description(formula).dump();
  } catch (const Description::exception&) {
    return 0;  // not UTF-8: no description can hold it
  }
  Description probe = fuzz::scene(), engine = fuzz::scene();
  probe["probes"]["curve"] = {{"type", "formula"}, {"every_steps", 1}};
  probe["probes"]["curve"]["curves"]["y"] = {{"formula", formula}, {"unit", "1"}};
  engine["engines"]["field"] = {{"type", "force-field"}, {"x", formula}};
  fuzz::allow_refusal([&] { fuzz::run(probe); });
  fuzz::allow_refusal([&] { fuzz::run(engine); });
  return 0;
}
