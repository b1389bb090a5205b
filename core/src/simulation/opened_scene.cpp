#include "simulation/opened_scene.hpp"

#include <utility>

#include "bodies/make_bodies.hpp"
#include "simulation/first_instant.hpp"
#include "simulation/prepared_sample.hpp"

namespace grit {

OpenedScene::OpenedScene(std::shared_ptr<const Registry> plugins, Scene read)
    : registry(std::move(plugins)), scene(std::move(read)), live(scene) {}

Prepared OpenedScene::prepare(StateRequest more) const {
  return at_first_instant(scene.document,
                          [&] { return grit::prepare(live, *registry, requested_state(live.components(), more)); });
}

Prepared OpenedScene::prepare_to_resume(StateRequest more) const {
  Bodies none;
  none.finish(requested_state(live.components(), more));
  return none;
}

}  // namespace grit
