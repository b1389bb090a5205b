#include "report/grain_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "output/colours.hpp"
#include "output/read_frames.hpp"
#include "output/scale.hpp"
#include "output/shown_fields.hpp"
#include "output/strays.hpp"
#include "report/cell_maps.hpp"
#include "report/layers.hpp"

namespace grit {
namespace {

/// Evenly chosen files that fit into the page, including the first and the last.
std::vector<std::filesystem::path> chosen(std::span<const std::filesystem::path> files, const GrainLimits& limits,
                                          std::vector<std::string>& problems, std::size_t& left_out) {
  std::vector<std::filesystem::path> whole;
  std::size_t largest = 1;
  for (const auto& file : files) try {
      largest = std::max(largest, bodies_in_frame(file));
      whole.push_back(file);
    } catch (const FileError& error) {
      problems.emplace_back(error.what());
    }
  constexpr std::size_t bytes_a_body = 20;
  const std::size_t most = std::max<std::size_t>(2, limits.bytes / (bytes_a_body * largest));
  left_out = whole.size() - std::min(whole.size(), most);
  if (left_out == 0) return whole;
  std::vector<std::filesystem::path> taken;
  for (std::size_t i = 0; i < most; ++i) taken.push_back(whole[i * (whole.size() - 1) / (most - 1)]);
  return taken;
}

double length(const std::vector<double>& vectors, std::size_t i) {
  return std::hypot(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]);
}

std::vector<double> speeds(const Frame& frame) {
  std::vector<double> all(frame.bodies());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = length(frame.velocity, i);
  return all;
}

/// Largest component, and for each axis a bound of most bodies.
struct VectorRange {
  double largest = 0;
  std::array<double, 3> limits{};
  bool everywhere = true;

  void add(const std::vector<double>& vectors, std::size_t bodies) {
    if (vectors.empty() && bodies > 0) everywhere = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> sizes;
      for (std::size_t i = axis; i < vectors.size(); i += 3)
        if (std::isfinite(vectors[i])) sizes.push_back(std::abs(vectors[i]));
      for (const double size : sizes) largest = std::max(largest, size);
      limits[axis] = std::max(limits[axis], colour_limit(std::move(sizes)));
    }
  }
};

/// The box of centres.
struct Box {
  std::array<double, 3> low, high;

  Box() {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const std::vector<double>& positions) {
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (const double x = positions[i]; std::isfinite(x))
        low[i % 3] = std::min(low[i % 3], x), high[i % 3] = std::max(high[i % 3], x);
  }
};

/// Numbers of a colour. Those that are not drawable() do not count.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity(), high = -low, limit = 0;

  void add(const std::vector<double>& values, bool with_zero) {
    std::vector<double> sizes;
    for (const double value : values) {
      if (!drawable(value)) continue;
      low = std::min(low, value), high = std::max(high, value);
      if (with_zero || value != 0) sizes.push_back(std::abs(value));
    }
    limit = std::max(limit, colour_limit(std::move(sizes)));
  }
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
};

/// Numbers of a field: one, or the magnitude of a vector.
std::vector<double> sizes_of(const Field& field) {
  if (field.width == 1) return field.values;
  std::vector<double> sizes;
  for (std::size_t i = 0; i + field.width <= field.values.size(); i += field.width) {
    double sum = 0;
    for (std::size_t k = 0; k < field.width; ++k) sum += field.values[i + k] * field.values[i + k];
    sizes.push_back(std::sqrt(sum));
  }
  return sizes;
}

/// Ranges of a stage. By stage, so that a fast one does not compress the colours of others.
struct StageExtent {
  double speed = 0, speed_limit = 0;
  VectorRange rotation, displacement;
  std::map<std::string, ValueRange> values, wall_fields;  ///< by name; of walls also by wall

