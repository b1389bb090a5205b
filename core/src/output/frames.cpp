#include "output/frames.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <numeric>

#include "grit/error.hpp"
#include "output/atomic_file.hpp"
#include "output/hdf5.hpp"

namespace grit {
namespace {

std::string file_name(std::size_t number) { return fmt::format("{:06}.h5", number); }

template <class T>
hdf5::Dataset put(hdf5::Group& group, const Channel& what, const hdf5::Shape& shape, const std::vector<T>& values) {
  auto dataset = group.write(what.name, shape, std::span<const T>(values));
  dataset.set_attribute("units", what.unit);
  dataset.set_attribute("long_name", what.doc);
  return dataset;
}

class Bodies {
 public:
  Bodies(hdf5::Group group, const World& world) : group_(std::move(group)), order_(world.ids().size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::ranges::sort(order_, {}, [ids = world.ids()](std::uint32_t body) { return ids[body]; });
  }

  /// One number a body, in the order of ids.
  template <class T, class Read>
  void scalar(const Channel& what, Read read) {
    std::vector<T> values;
    values.reserve(order_.size());
    for (const auto body : order_) values.push_back(read(body));
    put(group_, what, {order_.size()}, values);
  }

  template <class Read>
  void vector(const Channel& what, Read read) {
    std::vector<double> values;
    values.reserve(3 * order_.size());
    for (const auto body : order_) {
      const Vec3 v = read(body);
      values.insert(values.end(), v.data(), v.data() + 3);
    }
    put(group_, what, {order_.size(), 3}, values);
  }

