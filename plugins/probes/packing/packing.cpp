// Figures of a specimen, and averaging cells. See README.md.
#include "packing.hpp"

#include <algorithm>
#include <cmath>

#include "cell_averages.hpp"
#include "grit/plugin.hpp"
#include "grit/toolkit/specimen.hpp"
#include "grit/toolkit/stress_invariants.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

namespace {

/// Grains that touch grains.
struct Coordination {
  double number = 0, mechanical = 0, rattler_fraction = 0;
};

Coordination coordination(const World& world) {
  struct ContactCounts {
    unsigned grains = 0, walls = 0;
  };
  const Grains grains_here = grains_of(world);
  std::vector<ContactCounts> contacts(grains_here.centre.size());
  const auto of = [&](std::uint32_t body) -> ContactCounts& { return contacts[grains_here.of_body[body]]; };
  for (const auto& contact : world.contacts()) {
    if (contact.with_wall) ++of(contact.a).walls;
    else ++of(contact.a).grains, ++of(contact.b).grains;
  }
  double all = 0, held = 0, of_held = 0;
  for (const auto& grain : contacts) {
    all += grain.grains;
    if (grain.grains + grain.walls >= 2) ++held, of_held += grain.grains;
  }
  const auto grains = static_cast<double>(contacts.size());
  if (contacts.empty()) return {};
  return {all / grains, held > 0 ? of_held / held : 0, 1 - held / grains};
}

struct Figures {
  double void_ratio, void_ratio_overall, coordination_number, coordination_number_mechanical, rattler_fraction,
      mean_stress, deviatoric_stress, kinetic_energy, unbalanced_force, mean_contact_force, inertial_number,
      largest_overlap;
};

/// A channel and where its number comes from.
struct Figure {
  const char *name, *unit, *doc;
  double Figures::*value;
};

constexpr Figure figures[] = {
    {"void_ratio", "1",
     "volume of voids over volume of solids, at least one mean diameter from the walls; infinite without solids",
     &Figures::void_ratio},
    {"void_ratio_overall", "1", "void ratio of the whole specimen, up to the walls; infinite without solids",
     &Figures::void_ratio_overall},
    {"coordination_number", "1", "mean number of contacts per grain: 2 contacts between grains / grains",
     &Figures::coordination_number},
    {"coordination_number_mechanical", "1",
     "mean number of contacts per grain without rattlers (Thornton 2000); 0 if all are rattlers",
     &Figures::coordination_number_mechanical},
    {"rattler_fraction", "1", "fraction of the grains with fewer than two contacts, wall contacts included",
     &Figures::rattler_fraction},
    {"mean_stress", "Pa", "mean stress p of the interior, a third of the trace, positive in compression",
     &Figures::mean_stress},
    {"deviatoric_stress", "Pa", "deviatoric stress q = sqrt(3/2 s:s) of the interior, never negative",
     &Figures::deviatoric_stress},
    {"kinetic_energy", "J", "kinetic energy of translation and rotation of all bodies", &Figures::kinetic_energy},
    {"unbalanced_force", "1", "mean net force of a body over the mean contact force; 0 without contacts",
     &Figures::unbalanced_force},
    {"mean_contact_force", "N", "mean magnitude of the normal force of a contact, walls included",
     &Figures::mean_contact_force},
    {"inertial_number", "1",
     "I = shear rate * d50 * sqrt(density / p), never negative; 0 if p <= 0 or without a shear rate",
     &Figures::inertial_number},
    {"largest_overlap", "m", "largest overlap of a contact, walls included, positive in compression",
     &Figures::largest_overlap},
};

}  // namespace

void PackingProbe::declare(Parameters& parameters) {
  parameters.add("shear_rate", shear_rate)
      .unit("s-1")
      .symbol("gamma_dot")
      .doc("shear rate of the inertial number; default: from driven_by");
  parameters.add("driven_by", driven_by)
      .doc(
          "wall whose speed over the height (z) of the specimen is the shear rate, unless shear_rate is given; empty: "
          "0");
  parameters.add("driven_axis", driven_axis)
      .one_of({"", "x", "y", "z"})
      .doc("component of the velocity of that wall; empty: its magnitude");
  parameters.add("cell_size", cell_size).at_least(0.1).doc("side of an averaging cell over the mean diameter");
  parameters.add("cell_step", cell_step)
      .at_least(0.1)
      .doc("distance between neighbouring averaging cells over the mean diameter");
  parameters.add("depth_axis", depth_axis)
      .one_of({"x", "y", "z"})
      .doc("axis along which a cell extends through the whole specimen");
  parameters.check([this](const Complain& complain) {
    if (shear_rate && !driven_by.empty())
      complain("driven_by", "\"" + driven_by + "\" beside a shear_rate", "one of the two");
  });
}