  void add(const Frame& frame) {
    std::vector<double> finite = speeds(frame);
    std::erase_if(finite, [](double v) { return !std::isfinite(v); });
    for (const double v : finite) speed = std::max(speed, v);
    speed_limit = std::max(speed_limit, colour_limit(std::move(finite)));
    rotation.add(frame.rotation, frame.bodies()), displacement.add(frame.displacement, frame.bodies());
    for (const BodyValues& one : frame.values) values[one.name].add(one.of_bodies, true);
    for (const Frame::Wall& wall : frame.walls)
      for (const Field& field : wall.fields) wall_fields[field.name + ' ' + wall.name].add(sizes_of(field), false);
  }
};

/// A number of bodies or triangles of walls that the page can show.
struct Shown {
  std::string name, label, unit, about, wall;
  bool is_signed;
  std::string key() const { return wall.empty() ? name : name + ' ' + wall; }
};

/// Ranges of all frames.
struct Extent : Box {
  double reach = 0, diameters = 0;
  std::size_t bodies = 0;
  std::map<std::string, StageExtent> stages;
  std::vector<Shown> values, wall_fields;  ///< in the order of their appearance
  std::size_t triangles = 0;               ///< of walls with fields, of all frames, once for each field

  void add(const Frame& frame) {
    Box::add(frame.position);
    for (const double part : frame.branch)
      if (std::isfinite(part)) reach = std::max(reach, std::abs(part));
    for (const double radius : frame.radius) diameters += 2 * radius;
    bodies += frame.bodies();
    stages[frame.stage].add(frame);
    const auto note = [](std::vector<Shown>& all, Shown one) {
      const auto same = [&](const Shown& other) { return other.key() == one.key(); };
      if (std::ranges::none_of(all, same)) all.push_back(std::move(one));
    };
    for (const BodyValues& one : frame.values)
      note(values, {one.name, one.label, one.unit, one.doc, "", one.is_signed});
    for (const Frame::Wall& wall : frame.walls)
      for (const Field& field : wall.fields) {
        triangles += wall.corners.size() / 9;
        note(wall_fields, {field.name, spelled(field.name.substr(field.name.find('/') + 1)), field.unit, field.doc,
                           wall.name, field.width == 1 && is_signed(field, 0)});
      }
  }
  /// The largest magnitude in any stage.
  double largest(const std::string& key, std::map<std::string, ValueRange> StageExtent::*ranges) const {
    double most = 0;
    for (const auto& [name, stage] : stages)
      if (const auto found = (stage.*ranges).find(key); found != (stage.*ranges).end())
        if (found->second.low <= found->second.high) most = std::max(most, found->second.largest());
    return most;
  }
  bool everywhere(VectorRange StageExtent::*vectors) const {
    return std::ranges::all_of(stages, [&](const auto& stage) { return (stage.second.*vectors).everywhere; });
  }
};

/// Removes bodies without a finite position, or extremely far away, as after a failed run; returns their number.
std::size_t drop_unplaced(Frame& frame) {
  const Fences fences(frame, far_to_keep);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < frame.bodies(); ++i)
    if (fences.hold(frame.position, i)) kept.push_back(i);
  const std::size_t dropped = frame.bodies() - kept.size();
  if (dropped == 0) return 0;
  const auto keep = [&]<class T>(std::vector<T>& rows, std::size_t width) {
    if (rows.empty()) return;
    std::vector<T> left;
    for (const std::size_t i : kept)
      for (std::size_t k = 0; k < width; ++k) left.push_back(rows[width * i + k]);
    rows = std::move(left);
  };
  keep(frame.radius, 1), keep(frame.clump, 1), keep(frame.group, 1);
  for (auto* vectors : {&frame.position, &frame.velocity, &frame.rotation, &frame.displacement}) keep(*vectors, 3);
  for (BodyValues& one : frame.values) keep(one.of_bodies, 1);
  keep(frame.id, 1);
  return dropped;
}

constexpr std::array vector_colours{std::pair("rotation", &StageExtent::rotation),
                                    std::pair("displacement", &StageExtent::displacement)};

using Numbers = std::vector<std::uint16_t>;

void append(Numbers& numbers, const std::vector<double>& values, double low, double high) {
  for (const double value : values) numbers.push_back(quantised(value, low, high));
}

