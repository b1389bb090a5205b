// Statistics of contact forces and directions. See README.md.
#include "force-chains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "grit/plugin.hpp"

namespace grit {

namespace {

double mean_normal_force(const std::vector<const Contact*>& contacts) {
  double sum = 0;
  for (const auto* contact : contacts) sum += contact->normal_force;
  return contacts.empty() ? 0 : sum / static_cast<double>(contacts.size());
}

/// The bin of a direction; bin 0 begins at the first axis of the plane.
std::size_t bin_of(double first, double second) {
  constexpr double width = 2 * std::numbers::pi / ForceChainsProbe::bins;
  const double angle = std::atan2(second, first);
  return static_cast<std::size_t>(std::floor(angle / width) + ForceChainsProbe::bins) % ForceChainsProbe::bins;
}

}  // namespace

void ForceChainsProbe::declare(Parameters& parameters) {
  parameters.add("plane", plane)
      .one_of({"xy", "yx", "xz", "zx", "yz", "zy"})
      .doc("plane of the directions; angles count from its first axis towards its second");
  parameters.add("with_walls", with_walls).doc("whether touches of walls count beside contacts between grains");
}

std::vector<Channel> ForceChainsProbe::channels() const {
  return {{"mean_normal_force", "N", "mean normal force of a contact, positive in compression; 0 without contacts", {}},
          {"share_above_mean", "1", "share of the contacts whose normal force is above the mean", {}},
          {"force_by_direction",
           "N",
           "mean normal force of the contacts in each 10 degrees of direction in the plane, the first from 0 to 10 "
           "degrees, positive in compression; 0 where there are none",
           {bins}},
          {"contacts_by_direction",
           "1",
           "number of contacts in each 10 degrees of direction in the plane; a contact counts in both of its "
           "directions",
           {bins}},
          {"anisotropy", "1", "amplitude a of E = (1 + a cos 2(theta - theta_a)) / 2 pi, fitted to the directions", {}},
          {"anisotropy_direction",
           "rad",
           "direction theta_a that most contacts prefer, from the first axis of the plane towards the second, "
           "-pi/2 to pi/2",
           {}}};
}

std::vector<const Contact*> ForceChainsProbe::counted(const World& world) const {
  std::vector<const Contact*> contacts;
  contacts.reserve(world.contacts().size());
  for (const auto& contact : world.contacts())
    if (with_walls || !contact.with_wall) contacts.push_back(&contact);
  return contacts;
}

void ForceChainsProbe::sample(const World& world, std::span<const std::span<double>> values) {
  const auto contacts = counted(world);
  const double mean = mean_normal_force(contacts);
  const int first = plane[0] - 'x', second = plane[1] - 'x';

  std::array<double, bins> force{}, count{};
  double above = 0, directed = 0, cosines = 0, sines = 0;
  for (const auto* contact : contacts) {
    if (contact->normal_force > mean) ++above;
    const double x = contact->normal[first], y = contact->normal[second], square = x * x + y * y;
    if (square < 1e-12) continue;  // at right angles to the plane: no direction in it
    const std::size_t bin = bin_of(x, y), opposite = (bin + bins / 2) % bins;
    for (const std::size_t i : {bin, opposite}) force[i] += contact->normal_force, ++count[i];
    ++directed;
    cosines += (x * x - y * y) / square;
    sines += 2 * x * y / square;
  }
  for (std::size_t i = 0; i < bins; ++i)
    if (count[i] > 0) force[i] /= count[i];

  values[0][0] = mean;
  values[1][0] = contacts.empty() ? 0 : above / static_cast<double>(contacts.size());
  std::copy(force.begin(), force.end(), values[2].begin());
  std::copy(count.begin(), count.end(), values[3].begin());
  values[4][0] = directed > 0 ? 2 * std::hypot(cosines, sines) / directed : 0;
  values[5][0] = 0.5 * std::atan2(sines, cosines);
}

std::vector<Field> ForceChainsProbe::fields(const World& world) {
  const auto contacts = counted(world);
  const double mean = mean_normal_force(contacts);
  std::vector<Field> fields{
      {"start", "m", "centre of the first body", 3, {}},
      {"end",
       "m",
       "centre of the second body, or the touching point of the wall; across a periodic side, its image",
       3,
       {}},
      {"normal_force", "N", "normal force, positive in compression", 1, {}},
      {"above_mean", "1", "1 where the normal force is above the mean, 0 elsewhere", 1, {}}};
  for (auto& field : fields) field.values.reserve(field.width * contacts.size());
  for (const auto* contact : contacts) {
    const Vec3 start = xyz(world.positions()[contact->a]), end = start + contact->branch;
    fields[0].values.insert(fields[0].values.end(), start.begin(), start.end());
    fields[1].values.insert(fields[1].values.end(), end.begin(), end.end());
    fields[2].values.push_back(contact->normal_force);
    fields[3].values.push_back(contact->normal_force > mean ? 1 : 0);
  }
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "force-chains",
                                     .version = "1.0.0",
                                     .doc = "strong contacts, forces and contacts by direction, fabric anisotropy",
                                     .make_probe = []() -> grit::Probe* { return new grit::ForceChainsProbe; }};
  return &info;
}
