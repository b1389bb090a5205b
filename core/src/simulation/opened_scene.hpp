// A description that was read, with its components, before its bodies are made.
#pragma once

#include <memory>

#include "input/scene.hpp"
#include "kernel/prepared.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

/// Members are made in this order; later ones refer to earlier ones.
struct OpenedScene {
  /// Makes the components of a scene that was read with this registry. Throws DescriptionError with every fault;
  /// PluginError.
  OpenedScene(std::shared_ptr<const Registry> plugins, Scene read);
  /// From which a simulation starts: the bodies of the description or of its sample, with the state requested by
  /// components and by `more`. Throws DescriptionError, FileError.
  Prepared prepare(StateRequest more = {}) const;
  /// The same for a simulation that resumes: no bodies. They are in the checkpoint, as are walls and cell of a sample,
  /// so that nothing is read.
  Prepared prepare_to_resume(StateRequest more = {}) const;

  std::shared_ptr<const Registry> registry;
  Scene scene;
  LiveScene live;
};

}  // namespace grit
