#include "description/probes.hpp"

namespace grit {

void ProbeDescription::declare(Parameters& p) {
  p.choose(probe);
  cadence.declare(p);
  p.add("groups", groups)
      .doc(
          "names of the groups of bodies sampled: these bodies, their contacts with each other and with walls, and "
          "their loads on walls; empty: all");
  p.add("stages", stages).doc("names of the stages sampled; empty: all");
  p.add("frames", frames).doc("whether its fields are written to frames");
}

}  // namespace grit
