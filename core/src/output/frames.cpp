#include "output/frames.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "grit/description.hpp"
#include "grit/error.hpp"
#include "output/body_columns.hpp"
#include "output/frame_exports.hpp"
#include "output/own_files.hpp"
#include "output/svg.hpp"
#include "output/vtk.hpp"
#include "storage/atomic_file.hpp"
#include "storage/frame_state.hpp"
#include "storage/hdf5.hpp"

namespace grit {
namespace {

constexpr const char* foreign_frame =
    ": grit did not write this file, which is in the way of a frame: it would be lost; move it away";

template <class T>
hdf5::Dataset put(hdf5::Group& group, const Channel& what, const hdf5::Shape& shape, const std::vector<T>& values) {
  auto dataset = group.write(what.name, shape, std::span<const T>(values));
  dataset.set_attribute("units", what.unit);
  dataset.set_attribute("long_name", what.doc);
  return dataset;
}

void write_bodies(hdf5::Group group, const World& world) {
  const GroupIndex groups = group_index(world);
  put_body_columns(world, groups, [&](const Channel& what, std::size_t width, const auto& values) {
    const std::size_t rows = values.size() / width;
    put(group, what, width == 1 ? hdf5::Shape{rows} : hdf5::Shape{rows, width}, values);
  });
  if (group.has("group")) group.dataset("group").set_attribute("names", Description(groups.names).dump());
  else if (!groups.names.empty()) group.set_attribute("group", groups.names.front());
}

void write_clumps(hdf5::Group group, const World& world) {
  std::vector<std::int64_t> id;
  std::vector<double> centre, orientation, velocity, spin, radius;
  std::vector<ClumpView> clumps(world.clumps().begin(), world.clumps().end());
  std::ranges::sort(clumps, {}, &ClumpView::id);
  for (const ClumpView& clump : clumps) {
    const Eigen::Quaterniond turn(clump.axes);
    id.push_back(clump.id), radius.push_back(clump.radius);
    centre.insert(centre.end(), clump.centre.begin(), clump.centre.end());
    orientation.insert(orientation.end(), {turn.w(), turn.x(), turn.y(), turn.z()});
    velocity.insert(velocity.end(), clump.velocity.begin(), clump.velocity.end());
    spin.insert(spin.end(), clump.spin.begin(), clump.spin.end());
  }
  const auto n = id.size();
  put(group, {"id", "1", "number that the clump keeps for the whole run", {}}, {n}, id);
  put(group, {"centre", "m", "centre of mass", {}}, {n, 3}, centre);
  put(group, {"orientation", "1", "unit quaternion (w, x, y, z) of the principal axes", {}}, {n, 4}, orientation);
  put(group, {"velocity", "m/s", "velocity of the centre of mass, half a step before the frame's time", {}}, {n, 3},
      velocity);
  put(group, {"spin", "rad/s", "angular velocity, right-handed, half a step before the frame's time", {}}, {n, 3},
      spin);
  put(group, {"radius", "m", "radius of the enclosing sphere", {}}, {n}, radius);
}

void write_contacts(hdf5::Group group, const World& world) {
  const auto ids = world.ids();
  const auto contacts = world.contacts();
  std::vector<std::int64_t> a, b, feature;
  std::vector<double> force, normal_force, branch, middle;
  for (const auto& contact : contacts) {
    const Vec3 centre = xyz(world.positions()[contact.a]) + 0.5 * contact.branch;
    a.push_back(ids[contact.a]);
    b.push_back(contact.with_wall ? -1 - std::int64_t{contact.b} : std::int64_t{ids[contact.b]});
    feature.push_back(contact.with_wall ? std::int64_t{contact.feature} : -1);
    force.insert(force.end(), contact.force.data(), contact.force.data() + 3);
    normal_force.push_back(contact.normal_force);
    branch.insert(branch.end(), contact.branch.data(), contact.branch.data() + 3);
    middle.insert(middle.end(), centre.data(), centre.data() + 3);
  }
  const auto m = contacts.size();
  put(group, {"body_a", "1", "id of the first body", {}}, {m}, a);
  put(group, {"body_b", "1", "id of the second body; -1 - index of the wall for a wall", {}}, {m}, b);
  put(group, {"feature", "1", "feature of the wall, as numbered by its geometry; -1 between bodies", {}}, {m}, feature);
  put(group, {"force", "N", "force on the second body or wall; its opposite acts on the first", {}}, {m, 3}, force);
  put(group, {"normal_force", "N", "normal force, positive in compression", {}}, {m}, normal_force);
  put(group, {"branch", "m", "from the first body's centre to the second's, or to the contact point on the wall", {}},
      {m, 3}, branch);
  put(group, {"middle", "m", "middle of the branch", {}}, {m, 3}, middle);
}

void write_walls(hdf5::Group group, const World& world, std::span<const WallShape> shapes) {
  const auto walls = world.walls();
  for (std::size_t index = 0; index < walls.size(); ++index) {
    const auto& wall = walls[index];
    std::vector<double> corners;
    for (const auto& corner : triangles_of(wall, shapes, world.stage()))
      corners.insert(corners.end(), corner.data(), corner.data() + 3);
    auto triangles = put(group, {wall.name, "m", "corners of the wall's triangles in its present position", {}},
                         {corners.size() / 9, 3, 3}, corners);
    triangles.set_attribute("index", static_cast<std::int64_t>(index));
    triangles.set_attribute("pressure", wall.pressure);
    set_vector(triangles, "force", wall.force);
    set_wall(triangles, {wall.name, {wall.pose.about, wall.position, wall.pose.turn}, wall.velocity, wall.spin});
  }
}

/// ParaView needs the corner indices of triangles, with one row per triangle of a wall.
void write_corners(hdf5::Group& file, const std::vector<std::pair<std::string, std::size_t>>& walls) {
  std::size_t most = 0;
  for (const auto& [name, triangles] : walls) most = std::max(most, triangles);
  std::vector<std::int32_t> corners(3 * most);
  std::iota(corners.begin(), corners.end(), 0);
  put(file, {"corners", "1", "0, 1, 2 …: corner indices of the triangles of any wall", {}}, {most, 3}, corners);
}

void write_probes(hdf5::Group group, std::span<const FieldGroup> probes) {
  for (const auto& probe : probes) {
    auto tables = group.create_group(probe.name);
    for (const auto& field : probe.fields) {
      if (field.width == 0 || field.values.size() % field.width != 0)
        throw PluginError(fmt::format("probe '{}': found {} values in field '{}'; allowed are whole rows of {}",
                                      probe.name, field.values.size(), field.name, field.width));
      const auto rows = field.values.size() / field.width;
      auto table = put(tables, {field.name, field.unit, field.doc, {}},
                       field.width == 1 ? hdf5::Shape{rows} : hdf5::Shape{rows, field.width}, field.values);
      if (!field.components.empty())
        table.set_attribute("components", fmt::format("{}", fmt::join(field.components, " ")));
      if (!field.wall.empty()) table.set_attribute("wall", field.wall);
    }
  }
}

// ---- the index

/// A dataset that ParaView shows on the points of its group.
struct Attribute {
  const char *name, *type;
  int bytes, width;
};
namespace attribute {
constexpr Attribute radius{"radius", "Float", 8, 1}, velocity{"velocity", "Float", 8, 3}, spin{"spin", "Float", 8, 3},
    id{"id", "Int", 8, 1}, material{"material", "Int", 4, 1}, clump{"clump", "Int", 8, 1},
    body_group{"group", "Int", 4, 1}, rotation{"rotation", "Float", 8, 3}, displacement{"displacement", "Float", 8, 3},
    normal_force{"normal_force", "Float", 8, 1}, force{"force", "Float", 8, 3}, branch{"branch", "Float", 8, 3},
    body_a{"body_a", "Int", 8, 1}, body_b{"body_b", "Int", 8, 1};
}  // namespace attribute

/// The grids of one frame.
class FrameIndex {
 public:
  FrameIndex(std::size_t number, double time) : number_(number), time_(time) {}

