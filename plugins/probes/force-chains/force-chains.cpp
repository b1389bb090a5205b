// Statistics of contact forces and directions. See README.md.
#include "force-chains.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "grit/plugin.hpp"

namespace grit {

namespace {

double mean_normal_force(const std::vector<const Contact*>& contacts) {
  double sum = 0;
  for (const auto* contact : contacts) sum += contact->normal_force;
  return contacts.empty() ? 0 : sum / static_cast<double>(contacts.size());
}

/// Of an axis whose doubled angle has this sine and cosine: -90 to 90.
double axis_degrees(double sine, double cosine) { return 90 / std::numbers::pi * std::atan2(sine, cosine); }

/// The bin of a direction; bin 0 begins at the first axis of the plane.
std::size_t bin_of(double first, double second) {
  constexpr double width = 2 * std::numbers::pi / ForceChainsProbe::bins;
  const double angle = std::atan2(second, first);
  return static_cast<std::size_t>(std::floor(angle / width) + ForceChainsProbe::bins) % ForceChainsProbe::bins;
}

/// The least-squares fit of a value to N functions of direction, contact by contact. NaN where the directions do not
/// tell.
template <int N>
class Fit {
 public:
  using Values = Eigen::Matrix<double, N, 1>;
  void add(const Values& functions, double value) {
    products_ += functions * functions.transpose(), sums_ += value * functions;
  }
  Values factors() const {
    Eigen::Matrix<double, N, N> inverse;
    bool tells = false;
    const double size = products_.trace();
    (products_ / size).computeInverseWithCheck(inverse, tells, 1e-9);
    if (!tells) return Values::Constant(std::numeric_limits<double>::quiet_NaN());
    return inverse * sums_ / size;
  }