std::vector<double> component(const std::vector<double>& vectors, std::size_t axis) {
  std::vector<double> all;
  all.reserve(vectors.size() / 3);
  for (std::size_t i = axis; i < vectors.size(); i += 3) all.push_back(vectors[i]);
  return all;
}

/// Indices of the strongest contacts above the mean, at most `most`.
std::vector<std::uint32_t> chain_contacts(const Frame& frame, std::size_t most, double& mean) {
  const auto& force = frame.normal_force;
  mean = force.empty() ? 0 : std::accumulate(force.begin(), force.end(), 0.0) / static_cast<double>(force.size());
  std::vector<std::uint32_t> strong;
  for (std::uint32_t i = 0; i < force.size(); ++i)
    if (force[i] > mean) strong.push_back(i);
  if (strong.size() > most) {
    std::ranges::nth_element(strong, strong.begin() + static_cast<std::ptrdiff_t>(most), std::greater(),
                             [&](std::uint32_t i) { return force[i]; });
    strong.resize(most);
  }
  return strong;
}

/// Equal up to rounding of the subtracted displacement.
bool alike(const std::vector<float>& a, const std::vector<float>& b) {
  const auto size = [](float most, float x) { return std::max(most, std::abs(x)); };
  const float slack = 1e-6f * std::accumulate(a.begin(), a.end(), 0.0f, size);
  return std::ranges::equal(a, b, [&](float x, float y) { return std::abs(x - y) <= slack; });
}

class Writer {
 public:
  Writer(const Extent& extent, const GrainLimits& limits, DataElements& data)
      : extent_(extent), limits_(limits), data_(data), values_(extent.values), wall_fields_(extent.wall_fields) {
    const auto fit = [&](std::vector<Shown>& all, std::size_t bytes_of_each) {
      const std::size_t most = limits.value_bytes / std::max<std::size_t>(1, bytes_of_each);
      if (all.size() > most) left_out_ += all.size() - most, all.resize(most);
    };
    fit(values_, sizeof(std::uint16_t) * extent.bodies);
    fit(wall_fields_, sizeof(float) * extent.triangles / std::max<std::size_t>(1, wall_fields_.size()));
  }

  void add(const Frame& frame, std::size_t unplaced) {
    const std::size_t set = set_of(frame);
    Description json = {{"time", frame.time}, {"step", frame.step}, {"stage", frame.stage}, {"set", set}};
    if (unplaced > 0) json["unplaced"] = unplaced;
    add_box(frame, json);
    add_bodies(frame, set, json);
    add_values(frame, json);
    add_contacts(frame, json);
    add_walls(frame, json);
    frames_.push_back(std::move(json));
    instants_.push_back({frame.stage, frame.bodies() + unplaced});
  }

  std::size_t frames() const { return frames_.size(); }
  Description result() const {
    Description bodies = Description::array(), walls = Description::array();
    for (const Set& set : sets_)
      bodies.push_back(
          Description{{"count", set.id.size()}, {"data", set.data}, {"clumps", set.clumps}, {"groups", set.groups}});
    for (const Wall& wall : walls_)
      walls.push_back(
          Description{{"name", wall.name}, {"data", wall.data}, {"low", wall.box.low}, {"high", wall.box.high}});
    const LayersBegin layers = where_layers_begin(instants_);
    Description json = {
        {"low", extent_.low},
        {"high", extent_.high},
        {"mean_diameter", extent_.diameters / static_cast<double>(std::max<std::size_t>(1, extent_.bodies))},
        {"reach", extent_.reach},
        {"clumps", clumps_},
        {"groups", groups_},
        {"bodies", bodies},
        {"walls", walls},
        {"values", shown(values_, &StageExtent::values)},
        {"wall_fields", shown(wall_fields_, &StageExtent::wall_fields)},
        {"values_left_out", left_out_},
        {"layers", {{"frame", layers.frame}, {"stage", layers.stage}}},
        {"frames", frames_}};
    for (const auto& [stage, extent] : extent_.stages) {
      Description ranges = {{"speed", extent.speed}}, limits = {{"speed", extent.speed_limit}};
      for (const auto& [name, vectors] : vector_colours)
        if (extent_.everywhere(vectors))
          ranges[name] = (extent.*vectors).largest, limits[name] = (extent.*vectors).limits;
      json["stages"][stage] = {{"ranges", std::move(ranges)}, {"limits", std::move(limits)}};
      Description& values = json["stages"][stage]["values"] = Description::array();
      for (const Shown& one : values_) {
        const ValueRange range = range_of(extent, one, &StageExtent::values);
        values.push_back(range.low <= range.high ? Description{range.low, range.high, range.limit} : Description());
      }
      Description& of_walls = json["stages"][stage]["wall_fields"] = Description::array();
      for (const Shown& one : wall_fields_) of_walls.push_back(range_of(extent, one, &StageExtent::wall_fields).limit);
    }
    return json;
  }