  std::string points(const std::string& group, std::size_t rows, const char* position,
                     const std::vector<Attribute>& columns) const {
    std::string attributes;
    for (const Attribute& column : columns)
      attributes += fmt::format("    <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n",
                                column.name, column.width == 3 ? "Vector" : "Scalar",
                                item(column.type, column.bytes, dimensions(rows, column.width), group + column.name));
    return grid(
        fmt::format("<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\"/>", rows),
        item("Float", 8, dimensions(rows, 3), group + position), attributes);
  }

  /// An attribute of the triangles of a wall.
  std::string of_triangles(const std::string& name, const std::string& path, std::size_t count, int width) const {
    return fmt::format("    <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Cell\">{}</Attribute>\n",
                       escaped(name), width == 3 ? "Vector" : "Scalar",
                       item("Float", 8, dimensions(count, width), path));
  }

  std::string triangles(const std::string& path, std::size_t count, const std::string& attributes) const {
    return grid(fmt::format("<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">{}</Topology>", count,
                            item("Int", 4, dimensions(count, 3), "/corners")),
                item("Float", 8, fmt::format("{} 3 3", count), path), attributes);
  }

 private:
  static std::string dimensions(std::size_t rows, int width) {
    return width == 3 ? fmt::format("{} 3", rows) : std::to_string(rows);
  }
  std::string item(const char* type, int bytes, const std::string& dimensions, const std::string& path) const {
    return fmt::format(
        "<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">frames/{}:{}</DataItem>",
        dimensions, type, bytes, frame_name(number_), escaped(path));
  }
  std::string grid(const std::string& topology, const std::string& points, const std::string& attributes) const {
    return fmt::format(
        "   <Grid Name=\"{:06}\">\n    <Time Value=\"{}\"/>\n    {}\n    <Geometry "
        "GeometryType=\"XYZ\">{}</Geometry>\n{}   </Grid>\n",
        number_, time_, topology, points, attributes);
  }

