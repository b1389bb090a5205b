#include "strain.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "grit/plugin.hpp"
#include "grit/toolkit/displacement_fit.hpp"
#include "grit/toolkit/specimen.hpp"

namespace grit {

void Strain::declare(Parameters& p) {
  p.add("depth_axis", depth_axis).one_of({"x", "y", "z"}).doc("axis perpendicular to the plane of the strain");
  p.add("subset", subset)
      .at_least(0.5)
      .doc("side of a subset of bodies, over the mean diameter; as deep as the specimen");
  p.add("step", step).at_least(0.1).doc("distance between neighbouring subsets, over the mean diameter");
  p.add("sliding", sliding)
      .doc("lengths over which the specimen slides on a wall and shears internally; default: not evaluated");
}

void Strain::prepare(const World& world) {
  if (sliding) sliding->prepare(world, plane()[0], plane()[1], "sliding");
}

std::array<int, 2> Strain::plane() const {
  const int depth = depth_axis[0] - 'x';
  return {depth == 0 ? 1 : 0, depth == 2 ? 1 : 2};
}

std::vector<Channel> Strain::channels() const {
  const auto [first, second] = plane();
  const std::string a{"xyz"[first]}, b{"xyz"[second]};
  const std::string which = "E_" + a + a + ", E_" + b + b + ", E_" + a + b;
  std::vector<Channel> channels{
      {"strain",
       "1",
       which + " of all bodies, Green-Lagrange since the start of the stage, positive in extension; NaN with fewer "
               "than four",
       {3},
       {},
       {a + a, b + b, a + b}},
      {"largest_shear", "1", "largest magnitude of E_" + a + b + " of a subset; 0 without any", {}}};
  if (sliding) std::ranges::move(SlidingLengths::channels(), std::back_inserter(channels));
  return channels;
}

std::vector<Strain::Body> Strain::bodies(const World& world) const {
  std::vector<Body> all;
  const auto axes = plane();
  // Where bodies began cannot be told in a cell whose sides have moved since.
  if (world.cell().skewed()) return all;
  for (const int axis : axes)
    if (world.cell().periodic[static_cast<std::size_t>(axis)] && world.cell().strain_rate[axis] != 0) return all;
  for (std::size_t i = 0; i < world.displacements().size(); ++i) {
    if (!xyz(world.positions()[i]).allFinite()) continue;  // a run that has failed
    Body body;
    for (std::size_t k = 0; k < 2; ++k) {
      const int axis = axes[k];
      const auto side = static_cast<Eigen::Index>(k);
      body.moved[side] = world.displacements()[i][axis];
      body.place[side] = world.cell().inside(xyz(world.positions()[i])[axis] - body.moved[side], axis);
    }
    all.push_back(body);
  }
  return all;
}

std::vector<Strain::Subset> Strain::subsets(const World& world) const {
  const double diameter = world.mean_diameter(), side = subset * diameter, apart = step * diameter;
  std::vector<Subset> found;
  auto all = bodies(world);
  if (all.empty() || !(apart > 0)) return found;
  Vec2 low = all.front().place, high = low;
  for (const Body& body : all) low = low.cwiseMin(body.place), high = high.cwiseMax(body.place);
  // Columns of bodies along the first axis, so that a subset looks at few.
  std::ranges::sort(all, [](const Body& a, const Body& b) { return a.place.x() < b.place.x(); });
  const auto along = [&](double length) {
    return static_cast<std::int64_t>(std::floor(std::max(0.0, length - side) / apart + 1e-9)) + 1;
  };
  const std::int64_t columns = along(high.x() - low.x()), rows = along(high.y() - low.y());
  const Vec2 margin(0.5 * (high.x() - low.x() - static_cast<double>(columns - 1) * apart),
                    0.5 * (high.y() - low.y() - static_cast<double>(rows - 1) * apart));
  for (std::int64_t i = 0; i < columns; ++i) {
    const double x = low.x() + margin.x() + static_cast<double>(i) * apart;
    const auto begin = std::ranges::lower_bound(all, x - 0.5 * side, {}, [](const Body& b) { return b.place.x(); });
    const auto end = std::ranges::upper_bound(all, x + 0.5 * side, {}, [](const Body& b) { return b.place.x(); });
    for (std::int64_t j = 0; j < rows; ++j) {
      const double y = low.y() + margin.y() + static_cast<double>(j) * apart;
      DisplacementFit fit;
      for (auto body = begin; body != end; ++body)
        if (std::abs(body->place.y() - y) <= 0.5 * side) fit.add(body->place, body->moved);
      found.push_back({.began = {x, y}, .moved = fit.moved(), .bodies = fit.points(), .green = fit.green(6, 0.01)});
    }
  }
  return found;
}

void Strain::sample(const World& world, ChannelValues& values) {
  DisplacementFit whole;
  for (const Body& body : bodies(world)) whole.add(body.place, body.moved);
  std::ranges::copy(whole.green(4, 1e-12), values.list("strain").begin());
  double largest = 0;
  for (const Subset& one : subsets(world))
    if (const double shear = std::abs(one.green[2]); shear > largest) largest = shear;
  values["largest_shear"] = largest;
  if (!sliding) return;
  std::vector<SlidingLengths::Point> points;
  for (std::size_t i = 0; i < world.displacements().size(); ++i)
    points.push_back({.along = xyz(world.positions()[i])[sliding->along()],
                      .across = xyz(world.positions()[i])[sliding->across()],
                      .moved = world.displacements()[i][sliding->along()]});
  SlidingLengths::fill(sliding->of(world, points, {}), values);
}

std::vector<Field> Strain::fields(const World& world) {
  const auto [first, second] = plane();
  const std::string a{"xyz"[first]}, b{"xyz"[second]};
  std::vector<Field> fields{
      {"centre", "m", "centre of each subset, which moves with its bodies; across the plane, of the specimen", 3, {}},
      {"size", "m", "distance of neighbouring subsets, and depth of the specimen", 3, {}},
      {"start_position", "m", "centre along " + a + " and " + b + " at the start of the stage", 2, {}, {a, b}},
      {"bodies", "1", "number of bodies whose centres were in the subset", 1, {}},
      {"strain",
       "1",
       "E_" + a + a + ", E_" + b + b + ", E_" + a + b +
           ", Green-Lagrange, positive in extension; NaN with fewer than six, or nearly on one line",
       3,
       {},
       {a + a, b + b, a + b}}};
  const auto append = [&fields](std::size_t field, const auto& row) {
    fields[field].values.insert(fields[field].values.end(), row.begin(), row.end());
  };
  const Region specimen = specimen_box(world);
  Vec3 size = specimen.high - specimen.low;
  size[first] = size[second] = step * world.mean_diameter();
  for (const Subset& one : subsets(world)) {
    Vec3 centre = 0.5 * (specimen.low + specimen.high);
    centre[first] = one.began[0] + one.moved[0], centre[second] = one.began[1] + one.moved[1];
    for (const int axis : {first, second}) centre[axis] = world.cell().inside(centre[axis], axis);
    append(0, centre), append(1, size), append(2, one.began), append(4, one.green);
    fields[3].values.push_back(one.bodies);
  }
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "probe",
      .name = "strain",
      .version = "1.0.0",
      .doc = "strain in a plane from displacements of bodies, by subsets as in image correlation",
      .make_probe = []() -> grit::Probe* { return new grit::Strain; }};
  return &info;
}
