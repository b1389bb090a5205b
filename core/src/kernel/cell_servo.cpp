#include "kernel/cell_servo.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace grit {
namespace {

constexpr double most_behind = 0.05;
// Evaluations over which strain rates are averaged. Fewer make a soft packing oscillate: with a tangent stiffness of
// 1 % of that of the mean flow, 100 damp by half of the critical value, 10 by a sixth.
constexpr double habit_evaluations = 100;

/// Stress of a cell and its change with strain if all bodies move with the mean flow, times the volume [N m].
struct Response {
  CellRates stress = CellRates::Zero();
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  friend Response operator+(const Response& a, const Response& b) {
    return {a.stress + b.stress, a.stiffness + b.stiffness};
  }
};

/// Components of f l, for forces and branches alike, in the order of CellRates.
CellRates products(const Vec3& f, const Vec3& l) {
  return (CellRates() << f.x() * l.x(), f.y() * l.y(), f.z() * l.z(), f.x() * l.y(), f.x() * l.z(), f.y() * l.z())
      .finished();
}

/// Adds a contact with this unit normal and branch [m], force on its far end [N] and stiffness.
void add(Response& all, const Vec3& normal, const Vec3& branch, const Vec3& force, const Stiffness& k) {
  all.stress += products(force, branch);
  // The ends move by the gradient times the branch: along the normal, and in each direction for the shear spring.
  const CellRates along = products(normal, branch);
  all.stiffness += (k.normal - k.shear) * along * along.transpose();
  for (int axis = 0; axis < 3; ++axis) {
    const CellRates across = products(Vec3::Unit(axis), branch);
    all.stiffness += k.shear * across * across.transpose();
  }
}

Response response_of_chunk(const State& state, std::size_t chunk) {
  Response all;
  const Bodies& bodies = state.bodies;
  // Branches are between the centres of clumps.
  const auto arm = [&](std::uint32_t body) -> Vec3 {
    const std::uint32_t c = bodies.clumps.clump_of(body);
    return c == no_clump ? Vec3(Vec3::Zero()) : Vec3(bodies.clumps.clump[c].axes * bodies.clumps.of_body[body].place);
  };
  state.pairs.each_contact(chunk, state.instant(true), [&](std::size_t c, const ContactRow& row) {
    const std::uint32_t a = state.pairs.a(c), b = state.pairs.b(c);
    const Vec3 centres = state.pairs.branch(c, bodies, state.cell.images());
    const PairSize size{.radius_a = bodies.position[a].w,
                        .radius_b = bodies.position[b].w,
                        .inverse_mass_a = bodies.velocity[a].w,
                        .inverse_mass_b = bodies.velocity[b].w,
                        .overlap = std::max(0.0, row.moment.w)};
    add(all, centres.normalized(), centres + arm(a) - arm(b), xyz(row.force),
        state.settings.law->stiffness(size, bodies.material[a], bodies.material[b]));
  });
  state.wall_contacts.each(chunk, [&](const WallContacts::Touching& t) {
    const std::uint32_t a = t.contact->body;
    const double radius = bodies.position[a].w;
    const PairSize size{.radius_a = radius,
                        .radius_b = radius,
                        .inverse_mass_a = bodies.velocity[a].w,
                        .inverse_mass_b = 0,
                        .overlap = std::max(0.0, t.contact->overlap),
                        .wall = true};
    add(all, t.contact->normal, (radius - t.contact->overlap) * t.contact->normal + arm(a), xyz(t.row->force),
        state.settings.law->stiffness(size, bodies.material[a], t.contact->material));
  });
  return all;
}

/// Stress and stiffness of the cell [Pa].
Response response(const State& state, Passes& passes) {
  const Response all = passes.sum([&](std::size_t chunk) { return response_of_chunk(state, chunk); });
  const double volume = state.cell.lengths().prod();
  return {all.stress / volume, all.stiffness / volume};
}

CellRates present_rates(const State& state) {
  CellRates rates;
  rates << state.cell.cell().strain_rate, state.cell.cell().shear_rate;
  return rates;
}

}  // namespace

bool CellServo::due(const State& state) {
  const auto& servo = state.settings.cell_servo;
  return servo && state.time.step % static_cast<std::uint64_t>(servo->interval) == 0;
}