 private:
  Eigen::Matrix<double, N, N> products_ = Eigen::Matrix<double, N, N>::Zero();
  Values sums_ = Values::Zero();
};

}  // namespace

void ForceChainsProbe::declare(Parameters& parameters) {
  parameters.add("plane", plane)
      .one_of({"xy", "yx", "xz", "zx", "yz", "zy"})
      .doc("plane of the directions; angles are measured from its first axis towards its second");
  parameters.add("include_walls", include_walls).doc("whether wall contacts are included");
  parameters.add("angle", angle)
      .unit("rad")
      .symbol("alpha")
      .above(0)
      .at_most(std::numbers::pi / 2)
      .doc("maximum angle in a chain between the line of two centres and the major principal stress of either grain");
}

std::vector<Channel> ForceChainsProbe::channels() const {
  return {
      {"mean_normal_force", "N", "mean normal force of a contact, positive in compression; 0 without contacts", {}},
      {"fraction_above_mean", "1", "fraction of the contacts with a normal force above the mean", {}},
      {"direction",
       "degree",
       "middle of each bin of 10 degrees, from the first axis of the plane towards the second",
       {bins}},
      {"force_by_direction",
       "N",
       "mean normal force of the contacts in each bin of 10 degrees in the plane, the first from 0 to 10 "
       "degrees, positive in compression; 0 in empty bins",
       {bins},
       "direction"},
      {"contacts_by_direction",
       "1",
       "number of contacts in each bin of 10 degrees in the plane; a contact counts in both of its "
       "directions",
       {bins},
       "direction"},
      {"anisotropy", "1", "amplitude a of E = (1 + a cos 2(theta - theta_a)) / 2 pi, fitted to the directions", {}},
      {"anisotropy_direction",
       "degree",
       "preferred contact direction theta_a, from the first axis of the plane towards the second, -90 to 90",
       {}},
      {"normal_force_anisotropy",
       "1",
       "a_n of f_n = f_0 (1 + a_n cos 2(theta - theta_n)), fitted to normal forces; NaN if undetermined",
       {}},
      {"normal_force_direction", "degree", "theta_n, as anisotropy_direction; NaN as above", {}},
      {"tangential_force_anisotropy",
       "1",
       "a_t of f_t = -f_0 a_t sin 2(theta - theta_t), fitted to forces along the contacts in the plane; NaN as above",
       {}},
      {"tangential_force_direction", "degree", "theta_t, as anisotropy_direction; NaN as above", {}},
      {"mean_major_stress", "Pa", "mean major principal stress of the grains, positive in compression", {}},
      {"chains", "1", "number of linear force chains of three or more grains", {}},
      {"chain_grains", "1", "number of grains in chains", {}},
      {"mean_chain_length", "1", "mean number of grains in a chain; 0 without chains", {}},
      {"longest_chain", "1", "number of grains in the longest chain", {}},
      {"chains_born", "1", "chains that continue no chain of the previous sample; NaN at the first sample", {}},
      {"chains_died", "1", "chains of the previous sample that continue in no chain; NaN at the first sample", {}}};
}

std::vector<const Contact*> ForceChainsProbe::counted(const World& world) const {
  std::vector<const Contact*> contacts;
  contacts.reserve(world.contacts().size());
  for (const auto& contact : world.contacts())
    if (include_walls || !contact.with_wall) contacts.push_back(&contact);
  return contacts;
}

void ForceChainsProbe::sample(const World& world, ChannelValues& values) {
  const auto contacts = counted(world);
  const double mean = mean_normal_force(contacts);
  const int first = plane[0] - 'x', second = plane[1] - 'x';

  std::array<double, bins> force{}, count{};
  double above = 0, directed = 0, cosines = 0, sines = 0;
  Fit<3> normal;
  Fit<2> tangential;
  for (const auto* contact : contacts) {
    if (contact->normal_force > mean) ++above;
    const double x = contact->normal[first], y = contact->normal[second], square = x * x + y * y;
    if (square < 1e-12) continue;  // at right angles to the plane: no direction in it
    const std::size_t bin = bin_of(x, y), opposite = (bin + bins / 2) % bins;
    for (const std::size_t i : {bin, opposite}) force[i] += contact->normal_force, ++count[i];
    ++directed;
    const double cosine = (x * x - y * y) / square, sine = 2 * x * y / square;
    cosines += cosine, sines += sine;
    normal.add({1, cosine, sine}, contact->normal_force);
    tangential.add({cosine, sine}, (x * contact->force[second] - y * contact->force[first]) / std::sqrt(square));
  }
  for (std::size_t i = 0; i < bins; ++i)
    if (count[i] > 0) force[i] /= count[i];

  values["mean_normal_force"] = mean;
  values["fraction_above_mean"] = contacts.empty() ? 0 : above / static_cast<double>(contacts.size());
  const auto direction = values.list("direction");
  for (std::size_t i = 0; i < bins; ++i) direction[i] = (static_cast<double>(i) + 0.5) * 360 / bins;
  std::ranges::copy(force, values.list("force_by_direction").begin());
  std::ranges::copy(count, values.list("contacts_by_direction").begin());
  values["anisotropy"] = directed > 0 ? 2 * std::hypot(cosines, sines) / directed : 0;
  values["anisotropy_direction"] = axis_degrees(sines, cosines);

  const Eigen::Vector3d f_n = normal.factors();
  const Eigen::Vector2d f_t = tangential.factors();
  const double f_0 = f_n[0] > 0 ? f_n[0] : std::numeric_limits<double>::quiet_NaN();
  values["normal_force_anisotropy"] = std::hypot(f_n[1], f_n[2]) / f_0;
  values["normal_force_direction"] = axis_degrees(f_n[2], f_n[1]);
  values["tangential_force_anisotropy"] = f_t.norm() / f_0;
  values["tangential_force_direction"] = axis_degrees(f_t[0], -f_t[1]);
  sample_chains(world, values);
}

void ForceChainsProbe::sample_chains(const World& world, ChannelValues& values) {
  if (now_ && world.step() != step_) before_ = std::move(now_);
  now_ = linear_chains(world, angle), step_ = world.step();
  std::size_t grains = 0, longest = 0;
  for (const auto& chain : now_->grains) grains += chain.size(), longest = std::max(longest, chain.size());
  const auto count = static_cast<double>(now_->grains.size());
  values["mean_major_stress"] = now_->mean_major_stress;
  values["chains"] = count;
  values["chain_grains"] = static_cast<double>(grains);
  values["mean_chain_length"] = count > 0 ? static_cast<double>(grains) / count : 0;
  values["longest_chain"] = static_cast<double>(longest);
  double& born = values["chains_born"];
  double& died = values["chains_died"];
  born = died = std::numeric_limits<double>::quiet_NaN();
  if (!before_) return;
  const Turnover change = turnover(*before_, *now_);
  born = static_cast<double>(change.born), died = static_cast<double>(change.died);
}

std::vector<Field> ForceChainsProbe::fields(const World& world) {
  const auto contacts = counted(world);
  const double mean = mean_normal_force(contacts);
  std::vector<Field> fields{
      {"start", "m", "centre of the first body", 3, {}},
      {"end",
       "m",
       "centre of the second body (its image across a periodic side), or the contact point of the wall",
       3,
       {}},
      {"normal_force", "N", "normal force, positive in compression", 1, {}},
      {"above_mean", "1", "1 where the normal force is above the mean, 0 elsewhere", 1, {}},
      {"chain", "1", "number of the linear force chain that contains the contact, from 1; 0 for none", 1, {}}};
  const auto chain_of = linear_chains(world, angle).of_contact;
  for (auto& field : fields) field.values.reserve(field.width * contacts.size());
  for (const auto* contact : contacts) {
    const Vec3 start = xyz(world.positions()[contact->a]), end = start + contact->branch;
    fields[0].values.insert(fields[0].values.end(), start.begin(), start.end());
    fields[1].values.insert(fields[1].values.end(), end.begin(), end.end());
    fields[2].values.push_back(contact->normal_force);
    fields[3].values.push_back(contact->normal_force > mean ? 1 : 0);
    fields[4].values.push_back(chain_of[static_cast<std::size_t>(contact - world.contacts().data())]);
  }
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "force-chains",
                                     .version = "1.0.0",
                                     .doc = "strong contacts, linear chains, forces by direction, anisotropies",
                                     .make_probe = []() -> grit::Probe* { return new grit::ForceChainsProbe; }};
  return &info;
}
