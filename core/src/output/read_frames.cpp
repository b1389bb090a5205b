#include "output/read_frames.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "grit/description.hpp"
#include "grit/error.hpp"
#include "storage/hdf5.hpp"

namespace grit {
namespace {

/// Reads a dataset of `rows` rows of `width` values.
template <class T>
std::vector<T> column(const hdf5::Group& group, const std::string& name, std::size_t rows, std::size_t width = 1) {
  const auto dataset = group.dataset(name);
  if (hdf5::product(dataset.shape()) != rows * width)
    throw FileError(dataset.where() + ": has " + std::to_string(hdf5::product(dataset.shape())) + " values, not " +
                    std::to_string(rows * width));
  return dataset.read<T>();
}

[[noreturn]] void refuse(const hdf5::Object& object, const std::string& what) {
  throw FileError(object.where() + ": " + what + "; the file is damaged or not of grit");
}

/// Names in the order of their numbers.
std::vector<std::string> names_of_groups(const hdf5::Dataset& group) try {
  return Description::parse(group.text("names")).get<std::vector<std::string>>();
} catch (const Description::exception&) {
  refuse(group, "its attribute 'names' is not a list of names");
}

void read_bodies(const hdf5::Group& group, Frame& frame) {
  const auto ids = group.dataset("id");
  frame.id = ids.read<std::int64_t>();
  if (std::ranges::adjacent_find(frame.id, std::ranges::greater()) != frame.id.end())
    refuse(ids, "numbers of bodies do not ascend");
  const auto n = frame.id.size();
  frame.position = column<double>(group, "position", n, 3);
  frame.radius = column<double>(group, "radius", n);
  frame.velocity = column<double>(group, "velocity", n, 3);
  if (group.has("rotation")) frame.rotation = column<double>(group, "rotation", n, 3);
  if (group.has("displacement")) frame.displacement = column<double>(group, "displacement", n, 3);
  if (group.has("clump")) frame.clump = column<std::int64_t>(group, "clump", n);
  if (group.has("group")) {
    frame.group = column<std::int32_t>(group, "group", n);
    frame.group_names = names_of_groups(group.dataset("group"));
    const auto known = [&](std::int32_t one) { return one >= 0 && std::cmp_less(one, frame.group_names.size()); };
    if (!std::ranges::all_of(frame.group, known)) refuse(group.dataset("group"), "a body is in a group without a name");
  }
}

void read_contacts(const hdf5::Group& group, Frame& frame) {
  frame.body_a = group.dataset("body_a").read<std::int64_t>();
  const auto m = frame.body_a.size();
  frame.normal_force = column<double>(group, "normal_force", m);
  frame.branch = column<double>(group, "branch", m, 3);
}

/// The rows of a probe correspond to the first contacts of the frame if their normal forces are equal.
void read_chains(const hdf5::Group& probes, Frame& frame) {
  for (const auto& probe : probes.names()) {
    const auto tables = probes.group(probe);
    if (!tables.has("chain") || !tables.has("normal_force")) continue;
    const auto force = tables.dataset("normal_force").read<double>(), chain = tables.dataset("chain").read<double>();
    if (chain.size() != force.size() || force.size() > frame.normal_force.size() ||
        !std::equal(force.begin(), force.end(), frame.normal_force.begin()))
      continue;
    constexpr double most = std::numeric_limits<std::uint32_t>::max();
    if (!std::ranges::all_of(chain, [](double one) { return one >= 0 && one <= most; }))
      refuse(tables.dataset("chain"), "numbers of chains are not whole numbers");
    frame.chain.assign(frame.normal_force.size(), 0);
    std::ranges::transform(chain, frame.chain.begin(), [](double one) { return static_cast<std::uint32_t>(one); });
    return;
  }
}

/// A table of a probe, if it has this many rows.
std::optional<Field> read_field(const hdf5::Group& tables, const std::string& name, std::size_t rows) {
  const auto table = tables.dataset(name);
  const auto shape = table.shape();
  if (shape.empty() || shape.front() != rows) return std::nullopt;
  return Field{name,
               table.text("units"),
               table.text("long_name"),
               hdf5::product(std::span(shape).subspan(1)),
               table.read<double>(),
               table.words("components")};
}

void read_values(const hdf5::Group& probes, Frame& frame) {
  for (const auto& probe : probes.names()) {
    const auto tables = probes.group(probe);
    if (!tables.has("id")) continue;
    const std::size_t rows = tables.dataset("id").rows();
    FieldGroup of_bodies{probe, {}};
    for (const auto& name : tables.names())
      if (auto field = read_field(tables, name, rows)) of_bodies.fields.push_back(std::move(*field));
    std::ranges::move(values_of_bodies(of_bodies, frame.id), std::back_inserter(frame.values));
  }
}

void read_walls(const hdf5::Group& group, Frame& frame) {
  for (const auto& name : group.names()) {
    const auto wall = group.dataset(name);
    const auto shape = wall.shape();
    if (shape.size() != 3 || shape[1] != 3 || shape[2] != 3) refuse(wall, "is not a list of triangles");
    frame.walls.push_back({name,
                           wall.read<double>(),
                           {wall.number<double>("displacement_x"), wall.number<double>("displacement_y"),
                            wall.number<double>("displacement_z")}});
  }
}

void read_wall_fields(const hdf5::Group& probes, Frame& frame) {
  for (const auto& probe : probes.names()) {
    const auto tables = probes.group(probe);
    for (const auto& name : tables.names()) {
      const auto table = tables.dataset(name);
      if (!table.has_attribute("wall")) continue;
      const auto wall = std::ranges::find(frame.walls, table.text("wall"), &Frame::Wall::name);
      if (wall == frame.walls.end()) continue;
      if (auto field = read_field(tables, name, wall->corners.size() / 9)) {
        field->name = probe + '/' + name;
        wall->fields.push_back(std::move(*field));
      }
    }
  }
}

}  // namespace

std::vector<std::filesystem::path> frame_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "frames", none))
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

