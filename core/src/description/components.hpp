// The live plugins of a scene, by their names in the description.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"

namespace grit {

/// `simulation` makes them and keeps them consistent with the description. Geometries are prepared and immutable: a
/// wall that changes its shape gets a new one. All others keep their instance.
struct Components {
  std::shared_ptr<ContactLaw> law;
  std::map<std::string, std::shared_ptr<const BodyKind>> body_kinds;
  std::map<std::string, std::shared_ptr<const Geometry>> geometries;
  std::map<std::string, std::shared_ptr<Engine>> engines;
  std::map<std::string, std::shared_ptr<Probe>> probes;
};

}  // namespace grit