 private:
  hdf5::Group group_;
  std::vector<std::uint32_t> order_;
};

void write_bodies(hdf5::Group group, const World& world) {
  Bodies bodies(std::move(group), world);
  bodies.scalar<std::int64_t>({"id", "1", "number that the body keeps for the whole run", {}},
                              [ids = world.ids()](auto i) { return ids[i]; });
  bodies.vector({"position", "m", "centre", {}}, [rows = world.positions()](auto i) { return xyz(rows[i]); });
  bodies.scalar<double>({"radius", "m", "radius", {}}, [rows = world.positions()](auto i) { return rows[i].w; });
  bodies.vector({"velocity", "m/s", "velocity of the centre, half a step before the frame's time", {}},
                [rows = world.velocities()](auto i) { return xyz(rows[i]); });
  bodies.vector({"spin", "rad/s", "angular velocity, right-handed, half a step before the frame's time", {}},
                [rows = world.spins()](auto i) { return xyz(rows[i]); });
  bodies.scalar<std::int32_t>({"material", "1", "place of the material in the description, from 0", {}},
                              [materials = world.materials()](auto i) { return materials[i]; });
  if (const auto clump_of = world.clump_of(); !clump_of.empty())
    bodies.scalar<std::int64_t>({"clump", "1", "id of the clump that the body is part of; -1 by itself", {}},
                                [&, clumps = world.clumps()](auto i) -> std::int64_t {
                                  return clump_of[i] == no_clump ? -1 : std::int64_t{clumps[clump_of[i]].id};
                                });
  if (const auto rotations = world.rotations(); !rotations.empty())
    bodies.vector({"rotation", "rad", "cumulative rotation vector, right-handed", {}},
                  [&](auto i) { return rotations[i]; });
  if (const auto displacements = world.displacements(); !displacements.empty())
    bodies.vector({"displacement", "m", "displacement since the start of the stage", {}},
                  [&](auto i) { return displacements[i]; });
}

void write_clumps(hdf5::Group group, const World& world) {
  std::vector<std::int64_t> id;
  std::vector<double> centre, orientation, spin, radius;
  std::vector<ClumpView> clumps(world.clumps().begin(), world.clumps().end());
  std::ranges::sort(clumps, {}, &ClumpView::id);
  for (const ClumpView& clump : clumps) {
    const Eigen::Quaterniond turn(clump.axes);
    id.push_back(clump.id), radius.push_back(clump.radius);
    centre.insert(centre.end(), clump.centre.begin(), clump.centre.end());
    orientation.insert(orientation.end(), {turn.w(), turn.x(), turn.y(), turn.z()});
    spin.insert(spin.end(), clump.spin.begin(), clump.spin.end());
  }
  const auto n = id.size();
  put(group, {"id", "1", "number that the clump keeps for the whole run", {}}, {n}, id);
  put(group, {"centre", "m", "centre of mass", {}}, {n, 3}, centre);
  put(group, {"orientation", "1", "unit quaternion (w, x, y, z) of the principal axes", {}}, {n, 4}, orientation);
  put(group, {"spin", "rad/s", "angular velocity, right-handed, half a step before the frame's time", {}}, {n, 3},
      spin);
  put(group, {"radius", "m", "of the enclosing sphere", {}}, {n}, radius);
}

void write_contacts(hdf5::Group group, const World& world) {
  const auto ids = world.ids();
  const auto contacts = world.contacts();
  std::vector<std::int64_t> a, b, feature;
  std::vector<double> force, normal_force, branch;
  for (const auto& contact : contacts) {
    a.push_back(ids[contact.a]);
    b.push_back(contact.with_wall ? -1 - std::int64_t{contact.b} : std::int64_t{ids[contact.b]});
    feature.push_back(contact.with_wall ? std::int64_t{contact.feature} : -1);
    force.insert(force.end(), contact.force.data(), contact.force.data() + 3);
    normal_force.push_back(contact.normal_force);
    branch.insert(branch.end(), contact.branch.data(), contact.branch.data() + 3);
  }
  const auto m = contacts.size();
  put(group, {"body_a", "1", "id of the first body", {}}, {m}, a);
  put(group, {"body_b", "1", "id of the second body; -1 - index of the wall for a wall", {}}, {m}, b);
  put(group, {"feature", "1", "of the wall, as its geometry numbers what is touched; -1 between bodies", {}}, {m},
      feature);
  put(group, {"force", "N", "force on the second body or wall; its opposite acts on the first", {}}, {m, 3}, force);
  put(group, {"normal_force", "N", "normal force, positive in compression", {}}, {m}, normal_force);
  put(group, {"branch", "m", "from the first body's centre to the second's, or to the touching point on the wall", {}},
      {m, 3}, branch);
}

void write_walls(hdf5::Group group, const World& world, std::span<const WallShape> shapes) {
  const auto walls = world.walls();
  for (std::size_t index = 0; index < walls.size(); ++index) {
    const auto& wall = walls[index];
    const auto shape = std::ranges::find(shapes, wall.name, &WallShape::name);
    std::vector<double> corners;
    if (shape != shapes.end())
      for (const auto& corner : placed(*shape, world)) corners.insert(corners.end(), corner.data(), corner.data() + 3);
    auto triangles = put(group, {wall.name, "m", "corners of the wall's triangles where it has moved to", {}},
                         {corners.size() / 9, 3, 3}, corners);
    triangles.set_attribute("index", static_cast<std::int64_t>(index));
    triangles.set_attribute("pressure", wall.pressure);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto letter = std::string(1, "xyz"[axis]);
      triangles.set_attribute("displacement_" + letter, wall.position[axis]);
      triangles.set_attribute("force_" + letter, wall.force[axis]);
    }
  }
}

void write_probes(hdf5::Group group, std::span<const FieldGroup> probes) {
  for (const auto& probe : probes) {
    auto tables = group.create_group(probe.name);
    for (const auto& field : probe.fields) {
      if (field.width == 0 || field.values.size() % field.width != 0)
        throw PluginError(fmt::format("probe '{}': its field '{}' has {} numbers, which are not whole rows of {}",
                                      probe.name, field.name, field.values.size(), field.width));
      const auto rows = field.values.size() / field.width;
      auto table = put(tables, {field.name, field.unit, field.doc, {}},
                       field.width == 1 ? hdf5::Shape{rows} : hdf5::Shape{rows, field.width}, field.values);
      if (!field.components.empty())
        table.set_attribute("components", fmt::format("{}", fmt::join(field.components, " ")));
    }
  }
}

}  // namespace