CellRates CellServo::rates(const State& state, Passes& passes) {
  const CellServoDescription& servo = *state.settings.cell_servo;
  const auto targets = servo.targets();
  const Response now = response(state, passes);
  const double time = static_cast<double>(servo.interval) * state.time.dt;
  CellRates rates = present_rates(state);
  for (int k = 0; k < 6; ++k) {
    const auto& target = targets[static_cast<std::size_t>(k)];
    if (!target) {
      habit_[k] = 0;
      continue;
    }
    // A strain changes other stresses, too. The sum bounds the eigenvalues of the whole.
    double stiffness = 0;
    for (int other = 0; other < 6; ++other)
      if (targets[static_cast<std::size_t>(other)]) stiffness += std::abs(now.stiffness(k, other));
    const double missing = *target - now.stress[k], most = servo.max_strain_rate;
    const double wanted = habit_[k] - (missing == 0 ? 0 : servo.gain * missing / (stiffness * time));
    rates[k] = std::clamp(wanted, -most, most);
    // At the limit the average would delay the reaction when the stress is reached.
    habit_[k] = rates[k] == wanted ? habit_[k] + (rates[k] - habit_[k]) / habit_evaluations : 0;
  }
  return rates;
}

CellRates prescribed_rates(const State& state) {
  CellRates rates;
  rates << state.settings.strain_rate, state.settings.shear_rate;
  if (!state.settings.cell_servo) return rates;
  const auto targets = state.settings.cell_servo->targets();
  const CellRates present = present_rates(state);
  for (int k = 0; k < 6; ++k)
    if (targets[static_cast<std::size_t>(k)]) rates[k] = present[k];
  return rates;
}

void change_rates(State& state, const CellRates& rates) {
  const Cell& cell = state.cell.cell();
  const Vec3 strain = rates.head<3>(), shear = rates.tail<3>();
  const Vec3 change = strain - cell.strain_rate, change_of_shear = shear - cell.shear_rate;
  const bool shears = !change_of_shear.isZero(0.0), skewed = shears || cell.skewed();
  if (change.isZero(0.0) && !shears) return;
  Bodies& bodies = state.bodies;
  const Vec3 centre = state.cell.centre(), period = state.cell.lengths();
  const auto flow = [&](const Vec3& place) -> Vec3 {
    const Vec3 stretching = change.cwiseProduct(place - centre);
    return shears ? Vec3(stretching + DeformingCell::shear_flow(change_of_shear, place - centre)) : stretching;
  };
  for (Clump& clump : bodies.clumps.clump) clump.velocity += flow(clump.centre);
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    Vec3 v = flow(xyz(bodies.position[i]));
    if (const std::uint32_t c = bodies.clumps.clump_of(i); c != no_clump) {
      const auto& periods = bodies.clumps.of_body[i].periods;
      v = flow(bodies.clumps.clump[c].centre);
      for (int k = 0; k < 3; ++k)
        if (cell.periodic[as_index(k)]) v[k] -= periods[as_index(k)] * change[k] * period[k];
      if (skewed) {
        const Vec3 growth = DeformingCell::tilt_rate(period, cell.tilt, change, change_of_shear);
        v -= DeformingCell::columns(Vec3::Zero(), growth) * Vec3(periods[0], periods[1], periods[2]);
      }
    }
    bodies.velocity[i] += Row{v.x(), v.y(), v.z(), 0};
  }
  state.cell.set_rates(strain, shear, state.time.previous_dt);
}

std::string cell_servo_behind(const State& state, Passes& passes) {
  if (!state.settings.cell_servo) return "";
  const CellServoDescription& servo = *state.settings.cell_servo;
  const auto targets = servo.targets();
  const CellRates stress = response(state, passes).stress, rates = present_rates(state);
  std::string words;
  for (int k = 0; k < 6; ++k) {
    const auto& target = targets[static_cast<std::size_t>(k)];
    if (!target || std::abs(rates[k]) < (1 - 1e-9) * servo.max_strain_rate ||
        std::abs(stress[k] - *target) <= most_behind * std::abs(*target))
      continue;
    words += fmt::format(
        "{}servo of the cell is limited by its max_strain_rate of {:g} 1/s: stress {} {:.4g} Pa, target {:.4g}",
        words.empty() ? "" : "; ", servo.max_strain_rate, cell_components[static_cast<std::size_t>(k)], stress[k],
        *target);
  }
  return words;
}

}  // namespace grit
