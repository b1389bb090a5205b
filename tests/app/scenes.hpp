// Small descriptions that run almost instantly.
#pragma once

namespace grit {

/// Two grains that push each other apart: 200 steps.
inline constexpr auto two_grains = R"({
  "title": "two grains",
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600}},
  "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [
    {"position": [0, 0, 0], "radius": "1 mm"},
    {"position": ["1.999 mm", 0, 0], "radius": "1 mm"}
  ]}}},
  "stages": [{"name": "part", "until": {"type": "steps", "value": 200}, "limit": "1 s"}],
  "probes": {"packing": {"type": "packing", "every_steps": 10}},
  "output": {"frames": {"every_steps": 100}, "summary": ["packing/kinetic_energy"]}
}
)";

}  // namespace grit