  std::size_t number_;
  double time_;
};

std::string collection(const std::string& name, const std::string& grids) {
  return fmt::format("  <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n{}  </Grid>\n",
                     escaped(name), grids);
}

}  // namespace

Frames::Frames(const std::filesystem::path& results, std::vector<WallShape> walls, std::size_t kept,
               std::span<const std::string> formats)
    : results_(results), walls_(std::move(walls)), synced_(kept) {
  for (const FrameExport& one : frame_exports())
    if (std::ranges::find(formats, one.format) != formats.end()) exports_.push_back(&one);
  const auto folder = results_ / "frames";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder.string() + ": cannot make the folder: " + error.message());

  for (std::size_t number = 0; number < kept; ++number) instants_.push_back(kept_instant(folder / frame_name(number)));
  const auto old = later();
  for (const auto& path : old)
    if (!is_own_frame(path)) throw FileError(path.string() + foreign_frame);
  for (const auto& path : old)
    if (std::filesystem::remove(path, error); error)
      throw FileError(path.string() + ": cannot remove it: " + error.message());
  write_indices();
  const auto is_written = [&](const FrameExport& one) { return std::ranges::find(exports_, &one) != exports_.end(); };
  for (const FrameExport& one : frame_exports())
    if (one.collection != nullptr && !is_written(one) && std::filesystem::exists(results_ / one.collection, error))
      write_collection(one);
}

/// Also those of a format that the description had before.
std::vector<std::filesystem::path> Frames::later() const {
  const auto is_later = [&](const std::string& name, const char* suffix) {
    const std::string part = temporary_path(suffix).string();
    for (const char* end : {suffix, part.c_str()})
      if (const auto number = frame_number(name, end); number && *number >= instants_.size()) return true;
    return false;
  };
  std::vector<std::filesystem::path> later;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(results_ / "frames", error)) {
    const std::string name = entry.path().filename().string();
    const auto is_of = [&](const FrameExport& one) { return is_later(name, one.suffix); };
    if (is_later(name, ".h5") || std::ranges::any_of(frame_exports(), is_of)) later.push_back(entry.path());
  }
  return later;
}

void Frames::expect_room() const {
  const auto expect_none = [&](const char* suffix) {
    const auto path = results_ / "frames" / frame_name(instants_.size(), suffix);
    if (file_stamp(path)) throw RefusedRecord(path.string() + foreign_frame);
  };
  expect_none(".h5");
  for (const FrameExport* one : exports_) expect_none(one->suffix);
}

Frames::Instant Frames::instant_of(const hdf5::File& file) {
  const auto bodies = file.group("bodies"), walls = file.group("walls");
  Instant instant{.time = file.number<double>("time"),
                  .bodies = bodies.dataset("id").rows(),
                  .contacts = file.group("contacts").dataset("middle").rows(),
                  .clump = bodies.has("clump"),
                  .group = bodies.has("group"),
                  .rotation = bodies.has("rotation"),
                  .displacement = bodies.has("displacement"),
                  .walls = {},
                  .on_walls = {}};
  for (const auto& name : walls.names()) instant.walls.push_back({name, walls.dataset(name).rows()});
  const auto probes = file.group("probes");
  for (const auto& probe : probes.names()) {
    const auto tables = probes.group(probe);
    for (const auto& name : tables.names()) {
      const auto table = tables.dataset(name);
      if (!table.has_attribute("wall")) continue;
      const std::string wall = table.text("wall");
      const std::size_t width = hdf5::product(table.shape()) / std::max<std::size_t>(table.rows(), 1);
      if (walls.has(wall) && walls.dataset(wall).rows() == table.rows() && (width == 1 || width == 3))
        instant.on_walls.push_back({wall, probe, name, width});
    }
  }
  return instant;
}

std::optional<Frames::Instant> Frames::kept_instant(const std::filesystem::path& path) try {
  if (!std::filesystem::exists(path)) return std::nullopt;
  return instant_of(hdf5::File(path, hdf5::Mode::read_whole));
} catch (const FileError& error) {
  throw FileError(std::string(error.what()) + "; to continue without this frame, remove it");
}