void PackingProbe::prepare(const World& world) {
  driving_wall_.reset();
  if (!driven_by.empty()) driving_wall_ = wall_index(world, driven_by, "driven_by");
}

std::vector<Channel> PackingProbe::channels() const {
  std::vector<Channel> channels;
  for (const auto& figure : figures) channels.push_back({figure.name, figure.unit, figure.doc, {}});
  channels.push_back({"stress",
                      "Pa",
                      "Love-Weber stress of the interior, row by row (force, branch), positive in compression",
                      {3, 3}});
  return channels;
}

double PackingProbe::shear_rate_of(const World& world) const {
  if (shear_rate) return std::abs(*shear_rate);
  if (!driving_wall_) return 0;
  const Vec3& velocity = world.walls()[*driving_wall_].velocity;
  const Region specimen = specimen_box(world);
  const double height = specimen.high.z() - specimen.low.z();
  const double speed = driven_axis.empty() ? velocity.norm() : std::abs(velocity[driven_axis[0] - 'x']);
  return height > 0 ? speed / height : 0;
}

void PackingProbe::sample(const World& world, ChannelValues& values) {
  const Region interior = interior_box(world);
  const Mat3 stress = grit::mean_stress(world, interior);
  const double p = stress.trace() / 3;
  const auto [coordination_number, mechanical, rattlers] = coordination(world);
  const Equilibrium rest = equilibrium(world);
  double overlap = 0;
  for (const auto& contact : world.contacts()) overlap = std::max(overlap, contact.overlap);

  const Figures now{
      .void_ratio = void_ratio(world, interior),
      .void_ratio_overall = void_ratio(world, specimen_box(world)),
      .coordination_number = coordination_number,
      .coordination_number_mechanical = mechanical,
      .rattler_fraction = rattlers,
      .mean_stress = p,
      .deviatoric_stress = grit::deviatoric_stress(stress),
      .kinetic_energy = rest.kinetic_energy,
      .unbalanced_force = rest.unbalanced_force,
      .mean_contact_force = rest.mean_contact_force,
      .inertial_number =
          p > 0 ? shear_rate_of(world) * world.mean_diameter() * std::sqrt(world.solid_density() / p) : 0,
      .largest_overlap = overlap,
  };
  for (const auto& figure : figures) values[figure.name] = now.*figure.value;
  const auto components = values.list("stress");
  for (int i = 0; i < 9; ++i) components[static_cast<std::size_t>(i)] = stress(i / 3, i % 3);
}

Averaging PackingProbe::averaging() const {
  Averaging averaging;
  averaging.cell_size = cell_size, averaging.cell_step = cell_step, averaging.depth_axis = depth_axis;
  return averaging;
}

void PackingProbe::check_fields(const World& world) const { averaging().check_cells(world, specimen_box(world)); }

std::vector<Field> PackingProbe::fields(const World& world) {
  const AveragingCells cells = averaging().cells(world, specimen_box(world));
  std::vector<Field> fields = map_of(cells);
  Field ratio{"void_ratio", "1", "volume of voids over volume of solids in the cell; infinite without solids", 1, {}};
  Field touching{
      "coordination_number", "1", "mean number of contacts of the grains centred in the cell; 0 without any", 1, {}};
  Field stress{
      "stress", "Pa", "Love-Weber stress of the cell, row by row (force, branch), positive in compression", 9, {}};
  Field solids{"solid_fraction", "1", "volume of solids over that of the cell, 1 / (1 + void ratio)", 1, {}};
  for (const CellAverage& cell : cell_averages(world, cells)) {
    ratio.values.push_back(cell.void_ratio), touching.values.push_back(cell.coordination_number);
    solids.values.push_back(1 / (1 + cell.void_ratio));
    for (int i = 0; i < 9; ++i) stress.values.push_back(cell.stress(i / 3, i % 3));
  }
  for (Field* field : {&ratio, &touching, &stress, &solids}) fields.push_back(std::move(*field));
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "probe",
      .name = "packing",
      .version = "1.0.0",
      .doc = "void ratio, coordination, stress and unbalanced force of the specimen, and averaging cells",
      .make_probe = []() -> grit::Probe* { return new grit::PackingProbe; }};
  return &info;
}