 private:
  /// A set of bodies shared by frames.
  struct Set {
    std::vector<std::int64_t> id;
    std::size_t data, first_frame;
    bool clumps, groups;  ///< whether it has these
    Numbers positions;
  };
  struct Wall {
    std::string name;
    std::size_t data;
    std::vector<float> corners;  ///< without its displacement
    Box box;                     ///< of them
  };
  using Ranges = std::map<std::string, ValueRange> StageExtent::*;

  static ValueRange range_of(const StageExtent& extent, const Shown& one, Ranges ranges) {
    const auto found = (extent.*ranges).find(one.key());
    return found == (extent.*ranges).end() ? ValueRange() : found->second;
  }
  Description shown(const std::vector<Shown>& all, Ranges ranges) const {
    Description list = Description::array();
    for (const Shown& one : all) {
      const ReadableUnit unit = readable(one.unit, extent_.largest(one.key(), ranges));
      Description json = {{"name", one.name},
                          {"label", one.label},
                          {"unit", unit.unit},
                          {"factor", unit.factor},
                          {"about", with_symbols(one.about)},
                          {"signed", one.is_signed}};
      if (!one.wall.empty()) json["wall"] = one.wall;
      list.push_back(std::move(json));
    }
    return list;
  }

  /// Numbers of the bodies, 65535 for those without.
  void add_values(const Frame& frame, Description& json) {
    if (values_.empty() || frame.values.empty()) return;
    constexpr std::uint16_t none = 65535;
    Numbers numbers;
    for (const Shown& shown : values_) {
      const ValueRange range = range_of(extent_.stages.at(frame.stage), shown, &StageExtent::values);
      const auto found = std::ranges::find(frame.values, shown.name, &BodyValues::name);
      for (std::size_t i = 0; i < frame.bodies(); ++i) {
        const bool known = found != frame.values.end() && drawable(found->of_bodies[i]);
        numbers.push_back(
            known ? std::min<std::uint16_t>(quantised(found->of_bodies[i], range.low, range.high), none - 1) : none);
      }
    }
    json["values"] = data_.add(byte_planes(numbers));
  }

  /// Boxes of the grains, without those far from all others.
  void add_box(const Frame& frame, Description& json) const {
    const Fences fences(frame, far_to_see);
    std::vector<double> seen, surfaces;
    for (std::size_t i = 0; i < frame.bodies(); ++i) {
      if (!fences.hold(frame.position, i)) continue;
      const double* centre = &frame.position[3 * i];
      seen.insert(seen.end(), centre, centre + 3);
      for (const double side : {-frame.radius[i], frame.radius[i]})
        for (std::size_t axis = 0; axis < 3; ++axis) surfaces.push_back(centre[axis] + side);
    }
    Box box, surface;
    box.add(seen), surface.add(surfaces);
    if (!seen.empty()) {
      json["low"] = box.low, json["high"] = box.high;
      json["surface"] = {surface.low, surface.high};
    }
    if (const std::size_t strays = frame.bodies() - seen.size() / 3; strays > 0) json["strays"] = strays;
  }