void Frames::sync() {
  constexpr std::size_t few = 32;
  const auto folder = results_ / "frames";
  const auto sync_one = [&](std::size_t number, const char* suffix) {
    const auto path = folder / frame_name(number, suffix);
    if (std::filesystem::exists(path)) sync_to_disk(path);  // else it was removed to free space
  };
  if (instants_.size() - synced_ > few) sync_file_system(folder);
  else
    for (std::size_t number = synced_; number < instants_.size(); ++number) {
      sync_one(number, ".h5");
      for (const FrameExport* one : exports_) sync_one(number, one->suffix);
    }
  if (synced_ < instants_.size()) sync_folder(folder);
  synced_ = instants_.size();
}

void Frames::write(const World& world, std::span<const FieldGroup> fields) {
  const auto path = results_ / "frames" / frame_name(instants_.size());
  hdf5::File file(temporary_path(path), hdf5::Mode::write_whole);
  file.set_attribute("time", world.time());
  file.set_attribute("step", world.step());
  file.set_attribute("stage", world.stage());
  const Cell& cell = world.cell();
  set_vector(file, "cell_low", cell.low), set_vector(file, "cell_high", cell.high);
  set_vector(file, "strain_rate", cell.strain_rate);
  set_vector(file, "shear_rate", cell.shear_rate), set_vector(file, "tilt", cell.tilt);
  write_bodies(file.create_group("bodies"), world);
  if (!world.clumps().empty()) write_clumps(file.create_group("clumps"), world);
  write_contacts(file.create_group("contacts"), world);
  write_walls(file.create_group("walls"), world, walls_);
  write_probes(file.create_group("probes"), fields);
  Instant instant = instant_of(file);
  write_corners(file, instant.walls);
  file.close();
  publish_new(path);
  for (const FrameExport* one : exports_)
    write_new(results_ / "frames" / frame_name(instants_.size(), one->suffix), one->text(world, walls_));
  instants_.push_back(std::move(instant));
  // In all, at most eleven times the final indices and a thousandth of the time are written.
  if (10 * (instants_.size() - indexed_) > indexed_ ||
      std::chrono::steady_clock::now() - indexed_at_ > 1000 * indexing_)
    write_indices();
}

void Frames::update_indices() {
  if (indexed_ < instants_.size()) write_indices();
}

void Frames::write_indices() {
  const auto began = std::chrono::steady_clock::now();
  write_xdmf();
  for (const FrameExport* one : exports_)
    if (one->collection != nullptr) write_collection(*one);
  indexed_ = instants_.size(), indexed_at_ = std::chrono::steady_clock::now();
  indexing_ = indexed_at_ - began;
}

/// Frames before a format was added have no file in it.
void Frames::write_collection(const FrameExport& one) const {
  std::vector<TimedFile> files;
  for (std::size_t number = 0; number < instants_.size(); ++number) {
    const std::string file = "frames/" + frame_name(number, one.suffix);
    if (instants_[number] && std::filesystem::exists(results_ / file)) files.push_back({instants_[number]->time, file});
  }
  write_atomically(results_ / one.collection, vtk_collection(files));
}

void Frames::write_xdmf() const {
  std::string grains, contacts;
  std::map<std::string, std::string> walls;
  for (std::size_t number = 0; number < instants_.size(); ++number) {
    if (!instants_[number]) continue;
    const Instant& instant = *instants_[number];
    const FrameIndex index(number, instant.time);
    std::vector<Attribute> columns{attribute::radius, attribute::velocity, attribute::spin, attribute::id,
                                   attribute::material};
    if (instant.clump) columns.push_back(attribute::clump);
    if (instant.group) columns.push_back(attribute::body_group);
    if (instant.rotation) columns.push_back(attribute::rotation);
    if (instant.displacement) columns.push_back(attribute::displacement);
    grains += index.points("/bodies/", instant.bodies, "position", columns);
    contacts += index.points(
        "/contacts/", instant.contacts, "middle",
        {attribute::normal_force, attribute::force, attribute::branch, attribute::body_a, attribute::body_b});
    for (const auto& [name, triangles] : instant.walls) {
      if (triangles == 0) continue;
      std::string attributes;
      for (const auto& field : instant.on_walls)
        if (field.wall == name)
          attributes += index.of_triangles(field.probe + '/' + field.name, "/probes/" + field.probe + '/' + field.name,
                                           triangles, static_cast<int>(field.width));
      walls[name] += index.triangles("/walls/" + name, triangles, attributes);
    }
  }
  std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n <Domain>\n";
  text += collection("grains", grains) + collection("contacts", contacts);
  for (const auto& [name, grids] : walls) text += collection(name, grids);
  write_atomically(results_ / "frames.xdmf", text + " </Domain>\n</Xdmf>\n");
}

}  // namespace grit
