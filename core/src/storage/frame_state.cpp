#include "storage/frame_state.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "grit/description.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

constexpr const char* axis_names = "xyz";

std::string along(const std::string& name, int axis) { return name + '_' + axis_names[axis]; }

/// The rows of a dataset of vectors.
class Vectors {
 public:
  Vectors(const hdf5::Group& group, const char* name) : values_(group.dataset(name).read<double>()) {}
  Vec3 operator[](std::size_t row) const {
    return {values_.at(3 * row), values_.at(3 * row + 1), values_.at(3 * row + 2)};
  }

 private:
  std::vector<double> values_;
};

[[noreturn]] void refuse(const hdf5::Object& object, const std::string& what) {
  throw FileError(object.where() + ": " + what + "; the file is damaged or not of grit");
}

bool is_number_of_body(std::int64_t id) { return id >= 0 && id < std::numeric_limits<std::uint32_t>::max(); }

/// Places of bodies and clumps, which runs begin from: ids ascend, numbers are finite and sizes positive.
template <class Placed>
void check(const std::vector<Placed>& all, const hdf5::Group& group, Vec3 Placed::*place) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Placed& one = all[i];
    if (i > 0 && all[i - 1].id >= one.id) refuse(group, "ids do not ascend");
    if (!(one.*place).allFinite() || !one.velocity.allFinite() || !one.spin.allFinite() || !(one.radius > 0) ||
        !std::isfinite(one.radius))
      refuse(group, "number " + std::to_string(one.id) + " has a position, a velocity or a radius that is no number");
  }
}

void check_references(const hdf5::Group& group, const FrameState& frame) {
  for (const FrameBody& body : frame.bodies) {
    if (body.group >= std::max<std::size_t>(frame.groups.size(), 1))
      refuse(group, "a body is in a group without a name");
    if (body.clump >= 0 && !std::ranges::binary_search(frame.clumps, body.clump, {}, &FrameClump::id))
      refuse(group, "a body is of a clump that the frame does not hold");
  }
}

void read_bodies(const hdf5::Group& group, FrameState& frame) {
  const auto id = group.dataset("id").read<std::int64_t>();
  const auto radius = group.dataset("radius").read<double>();
  const Vectors position(group, "position"), velocity(group, "velocity"), spin(group, "spin");
  std::vector<std::int64_t> clump(id.size(), -1);
  if (group.has("clump")) clump = group.dataset("clump").read<std::int64_t>();
  std::vector<std::int32_t> of(id.size(), 0);
  if (group.has("group")) {
    of = group.dataset("group").read<std::int32_t>();
    frame.groups = Description::parse(group.dataset("group").text("names")).get<std::vector<std::string>>();
  } else if (group.has_attribute("group")) {
    frame.groups = {group.text("group")};
  }
  if (!std::ranges::all_of(id, is_number_of_body)) refuse(group, "holds numbers that no body has");
  for (std::size_t i = 0; i < id.size(); ++i)
    frame.bodies.push_back({.id = static_cast<std::uint32_t>(id[i]),
                            .group = static_cast<std::size_t>(of.at(i)),
                            .clump = clump.at(i),
                            .position = position[i],
                            .velocity = velocity[i],
                            .spin = spin[i],
                            .radius = radius.at(i)});
  check(frame.bodies, group, &FrameBody::position);
}

void read_clumps(const hdf5::Group& group, FrameState& frame) {
  const auto id = group.dataset("id").read<std::int64_t>();
  const auto radius = group.dataset("radius").read<double>(), turn = group.dataset("orientation").read<double>();
  if (!std::ranges::all_of(id, is_number_of_body)) refuse(group, "holds numbers that no clump has");
  const Vectors centre(group, "centre"), velocity(group, "velocity"), spin(group, "spin");
  for (std::size_t i = 0; i < id.size(); ++i) {
    const Eigen::Quaterniond q(turn.at(4 * i), turn.at(4 * i + 1), turn.at(4 * i + 2), turn.at(4 * i + 3));
    if (!(q.norm() > 0) || !std::isfinite(q.norm())) refuse(group, "an orientation is no rotation");
    frame.clumps.push_back({.id = id[i],
                            .centre = centre[i],
                            .velocity = velocity[i],
                            .spin = spin[i],
                            .orientation = q.normalized(),
                            .radius = radius.at(i)});
  }
  check(frame.clumps, group, &FrameClump::centre);
}

FrameWall read_wall(const std::string& name, const hdf5::Object& object) {
  const Vec3 xyz = vector_of(object, "orientation");
  const Eigen::Quaterniond turn(object.number<double>("orientation_w"), xyz.x(), xyz.y(), xyz.z());
  if (!(turn.norm() > 0) || !std::isfinite(turn.norm())) refuse(object, "its orientation is no rotation");
  return {name,
          {vector_of(object, "reference"), vector_of(object, "displacement"), turn.normalized().toRotationMatrix()},
          vector_of(object, "velocity"),
          vector_of(object, "spin")};
}

}  // namespace

std::string frame_name(std::size_t number, const char* suffix) { return fmt::format("{:06}{}", number, suffix); }

std::optional<std::size_t> frame_number(const std::string& file_name, const char* suffix) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(file_name.data(), file_name.data() + file_name.size(), number);
  if (error != std::errc() || file_name != frame_name(number, suffix)) return std::nullopt;
  return number;
}

void set_vector(hdf5::Object& object, const std::string& name, const Vec3& vector) {
  for (int axis = 0; axis < 3; ++axis) object.set_attribute(along(name, axis), vector[axis]);
}

Vec3 vector_of(const hdf5::Object& object, const std::string& name) {
  Vec3 vector;
  for (int axis = 0; axis < 3; ++axis) vector[axis] = object.number<double>(along(name, axis));
  return vector;
}

void set_wall(hdf5::Object& object, const FrameWall& wall) {
  const Eigen::Quaterniond turn(wall.pose.turn);
  set_vector(object, "reference", wall.pose.about), set_vector(object, "displacement", wall.pose.shift);
  object.set_attribute("orientation_w", turn.w()), set_vector(object, "orientation", turn.vec());
  set_vector(object, "velocity", wall.velocity), set_vector(object, "spin", wall.spin);
}

FrameState read_frame_state(const std::filesystem::path& path) try {
  const hdf5::File file(path, hdf5::Mode::read_whole);
  if (!file.has_attribute("tilt_x"))
    throw FileError(path.string() +
                    ": is of an earlier version, whose frames hold neither poses of walls nor the cell; run the sample "
                    "again");
  FrameState frame;
  frame.stage = file.text("stage");
  frame.cell_low = vector_of(file, "cell_low"), frame.cell_high = vector_of(file, "cell_high");
  frame.strain_rate = vector_of(file, "strain_rate");
  frame.shear_rate = vector_of(file, "shear_rate"), frame.tilt = vector_of(file, "tilt");
  read_bodies(file.group("bodies"), frame);
  if (file.has("clumps")) read_clumps(file.group("clumps"), frame);
  check_references(file.group("bodies"), frame);
  const auto walls = file.group("walls");
  for (const std::string& name : walls.names()) frame.walls.push_back(read_wall(name, walls.dataset(name)));
  return frame;
} catch (const std::out_of_range&) {
  throw FileError(path.string() + ": has datasets of different lengths; the file is damaged");
} catch (const Description::exception&) {
  throw FileError(path.string() + ": names of groups are not a list of names; the file is damaged");
}

double time_of_frame(const std::filesystem::path& path) {
  return hdf5::File(path, hdf5::Mode::read_whole).number<double>("time");
}

}  // namespace grit
