#include "motion/motion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace grit {
namespace {

Quad quad(const Vec3& v) { return Quad{v.x(), v.y(), v.z(), 0}; }

/// Local damping: reduces components that accelerate the body, increases those that decelerate it; no effect at rest.
Quad damped(const Quad& force, const Quad& velocity, double coefficient) {
  const Quad power = force * velocity;
  const Quad less = force * (1 - coefficient), more = force * (1 + coefficient);
  return power > 0 ? less : power < 0 ? more : force;
}

/// The reduction of the force over the damping coefficient; `push` has the signs of the force.
Quad taken(const Quad& force, const Quad& push, const Quad& velocity) {
  const Quad power = push * velocity, none{};
  return power > 0 ? force : power < 0 ? -force : none;
}

Quad absolute(const Quad& a) { return a < 0 ? -a : a; }

/// Accumulates rotations of a body, if requested.
void turn_on(Vec3* turned, std::size_t body, const Quad& spin, const Quad& drift) {
  if (turned == nullptr) return;
  const Quad angle = spin * drift;
  for (int k = 0; k < 3; ++k) turned[body][k] += angle[k];
}

double product(const Quad& a, const Quad& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Which energies are summed up. Compile-time constants: otherwise the compiler divides for every body even if the
/// result is not needed, and these divisions are the main cost of an energy balance.
enum class EnergyTerms { none, without_weight, with_weight, with_flow };

/// Not inlined: with all variants in one function, their constants would be in memory.
template <EnergyTerms energies, bool Clumps, bool Shears>
[[gnu::noinline]] Motion move(std::size_t chunk, Bodies& bodies, const BodySum* sum, const MotionStep& step) {
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  const MotionSettings& settings = step.settings;
  const Quad rate = quad(step.strain_rate), centre = quad(step.centre);
  // The mean flow at a body changes as the body moves with it; without this term, bodies would lag behind the cell's
  // sides.
  const Quad growth = rate * step.flowed;
  [[maybe_unused]] const double xy = step.shear_rate[0], xz = step.shear_rate[1], yz = step.shear_rate[2];
  // Of velocities that the gradients xy, xz and yz add.
  [[maybe_unused]] const auto sheared = [&](const Quad& place) {
    return Quad{xy * place[1] + xz * place[2], yz * place[2], 0, 0};
  };
  // The fourth number of a row (radius, 1/mass, 1/inertia) is unchanged.
  const Quad free = quad(step.free_translation());
  const Quad kick = step.kick * free, turn_kick = step.kick * quad(step.free_rotation());
  const Quad fall = free * quad(Vec3(settings.gravity * step.kick));
  const Quad drift{step.drift, step.drift, step.drift, 0};
  const double damping = settings.local_damping;
  constexpr bool flows = energies == EnergyTerms::with_flow, falls = flows || energies == EnergyTerms::with_weight;
  const Quad weight = quad(settings.gravity);
  Quad fastest{}, poison{}, damped_power{}, damped_turning{}, momentum{}, flow_power{}, flow_work{};
  double fastest_carried = 0;
  // Local copies of the pointers: for the compiler, stores might alias them.
  Row *const position = bodies.position.data(), *const velocity = bodies.velocity.data(),
             *const spin = bodies.spin.data();
  Vec3* const turned = bodies.rotation.empty() ? nullptr : bodies.rotation.data();
  for (std::size_t i = first; i < last; ++i) {
    if constexpr (Clumps)
      if (bodies.clumps.of_body[i].clump != no_clump) {
        const Quad v = load(velocity[i]), before = load(position[i]) - v * drift;
        Quad against = v - rate * (before - centre);
        if constexpr (Shears) against -= sheared(before - centre);
        fastest_carried = std::max(fastest_carried, product(against, against));
        poison += v * 0.0 + load(spin[i]) * 0.0;
        turn_on(turned, i, load(spin[i]), drift);
        continue;
      }
    const Quad force = load(sum[i].force), moment = load(sum[i].moment);
    Quad x = load(position[i]), v = load(velocity[i]), w = load(spin[i]);
    const double inverse_mass = velocity[i].w, inverse_inertia = spin[i].w;
    const Quad before = v;
    v += growth * v;
    Quad flow = rate * (x - centre);
    if constexpr (Shears) v += step.flowed * sheared(before), flow += sheared(x - centre);
    Quad push = force * (kick * inverse_mass) + fall;
    Quad twist = moment * (turn_kick * inverse_inertia);
    const double mass = falls ? 1 / inverse_mass : 0;
    if (damping > 0) {
      const Quad pushed = damped(push, v - flow, damping), twisted = damped(twist, w, damping);
      if constexpr (energies != EnergyTerms::none) {
        const Quad less = taken(falls ? force + weight * mass : force, push, v - flow);
        damped_power += less * (v - flow + 0.5 * pushed);
        if constexpr (flows) flow_power -= less * flow;
        damped_turning += taken(moment, twist, w) * (w + 0.5 * twisted);
      }
      push = pushed, twist = twisted;
    }
    v += push, w += twist;
    x += v * drift;
    if constexpr (falls) momentum += v * mass;
    if constexpr (flows) flow_work += 0.5 * mass * (growth * before) * (before + v);
    if constexpr (flows && Shears) flow_work += 0.5 * mass * step.flowed * sheared(before) * (before + v);
    store(x, position[i]), store(v, velocity[i]), store(w, spin[i]);
    turn_on(turned, i, w, drift);
    const Quad speed = absolute(v - flow);
    fastest = speed > fastest ? speed : fastest;
    poison += v * 0.0 + w * 0.0;
  }
  const double fastest_free = std::sqrt(fastest[0] * fastest[0] + fastest[1] * fastest[1] + fastest[2] * fastest[2]);
  return {std::max(fastest_free, std::sqrt(fastest_carried)), poison[0] == 0 && poison[1] == 0 && poison[2] == 0,
          damping * (product(damped_power, kick) + product(damped_turning, turn_kick)),
          step.drift * product(momentum, quad(settings.gravity)),
          damping * product(flow_power, kick) + product(flow_work, Quad{1, 1, 1, 0})};
}

}  // namespace

Vec3 MotionStep::free_translation() const {
  Vec3 free = settings.hold_translation ? Vec3::Zero() : Vec3::Ones();
  if (settings.flat) free[*settings.flat] = 0;
  return free;
}

Vec3 MotionStep::free_rotation() const {
  if (settings.hold_rotation) return Vec3::Zero();
  return settings.flat ? Vec3(Vec3::Unit(*settings.flat)) : Vec3(Vec3::Ones());
}

Motion move_bodies(std::size_t chunk, Bodies& bodies, const BodySum* sum, const MotionStep& step) {
  const auto with = [&]<EnergyTerms energies>() {
    return bodies.clumps.none() ? move<energies, false, false>(chunk, bodies, sum, step)
                                : move<energies, true, false>(chunk, bodies, sum, step);
  };
  if (step.shears()) {
    const auto sheared = [&]<EnergyTerms energies>() {
      return bodies.clumps.none() ? move<energies, false, true>(chunk, bodies, sum, step)
                                  : move<energies, true, true>(chunk, bodies, sum, step);
    };
    return step.energies ? sheared.operator()<EnergyTerms::with_flow>() : sheared.operator()<EnergyTerms::none>();
  }
  if (!step.energies) return with.operator()<EnergyTerms::none>();
  if (step.flows()) return with.operator()<EnergyTerms::with_flow>();
  return step.settings.gravity.isZero(0.0) ? with.operator()<EnergyTerms::without_weight>()
                                           : with.operator()<EnergyTerms::with_weight>();
}

}  // namespace grit
