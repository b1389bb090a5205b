#include "stress.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>

#include "grit/plugin.hpp"
#include "grit/toolkit/cell_contents.hpp"
#include "grit/toolkit/stress_invariants.hpp"

namespace grit {
namespace {

const std::string angle_doc =
    "mobilised: asin((s1 - s3) / (s1 + s3)) of the largest and smallest principal stress; NaN if one is below 0 or "
    "both are 0";

/// What contacts transmit in a part of the region, or a cell.
struct Transmitted {
  Mat3 load = Mat3::Zero();    ///< sum of force and branch [N m]
  Mat3 couple = Mat3::Zero();  ///< sum of moment and branch [N m²]

  Transmitted& operator+=(const Transmitted& other) {
    load += other.load, couple += other.couple;
    return *this;
  }
};

/// Of each cell, in one pass over the contacts.
std::vector<Transmitted> transmitted(const World& world, const AveragingCells& cells) {
  std::vector<Transmitted> parts(cells.parts());
  const auto arms = world.arms();
  share_out_contacts(world, cells, [&](std::size_t part, const Piece& piece) {
    const auto& [contact, branch, from, to, load] = piece;
    // The moment is linear along the branch: its mean over a piece is that of the piece's middle.
    Vec3 moment = contact.moment + (1 - 0.5 * (from + to)) * branch.vector.cross(contact.force);
    if (!arms.empty() && !contact.with_wall) moment += arms[contact.b].cross(contact.force);
    parts[part].load += load;
    parts[part].couple += (to - from) * moment * branch.vector.transpose();
  });
  return cells.sum_up(parts);
}

/// Of the symmetric part of a stress.
struct Invariants {
  double mean, deviatoric, friction_angle;
};
Invariants invariants(const Mat3& stress) {
  const Vec3 principal =
      Eigen::SelfAdjointEigenSolver<Mat3>(symmetric_part(stress), Eigen::EigenvaluesOnly).eigenvalues();
  const double least = principal[0], most = principal[2];
  // Where a stress vanishes rounding may leave it a little below 0.
  const bool pressed = most > 0 && least >= -1e-12 * most;
  return {.mean = stress.trace() / 3,
          .deviatoric = deviatoric_stress(stress),
          .friction_angle = pressed ? std::asin(std::min(1.0, (most - least) / (most + least))) * 180 / std::numbers::pi
                                    : std::numeric_limits<double>::quiet_NaN()};
}

void copy(const Mat3& tensor, double* to) {
  for (int i = 0; i < 9; ++i) to[i] = tensor(i / 3, i % 3);
}

constexpr const char* component_names[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
// How the names of channels begin that end with a component.
const std::string stress_profile = "stress_profile_";
const std::string couple_stress_profile = "couple_stress_profile_";

}  // namespace

void Stress::declare(Parameters& p) { averaging.declare(p, "the specimen's"); }

std::vector<Channel> Stress::channels() const {
  const auto n = static_cast<std::size_t>(averaging.slices);
  const std::string unknown = "; NaN if the region has no volume";
  const std::string tensor = "(force, branch), positive in compression" + unknown,
                    couple = "(moment, branch), of what the side before exerts on the side behind" + unknown;
  const Channel place = averaging.position_channel();
  std::vector<Channel> channels{
      {"stress", "Pa", "Love-Weber stress of the region, row by row " + tensor, {3, 3}},
      {"couple_stress", "N m-1", "couple stress of the region, row by row " + couple, {3, 3}},
      {"mean_stress", "Pa", "mean stress of the region, a third of the trace, positive in compression" + unknown, {}},
      {"deviatoric_stress", "Pa", "deviatoric stress of the region, q = sqrt(3/2 s:s), never negative" + unknown, {}},
      {"friction_angle", "degree", "friction angle of the region, " + angle_doc, {}},
      place,
      {"mean_stress_profile", "Pa", "mean stress of each slice; NaN if it has no volume", {n}, place.name},
      {"deviatoric_stress_profile", "Pa", "deviatoric stress of each slice; NaN if it has no volume", {n}, place.name},
      {"friction_angle_profile", "degree", "friction angle of each slice, " + angle_doc, {n}, place.name}};
  for (const std::string ij : component_names)
    channels.push_back(
        {stress_profile + ij, "Pa", "Love-Weber stress of each slice, " + ij + " " + tensor, {n}, place.name});
  for (const std::string ij : component_names)
    channels.push_back(
        {couple_stress_profile + ij, "N m-1", "couple stress of each slice, " + ij + " " + couple, {n}, place.name});
  return channels;
}

void Stress::sample(const World& world, ChannelValues& values) {
  // Without volume all but the places is unknown.
  for (const Channel& channel : channels())
    std::ranges::fill(values.list(channel.name), std::numeric_limits<double>::quiet_NaN());
  const Region box = closed_box(averaging.region(world.specimen()), world);
  averaging.fill_places(box, values);
  const AveragingCells slices = averaging.profile(world, box);
  if (slices.cells() == 0) return;
  Transmitted whole;
  const auto each = transmitted(world, slices);
  const double volume = box.volume(), slice_volume = volume / static_cast<double>(each.size());
  const auto mean = values.list("mean_stress_profile");
  const auto deviatoric = values.list("deviatoric_stress_profile");
  const auto angle = values.list("friction_angle_profile");
  std::array<std::span<double>, 9> stresses, couples;
  for (std::size_t ij = 0; ij < 9; ++ij) {
    stresses[ij] = values.list(stress_profile + component_names[ij]);
    couples[ij] = values.list(couple_stress_profile + component_names[ij]);
  }
  for (std::size_t s = 0; s < each.size(); ++s) {
    const Mat3 stress = each[s].load / slice_volume;
    const Invariants of = invariants(stress);
    mean[s] = of.mean, deviatoric[s] = of.deviatoric, angle[s] = of.friction_angle;
    for (std::size_t ij = 0; ij < 9; ++ij) {
      const auto i = static_cast<Eigen::Index>(ij / 3), j = static_cast<Eigen::Index>(ij % 3);
      stresses[ij][s] = stress(i, j), couples[ij][s] = each[s].couple(i, j) / slice_volume;
    }
    whole += each[s];
  }
  const Invariants of = invariants(whole.load / volume);
  copy(whole.load / volume, values.list("stress").data());
  copy(whole.couple / volume, values.list("couple_stress").data());
  values["mean_stress"] = of.mean;
  values["deviatoric_stress"] = of.deviatoric;
  values["friction_angle"] = of.friction_angle;
}

void Stress::check_fields(const World& world) const {
  averaging.check_cells(world, closed_box(averaging.region(world.specimen()), world));
}

std::vector<Field> Stress::fields(const World& world) {
  const AveragingCells cells = averaging.cells(world, closed_box(averaging.region(world.specimen()), world));
  std::vector<Field> fields = map_of(cells);
  Field stress{"stress", "Pa", "Love-Weber stress, row by row (force, branch), positive in compression", 9, {}};
  Field couple{"couple_stress",
               "N m-1",
               "couple stress, row by row (moment, branch), of what the side before exerts on the side behind",
               9,
               {}};
  Field mean{"mean_stress", "Pa", "mean stress, a third of the trace, positive in compression", 1, {}};
  Field deviatoric{"deviatoric_stress", "Pa", "deviatoric stress q = sqrt(3/2 s:s), never negative", 1, {}};
  Field angle{"friction_angle", "degree", angle_doc, 1, {}};
  const auto each = transmitted(world, cells);
  for (std::size_t n = 0; n < each.size(); ++n) {
    const double volume = cells.cell(n).volume();
    const Mat3 of_cell = each[n].load / volume;
    const Invariants of = invariants(of_cell);
    stress.values.resize(9 * n + 9), copy(of_cell, &stress.values[9 * n]);
    couple.values.resize(9 * n + 9), copy(each[n].couple / volume, &couple.values[9 * n]);
    mean.values.push_back(of.mean), deviatoric.values.push_back(of.deviatoric);
    angle.values.push_back(of.friction_angle);
  }
  for (Field* field : {&stress, &couple, &mean, &deviatoric, &angle}) fields.push_back(std::move(*field));
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "stress",
                                     .version = "1.0.0",
                                     .doc = "stress and couple stress of averaging cells, and their profile",
                                     .make_probe = []() -> grit::Probe* { return new grit::Stress; }};
  return &info;
}