Frame read_frame(const std::filesystem::path& path) {
  const hdf5::File file(path, hdf5::Mode::read_whole);
  Frame frame;
  frame.time = file.number<double>("time");
  frame.step = file.number<std::uint64_t>("step");
  frame.stage = file.text("stage");
  read_bodies(file.group("bodies"), frame);
  read_contacts(file.group("contacts"), frame);
  read_walls(file.group("walls"), frame);
  if (file.has("probes")) {
    const auto probes = file.group("probes");
    read_chains(probes, frame), read_values(probes, frame), read_wall_fields(probes, frame);
  }
  return frame;
}

std::vector<FieldGroup> read_maps(const std::filesystem::path& path) {
  const hdf5::File file(path, hdf5::Mode::read_whole);
  std::vector<FieldGroup> maps;
  if (!file.has("probes")) return maps;
  const auto probes = file.group("probes");
  for (const auto& probe : probes.names()) {
    const auto tables = probes.group(probe);
    if (!tables.has("centre") || !tables.has("size")) continue;
    const auto cells = tables.dataset("centre").rows();
    FieldGroup map{probe, {}};
    const auto add = [&](const std::string& name) {
      if (auto field = read_field(tables, name, cells)) map.fields.push_back(std::move(*field));
    };
    add("centre"), add("size");
    const bool placed = map.fields.size() == 2 && map.fields[0].width == 3 && map.fields[1].width == 3;
    for (const auto& name : tables.names())
      if (name != "centre" && name != "size") add(name);
    if (placed && map.fields.size() > 2) maps.push_back(std::move(map));
  }
  return maps;
}

std::size_t bodies_in_frame(const std::filesystem::path& path) {
  return hdf5::File(path, hdf5::Mode::read_whole).group("bodies").dataset("id").rows();
}

std::string stage_of_frame(const std::filesystem::path& path) {
  return hdf5::File(path, hdf5::Mode::read_whole).text("stage");
}

}  // namespace grit
