#include "coarse-graining.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "grit/error.hpp"
#include "grit/plugin.hpp"
#include "grit/toolkit/specimen.hpp"

namespace grit {

namespace {

constexpr double most_points = 5e6;  // 1 GB of sums, 1.4 GB of fields

}  // namespace

void CoarseGraining::declare(Parameters& parameters) {
  parameters.add("cutoff", cutoff)
      .symbol("c")
      .at_least(0.1)
      .doc("radius at which the kernel is 0, over the mean diameter");
  parameters.add("spacing", spacing)
      .at_least(0.05)
      .doc("spacing of the points, over the mean diameter; as many as fit are spread evenly");
  parameters.add("slice", slice)
      .one_of({"none", "x", "y", "z"})
      .doc("axis along which there is a single layer of points, in the middle");
  parameters.add("region_low", region_low).unit("m").doc("lower corner of the box of points; default: of the specimen");
  parameters.add("region_high", region_high)
      .unit("m")
      .doc("upper corner of the box of points; default: of the specimen");
  parameters.check(
      [this](const Complain& complain) {
        if (region_low && region_high && !(region_low->array() < region_high->array()).all())
          complain("region_high", "a corner not above region_low", "more than region_low along x, y and z");
      },
      {"region_low", "region_high"});
}

std::vector<Channel> CoarseGraining::channels() const {
  const std::string unknown = "; NaN without points";
  return {{"density", "kg m-3", "mass per volume, mean of the points" + unknown, {}},
          {"mean_stress",
           "Pa",
           "a third of the trace of the stress, positive in compression, mean of the points" + unknown,
           {}},
          {"kinetic_stress", "Pa", "part of the stress due to velocity fluctuations" + unknown, {}},
          {"points", "1", "number of points; 0 without bodies, or if there would be too many", {}}};
}

Region CoarseGraining::box(const World& world) const {
  const Region specimen = specimen_box(world);
  return {region_low.value_or(specimen.low), region_high.value_or(specimen.high)};
}

std::array<double, 3> CoarseGraining::counts(const World& world) const {
  const Region box = this->box(world);
  const double step = spacing * world.mean_diameter();
  if (!(step > 0) || !(box.volume() > 0) || !std::isfinite(box.volume())) return {0, 0, 0};
  std::array<double, 3> count{};
  for (int axis = 0; axis < 3; ++axis)
    count[static_cast<std::size_t>(axis)] =
        slice[0] - 'x' == axis ? 1 : std::max(1.0, std::floor((box.high[axis] - box.low[axis]) / step + 1e-9));
  return count;
}

void CoarseGraining::check_fields(const World& world) const {
  const auto count = counts(world);
  const double all = count[0] * count[1] * count[2];
  if (!(all <= most_points))
    throw ParameterError(
        {{"spacing", "a grid of " + std::to_string(static_cast<std::uint64_t>(std::min(all, 1e18))) + " points",
          "at most 5000000 points; use a larger spacing, a slice, or a smaller box by region_low and region_high"}});
}

std::optional<PointGrid> CoarseGraining::grid(const World& world) const {
  const auto count = counts(world);
  const double all = count[0] * count[1] * count[2];
  if (!(all > 0 && all <= most_points)) return std::nullopt;
  const Region box = this->box(world);
  PointGrid points{};
  points.step = (box.high - box.low).cwiseQuotient(Vec3(count[0], count[1], count[2]));
  points.first = box.low + 0.5 * points.step;
  for (std::size_t axis = 0; axis < 3; ++axis) points.count[axis] = static_cast<std::size_t>(count[axis]);
  return points;
}

void CoarseGraining::sample(const World& world, ChannelValues& values) {
  const auto points = grid(world);
  if (!points) {
    for (const char* of_points : {"density", "mean_stress", "kinetic_stress"})
      values[of_points] = std::numeric_limits<double>::quiet_NaN();
    values["points"] = 0;
    return;
  }
  const auto all = smoothed(world, *points);
  double density = 0, stress = 0, kinetic = 0;
  for (const CoarseFields& field : all) {
    density += field.density, kinetic += field.kinetic.trace() / 3;
    stress += (field.contact + field.kinetic).trace() / 3;
  }
  const auto count = static_cast<double>(all.size());
  values["density"] = density / count;
  values["mean_stress"] = stress / count;
  values["kinetic_stress"] = kinetic / count;
  values["points"] = count;
}

std::vector<Field> CoarseGraining::fields(const World& world) {
  std::vector<Field> fields{
      {"centre", "m", "position of the point", 3, {}},
      {"size", "m", "size of the cell around the point; the cells fill the box", 3, {}},
      {"density", "kg m-3", "mass per volume", 1, {}},
      {"momentum", "kg m-2 s-1", "momentum per volume, half a step earlier", 3, {}},
      {"velocity", "m s-1", "momentum over density; 0 where the density is 0", 3, {}},
      {"stress",
       "Pa",
       "stress of contacts and fluctuations, row by row, first index that of the force; compression positive",
       9,
       {}},
      {"kinetic_stress", "Pa", "part of the stress due to velocity fluctuations", 9, {}},
      {"wall_force", "N m-3", "force of walls on bodies per volume", 3, {}}};
  const auto grid = this->grid(world);
  if (!grid) return fields;
  const PointGrid& points = *grid;
  const auto all = smoothed(world, points);
  for (auto& field : fields) field.values.reserve(field.width * all.size());
  const auto put = [&](std::size_t field, const auto& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) fields[field].values.push_back(matrix(i, j));
  };
  std::size_t index = 0;
  for (std::size_t i = 0; i < points.count[0]; ++i)
    for (std::size_t j = 0; j < points.count[1]; ++j)
      for (std::size_t k = 0; k < points.count[2]; ++k) {
        const CoarseFields& here = all[index++];
        put(0, points.at(i, j, k)), put(1, points.step);
        fields[2].values.push_back(here.density);
        put(3, here.momentum), put(4, here.velocity());
        put(5, Mat3(here.contact + here.kinetic)), put(6, here.kinetic), put(7, here.wall_force);
      }
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "coarse-graining",
                                     .version = "1.0.0",
                                     .doc = "density, momentum and stress fields by a smooth kernel",
                                     .make_probe = []() -> grit::Probe* { return new grit::CoarseGraining; }};
  return &info;
}
