// Components of plugins as the kernel calls them: an exception out of any function, and a value that it must not
// return, names the plugin and the function.
#pragma once

#include <memory>
#include <string>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"
#include "grit/scenario.hpp"

namespace grit {

/// A component that passes every call to `made`, which it owns. Exceptions, and faults of what is returned (see
/// plugins/returned.hpp), become a PluginError that begins with `title`. Clumps, and bounds of geometries, are read
/// once. Those by which a function refuses parameters or a checkpoint pass: see grit/error.hpp. A probe with
/// LimitedFields has them still.
std::shared_ptr<BodyKind> guarded(std::shared_ptr<BodyKind> made, std::string title);
std::shared_ptr<ContactLaw> guarded(std::shared_ptr<ContactLaw> made, std::string title);
std::shared_ptr<Engine> guarded(std::shared_ptr<Engine> made, std::string title);
std::shared_ptr<Geometry> guarded(std::shared_ptr<Geometry> made, std::string title);
std::shared_ptr<Probe> guarded(std::shared_ptr<Probe> made, std::string title);
std::shared_ptr<Scenario> guarded(std::shared_ptr<Scenario> made, std::string title);

}  // namespace grit