  std::size_t set_of(const Frame& frame) {
    const auto found = std::ranges::find(sets_, frame.id, &Set::id);
    if (found != sets_.end()) return static_cast<std::size_t>(found - sets_.begin());
    std::vector<std::byte> bytes;
    const auto put = [&]<class T>(const std::vector<T>& numbers) {
      const auto all = std::as_bytes(std::span(numbers));
      bytes.insert(bytes.end(), all.begin(), all.end());
    };
    put(std::vector<float>(frame.radius.begin(), frame.radius.end()));
    put(std::vector<std::int32_t>(frame.id.begin(), frame.id.end()));
    if (!frame.clump.empty()) put(std::vector<std::int32_t>(frame.clump.begin(), frame.clump.end())), clumps_ = true;
    if (!frame.group.empty()) put(frame.group), groups_ = frame.group_names;
    sets_.push_back({frame.id, data_.add(bytes), frames_.size(), !frame.clump.empty(), !frame.group.empty(), {}});
    return sets_.size() - 1;
  }

  void add_bodies(const Frame& frame, std::size_t number, Description& json) {
    Set& set = sets_[number];
    Numbers numbers;
    for (std::size_t axis = 0; axis < 3; ++axis)
      append(numbers, component(frame.position, axis), extent_.low[axis], extent_.high[axis]);
    if (set.positions.empty()) {
      set.positions = numbers;
    } else {  // small differences deflate well
      for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = static_cast<std::uint16_t>(numbers[i] - set.positions[i]);
    }
    const StageExtent& extent = extent_.stages.at(frame.stage);
    append(numbers, speeds(frame), 0, extent.speed);
    const auto add_vectors = [&](VectorRange StageExtent::*range, const std::vector<double>& vectors) {
      const double largest = (extent.*range).largest;
      for (std::size_t axis = 0; axis < 3 && extent_.everywhere(range); ++axis)
        append(numbers, component(vectors, axis), -largest, largest);
    };
    add_vectors(&StageExtent::rotation, frame.rotation);
    add_vectors(&StageExtent::displacement, frame.displacement);
    json["base"] = set.first_frame;
    json["data"] = data_.add(byte_planes(numbers));
  }

  void add_contacts(const Frame& frame, Description& json) {
    double mean = 0, strongest = 0;
    const auto strong = chain_contacts(frame, limits_.contacts, mean);
    for (const auto i : strong) strongest = std::max(strongest, frame.normal_force[i]);
    json["strongest"] = strongest, json["mean_force"] = mean;
    const auto [contacts, chains] = put_contacts(frame, strong, strongest);
    json["contacts"] = contacts, json["chains"] = chains;
    std::vector<std::uint32_t> linear;
    for (std::uint32_t i = 0; i < frame.chain.size() && linear.size() < limits_.contacts; ++i)
      if (frame.chain[i] > 0) linear.push_back(i);
    if (linear.empty()) return;
    const auto [links, lines] = put_contacts(frame, linear, strongest);
    json["linear_contacts"] = links, json["linear_chains"] = lines;
  }
  /// Number of the contacts with these indices whose body is in the frame, and their data element.
  std::pair<std::size_t, std::size_t> put_contacts(const Frame& frame, const std::vector<std::uint32_t>& places,
                                                   double strongest) {
    Numbers low, high, branch[3], force;
    for (const auto i : places) {
      const auto found = std::ranges::lower_bound(frame.id, frame.body_a[i]);
      if (found == frame.id.end() || *found != frame.body_a[i]) continue;
      const auto place = static_cast<std::uint32_t>(found - frame.id.begin());
      low.push_back(static_cast<std::uint16_t>(place & 0xffff)),
          high.push_back(static_cast<std::uint16_t>(place >> 16));
      for (std::size_t axis = 0; axis < 3; ++axis)
        branch[axis].push_back(quantised(frame.branch[3 * i + axis], -extent_.reach, extent_.reach));
      force.push_back(quantised(frame.normal_force[i], 0, strongest));
    }
    Numbers all;
    for (const Numbers* part : {&low, &high, &branch[0], &branch[1], &branch[2], &force})
      all.insert(all.end(), part->begin(), part->end());
    return {low.size(), data_.add(byte_planes(all))};
  }