std::vector<Vec3> placed(const WallShape& shape, const World& world) {
  auto triangles = shape.triangles;
  const auto walls = world.walls();
  if (const auto wall = std::ranges::find(walls, shape.name, &WallView::name); wall != walls.end())
    for (auto& corner : triangles) corner += wall->position;
  return triangles;
}

Frames::Frames(const std::filesystem::path& results, std::vector<WallShape> walls,
               std::optional<std::uint64_t> last_step)
    : results_(results), walls_(std::move(walls)) {
  const auto folder = results_ / "frames";
  std::error_code error;
  if (!last_step) std::filesystem::remove_all(folder, error);
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder.string() + ": cannot make the folder: " + error.message());

  bool keep = last_step.has_value();
  for (std::size_t number = 0; std::filesystem::exists(folder / file_name(number)); ++number) {
    if (keep) {
      const hdf5::File file(folder / file_name(number), hdf5::Mode::read);
      const auto bodies = file.group("bodies");
      const Instant instant{file.number<double>("time"), file.number<std::uint64_t>("step"),
                            bodies.dataset("id").rows(), bodies.has("rotation"), bodies.has("displacement")};
      keep = instant.step <= *last_step;
      if (keep) instants_.push_back(instant);
    }
    if (!keep) std::filesystem::remove(folder / file_name(number), error);
  }
  write_index();
}

void Frames::write(const World& world, std::span<const FieldGroup> fields) {
  const auto path = results_ / "frames" / file_name(instants_.size());
  hdf5::File file(beside(path), hdf5::Mode::replace);
  file.set_attribute("time", world.time());
  file.set_attribute("step", world.step());
  file.set_attribute("stage", world.stage());
  write_bodies(file.create_group("bodies"), world);
  if (!world.clumps().empty()) write_clumps(file.create_group("clumps"), world);
  write_contacts(file.create_group("contacts"), world);
  write_walls(file.create_group("walls"), world, walls_);
  write_probes(file.create_group("probes"), fields);
  file.close();
  publish(path);
  instants_.push_back(
      {world.time(), world.step(), world.ids().size(), !world.rotations().empty(), !world.displacements().empty()});
  write_index();
}

void Frames::write_index() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<Xdmf Version=\"3.0\">\n <Domain>\n  <Grid Name=\"grains\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n";
  for (std::size_t number = 0; number < instants_.size(); ++number) {
    const auto& instant = instants_[number];
    const auto item = [&](const char* name, const char* type, int width) {
      return fmt::format(
          "<DataItem Dimensions=\"{}{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">"
          "frames/{}:/bodies/{}</DataItem>",
          instant.bodies, width == 3 ? " 3" : "", type, std::string_view(name) == "material" ? 4 : 8, file_name(number),
          name);
    };
    const auto attribute = [&](const char* name, const char* type, int width) {
      text += fmt::format("    <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", name,
                          width == 3 ? "Vector" : "Scalar", item(name, type, width));
    };
    text += fmt::format("   <Grid Name=\"{:06}\">\n    <Time Value=\"{}\"/>\n", number, instant.time);
    text += fmt::format("    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\"/>\n",
                        instant.bodies);
    text += "    <Geometry GeometryType=\"XYZ\">" + item("position", "Float", 3) + "</Geometry>\n";
    attribute("radius", "Float", 1);
    attribute("velocity", "Float", 3);
    attribute("spin", "Float", 3);
    attribute("id", "Int", 1);
    attribute("material", "Int", 1);
    if (instant.rotation) attribute("rotation", "Float", 3);
    if (instant.displacement) attribute("displacement", "Float", 3);
    text += "   </Grid>\n";
  }
  text += "  </Grid>\n </Domain>\n</Xdmf>\n";
  write_atomically(results_ / "frames.xdmf", text);
}

}  // namespace grit
