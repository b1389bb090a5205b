#include "description/engines.hpp"

namespace grit {

void EngineDescription::declare(Parameters& p) {
  p.choose(engine);
  p.add("groups", groups).doc("names of the groups of bodies on which it acts; empty: all");
}

}  // namespace grit