  void add_walls(const Frame& frame, Description& json) {
    json["walls"] = Description::array();
    Description fields = Description::array();
    for (const Frame::Wall& wall : frame.walls) {
      if (wall.corners.empty() || wall.corners.size() > 3 * limits_.wall_corners) continue;
      std::vector<float> corners(wall.corners.size());
      for (std::size_t i = 0; i < corners.size(); ++i)
        corners[i] = static_cast<float>(wall.corners[i] - wall.displacement[static_cast<Eigen::Index>(i % 3)]);
      // A stage may have changed it, or it has rotated.
      auto known = std::ranges::find_if(
          walls_, [&](const Wall& one) { return one.name == wall.name && alike(one.corners, corners); });
      if (known == walls_.end() && wall_bytes_ + corners.size() * sizeof(float) > limits_.wall_bytes) {
        const auto last = std::ranges::find(walls_.rbegin(), walls_.rend(), wall.name, &Wall::name);
        if (last != walls_.rend()) known = std::prev(last.base());
      }
      if (known == walls_.end()) {
        Box box;
        box.add({corners.begin(), corners.end()});
        known = walls_.insert(walls_.end(), {wall.name, data_.add_numbers<float>(corners), corners, box});
        wall_bytes_ += corners.size() * sizeof(float);
      }
      const Vec3& moved = wall.displacement;
      for (std::size_t k = 0; k < wall_fields_.size(); ++k) {
        const auto field = std::ranges::find(wall.fields, wall_fields_[k].name, &Field::name);
        if (wall_fields_[k].wall != wall.name || field == wall.fields.end()) continue;
        const std::vector<double> sizes = sizes_of(*field);
        fields.push_back(Description{json["walls"].size(), k,
                                     data_.add_numbers<float>(std::vector<float>(sizes.begin(), sizes.end()))});
      }
      json["walls"].push_back(Description{known - walls_.begin(), moved.x(), moved.y(), moved.z()});
    }
    if (!fields.empty()) json["wall_fields"] = std::move(fields);
  }

  const Extent& extent_;
  const GrainLimits& limits_;
  DataElements& data_;
  std::vector<Shown> values_, wall_fields_;  ///< those that fit into the page
  std::size_t left_out_ = 0;
  std::vector<Set> sets_;
  std::vector<Wall> walls_;
  std::size_t wall_bytes_ = 0;
  bool clumps_ = false;
  std::vector<std::string> groups_;
  Description frames_ = Description::array();
  std::vector<StageAndCount> instants_;
};

}  // namespace

Description grain_frames(std::span<const std::filesystem::path> files, const GrainLimits& limits, DataElements& data,
                         std::vector<std::string>& problems) {
  std::size_t left_out = 0;
  const auto taken = chosen(files, limits, problems, left_out);
  // Two passes: ranges first; the frames together may not fit into memory.
  Extent extent;
  std::vector<std::filesystem::path> whole;
  for (const auto& file : taken) try {
      Frame frame = read_frame(file);
      drop_unplaced(frame);
      extent.add(frame);
      whole.push_back(file);
    } catch (const FileError& error) {
      problems.emplace_back(error.what());
    }
  if (whole.empty()) return nullptr;
  if (extent.low[0] > extent.high[0]) extent.low.fill(0), extent.high.fill(0);  // no body anywhere
  Writer writer(extent, limits, data);
  CellMaps maps(data, limits.map_bytes);
  for (const auto& file : whole) try {
      Frame frame = read_frame(file);
      const std::size_t unplaced = drop_unplaced(frame);
      maps.add(writer.frames(), frame.stage, read_maps(file));
      writer.add(frame, unplaced);
    } catch (const FileError& error) {  // removed or rewritten since
      problems.emplace_back(error.what());
    }
  if (writer.frames() == 0) return nullptr;
  Description json = writer.result();
  json["maps"] = maps.result();
  json["left_out"] = left_out;
  return json;
}

}  // namespace grit
