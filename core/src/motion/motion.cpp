#include "motion/motion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "motion/body_step.hpp"
#include "motion/rigid_step.hpp"

namespace grit {
namespace {

/// The reduction of the force over the damping coefficient; `push` has the signs of the force.
Quad taken(const Quad& force, const Quad& push, const Quad& velocity) {
  const Quad power = push * velocity, none{};
  return power > 0 ? force : power < 0 ? -force : none;
}

/// Bound of no body's velocity.
constexpr double unbounded = std::numeric_limits<double>::max();

/// Accumulates rotations of a body, if requested.
void turn_on(Vec3* turned, std::size_t body, const Quad& spin, const Quad& drift) {
  if (turned == nullptr) return;
  const Quad angle = spin * drift;
  for (int k = 0; k < 3; ++k) turned[body][k] += angle[k];
}

double product(const Quad& a, const Quad& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The same, with what only the energies of these bodies depend on.
struct KickOfGroup : Kick<Quad> {
  Quad weight;
  std::optional<RigidStep> prescribed;

  KickOfGroup(const MotionSettings& settings, const MotionStep& step)
      : Kick<Quad>(kick_of<Quad>(settings, step)), weight(as_four<Quad>(settings.gravity)) {
    if (settings.prescribed) prescribed.emplace(*settings.prescribed, step.drift);
  }
};

/// Which energies are summed up. Compile-time constants: otherwise the compiler divides for every body even if the
/// result is not needed, and these divisions are the main cost of an energy balance.
enum class EnergyTerms { none, without_weight, with_weight, with_flow };

/// Not inlined: with all variants in one function, their constants would be in memory.
template <EnergyTerms energies, bool Clumps, bool Groups, bool Shears>
[[gnu::noinline]] Motion move(std::size_t chunk, Bodies& bodies, const BodySum* sum, const MotionStep& step) {
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  // Local copies: for the compiler, stores might alias members.
  const auto mean = mean_flow_of<Quad>(step);
  const auto flow_at = [&](const Quad& place) {
    Quad flow = mean.rate * (place - mean.centre);
    if constexpr (Shears) flow += mean.sheared(place - mean.centre);
    return flow;
  };
  std::vector<KickOfGroup> by_group;
  if constexpr (Groups)
    for (const MotionSettings& settings : step.by_group) by_group.emplace_back(settings, step);
  const KickOfGroup same(step.settings, step);
  const Kick<Quad> kick_of_all = same;
  const Quad weight_of_all = same.weight;
  const Quad drift{step.drift, step.drift, step.drift, 0}, ones{1, 1, 1, 0};
  constexpr bool flows = energies == EnergyTerms::with_flow, falls = flows || energies == EnergyTerms::with_weight;
  Quad low{unbounded, unbounded, unbounded, 0}, high = -low;
  const auto bound = [&](const Quad& relative) {
    low = relative < low ? relative : low, high = relative > high ? relative : high;
  };
  Quad poison{}, damped_power{}, damped_turning{}, momentum{}, flow_power{}, flow_work{};
  double prescribed = 0;
  // Local copies of the pointers: for the compiler, stores might alias them.
  Row *const position = bodies.position.data(), *const velocity = bodies.velocity.data(),
             *const spin = bodies.spin.data();
  Vec3* const turned = bodies.rotation.empty() ? nullptr : bodies.rotation.data();
  for (std::size_t i = first; i < last; ++i) {
    if constexpr (Clumps)
      if (bodies.clumps.of_body[i].clump != no_clump) {
        const Quad v = load(velocity[i]), before = load(position[i]) - v * drift;
        bound(v - flow_at(before));
        poison += v * 0.0 + load(spin[i]) * 0.0;
        turn_on(turned, i, load(spin[i]), drift);
        continue;
      }
    const KickOfGroup& own = Groups ? by_group[step.group[i]] : same;
    if constexpr (Groups)
      if (own.prescribed) {
        const Quad v_before = load(velocity[i]), w_before = load(spin[i]), x = load(position[i]);
        const double inverse_mass = velocity[i].w, inverse_inertia = spin[i].w;
        Quad v = as_four<Quad>(own.prescribed->velocity_at(xyz(position[i]))),
             w = as_four<Quad>(own.prescribed->spin());
        prescribed += 0.5 * (product(v, v) - product(v_before, v_before)) / inverse_mass +
                      0.5 * (product(w, w) - product(w_before, w_before)) / inverse_inertia;
        if constexpr (falls) momentum += v * own.weight * weighing_share(x[3], own.scaled_radius) / inverse_mass;
        bound(v - flow_at(x));
        turn_on(turned, i, w, drift);
        v[3] = inverse_mass, w[3] = inverse_inertia;
        store(x + v * drift, position[i]), store(v, velocity[i]), store(w, spin[i]);
        continue;
      }
    const Kick<Quad>& kick = Groups ? own : kick_of_all;
    const Quad weight = Groups ? own.weight : weight_of_all;
    const Quad force = load(sum[i].force), moment = load(sum[i].moment);
    const Quad x = load(position[i]), before = load(velocity[i]), w = load(spin[i]);
    const double inverse_mass = velocity[i].w, inverse_inertia = spin[i].w;
    const double share = weighing_share(x[3], kick.scaled_radius);
    const BodyStep<Quad> own_step =
        step_of_body<Shears>(x, before, w, force, moment, inverse_mass, inverse_inertia, share, kick, mean);
    const auto& [flow, free, push, pushed, twist, twisted] = own_step;
    const double mass = falls ? 1 / inverse_mass : 0, weighing = mass * share;
    if constexpr (energies != EnergyTerms::none)
      if (kick.damping > 0) {
        // Sums of bodies with the same settings are multiplied by these at the end.
        const Quad lost = Groups ? kick.damping * kick.kick : ones,
                   lost_by_turning = Groups ? kick.damping * kick.turn_kick : ones;
        const Quad less = lost * taken(falls ? force + weight * weighing : force, push, free - flow);
        damped_power += less * (free - flow + 0.5 * pushed);
        if constexpr (flows) flow_power -= less * flow;
        damped_turning += lost_by_turning * taken(moment, twist, w) * (w + 0.5 * twisted);
      }
    const Quad v = free + pushed, turning = w + twisted;
    if constexpr (falls) momentum += Groups ? v * weighing * weight : v * weighing;
    if constexpr (flows) flow_work += 0.5 * mass * (mean.growth * before) * (before + v);
    if constexpr (flows && Shears) flow_work += 0.5 * mass * mean.flowed * mean.sheared(before) * (before + v);
    store(x + v * drift, position[i]), store(v, velocity[i]), store(turning, spin[i]);
    turn_on(turned, i, turning, drift);
    bound(v - flow);
    poison += v * 0.0 + turning * 0.0;
  }
  const Quad kick = Groups ? ones : same.kick, turn_kick = Groups ? ones : same.turn_kick,
             weight = Groups ? ones : same.weight;
  const double damping = Groups ? 1 : same.damping;
  return {first < last ? VelocityRange{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}} : VelocityRange{},
          poison[0] == 0 && poison[1] == 0 && poison[2] == 0,
          damping * (product(damped_power, kick) + product(damped_turning, turn_kick)),
          step.drift * product(momentum, weight),
          damping * product(flow_power, kick) + product(flow_work, ones),
          prescribed};
}

}  // namespace

bool MotionStep::falls() const {
  const auto falls = [](const MotionSettings& one) { return !one.gravity.isZero(0.0); };
  return by_group.empty() ? falls(settings) : std::ranges::any_of(by_group, falls);
}

Motion move_bodies(std::size_t chunk, Bodies& bodies, const BodySum* sum, const MotionStep& step) {
  const auto with = [&]<EnergyTerms energies, bool shears = false>() {
    const bool clumps = !bodies.clumps.none();
    if (!step.by_group.empty())
      return clumps ? move<energies, true, true, shears>(chunk, bodies, sum, step)
                    : move<energies, false, true, shears>(chunk, bodies, sum, step);
    return clumps ? move<energies, true, false, shears>(chunk, bodies, sum, step)
                  : move<energies, false, false, shears>(chunk, bodies, sum, step);
  };
  if (step.shears())
    return step.energies ? with.operator()<EnergyTerms::with_flow, true>() : with.operator()<EnergyTerms::none, true>();
  if (!step.energies) return with.operator()<EnergyTerms::none>();
  if (step.flows()) return with.operator()<EnergyTerms::with_flow>();
  return step.falls() ? with.operator()<EnergyTerms::with_weight>() : with.operator()<EnergyTerms::without_weight>();
}

}  // namespace grit
