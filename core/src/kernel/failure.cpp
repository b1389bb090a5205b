#include "kernel/failure.hpp"

#include "format/number.hpp"

namespace grit {

void fail(const State& state, Guard guard, const Keys& keys, const std::string& what, const std::string& advice) {
  throw NumericsError("step " + std::to_string(state.time.step) + ", time " + number(state.time.time) + " s" +
                          (state.stage.empty() ? "" : ", stage \"" + state.stage + "\""),
                      what + (advice.empty() ? "" : "; " + advice), guard, keys);
}

void fail_at_body(const State& state, Guard guard, const Keys& keys, std::size_t body, const std::string& what,
                  const std::string& advice) {
  const Vec3 x = xyz(state.bodies.position[body]);
  fail(state, guard, keys,
       "body " + std::to_string(state.bodies.id[body]) + " at (" + number(x.x()) + ", " + number(x.y()) + ", " +
           number(x.z()) + ") m " + what,
       advice);
}

Keys group_keys(const State& state, std::size_t body) {
  const std::string group = state.bodies.group_of(state.bodies.id[body]);
  return group.empty() ? Keys{"bodies"} : Keys{"bodies", group};
}

}  // namespace grit
