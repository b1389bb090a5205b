#include "simulation/sample_of_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "format/number.hpp"
#include "grit/error.hpp"
#include "input/scene.hpp"
#include "simulation/sample_checks.hpp"
#include "simulation/sample_groups.hpp"
#include "storage/frame_state.hpp"

namespace grit {
namespace {

struct ChosenFrame {
  std::size_t number;
  std::filesystem::path path;
  double time;  // s
};

/// Numbers of the frames in a folder, ascending. Some may have been removed.
std::vector<std::size_t> numbers_of_frames(const std::filesystem::path& folder) {
  std::vector<std::size_t> numbers;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (const auto number = frame_number(entry.path().filename().string()); number && entry.is_regular_file(none))
      numbers.push_back(*number);
  std::ranges::sort(numbers);
  return numbers;
}

/// Ascending numbers as "0 to 9, 20, 22 to 33".
std::string ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t first = 0, last = 0; first < numbers.size(); first = last + 1) {
    for (last = first; last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1;) ++last;
    text += (text.empty() ? "" : ", ") + std::to_string(numbers[first]);
    if (last > first) text += " to " + std::to_string(numbers[last]);
  }
  return text;
}

ChosenFrame chosen_frame(const BeginDescription& begin) {
  const auto path = [&](std::size_t number) {
    return std::filesystem::path(begin.from) / "frames" / frame_name(number);
  };
  const auto chosen = [&](std::size_t number) -> ChosenFrame {
    return {number, path(number), time_of_frame(path(number))};
  };
  const std::vector<std::size_t> numbers = numbers_of_frames(std::filesystem::path(begin.from) / "frames");
  if (numbers.empty())
    throw PlacedError({"begin", "from"},
                      begin.from + ": holds no frames; name the folder of results of a run with /output/frames");
  if (!begin.time && begin.frame < 0) return chosen(numbers.back());
  if (!begin.time) {
    const auto wanted = static_cast<std::size_t>(begin.frame);
    if (!std::ranges::binary_search(numbers, wanted))
      throw PlacedError({"begin", "frame"}, name_of_sample(begin) + " has no frame " + std::to_string(begin.frame) +
                                                "; its frames are " + ranges(numbers));
    return chosen(wanted);
  }
  ChosenFrame nearest = chosen(numbers.front());
  for (const std::size_t number : numbers)
    if (const ChosenFrame one = chosen(number); std::abs(one.time - *begin.time) < std::abs(nearest.time - *begin.time))
      nearest = one;
  return nearest;
}

/// The description of the run that wrote the frames.
Scene scene_of(const BeginDescription& begin, const Registry& registry) {
  const auto path = std::filesystem::path(begin.from) / "description.json";
  if (!std::filesystem::exists(path))
    throw PlacedError({"begin", "from"},
                      begin.from + ": holds no description.json; name the folder of results of a run");
  return read_scene(load_document(path, {}, registry), registry);
}

std::size_t stage_of(const FrameState& frame, const Scene& before) {
  const auto& stages = before.description->stages;
  const auto at = std::ranges::find(stages, frame.stage, &StageDescription::name);
  return at == stages.end() ? 0 : static_cast<std::size_t>(at - stages.begin());
}

/// Distance of a sphere from its clump; one of the two may have been moved by periods.
double distance(const Vec3& sphere, const Vec3& centre, const Cell& cell) {
  Vec3 branch = sphere - centre;
  for (int axis = 2; axis >= 0; --axis)
    if (const Vec3 period = cell.period(axis); period[axis] > 0)
      branch -= std::round(branch[axis] / period[axis]) * period;
  return branch.norm();
}

/// Makes the bodies of a frame by the groups of the scene.
class FrameBodies {
 public:
  FrameBodies(const LiveScene& live, const FrameState& frame, const Cell& cell, const std::string& sample)
      : frame_(frame), cell_(cell), groups_(live, sample) {
    for (const FrameClump& clump : frame_.clumps) clumps_[clump.id] = &clump;
  }

  Bodies make(StateRequest state) {
    bodies_.reserve(frame_.bodies.size());
    for (std::size_t i = 0; i < frame_.bodies.size();) i += add(i);
    // Groups of which no body is left.
    for (const std::string& name : frame_.groups)
      if (std::ranges::find(bodies_.groups, name, &BodyGroup::name) == bodies_.groups.end())
        bodies_.groups.push_back({name, bodies_.ids_given});
    if (!groups_.faults().empty()) throw PlacedError(groups_.faults());
    bodies_.finish(state);
    return std::move(bodies_);
  }

 private:
  /// Adds a sphere or a clump. Returns its number of spheres; those of a clump have consecutive ids.
  std::size_t add(std::size_t first) {
    const FrameBody& body = frame_.bodies[first];
    const std::string& name = frame_.groups.at(body.group);
    if (bodies_.groups.empty() || bodies_.groups.back().name != name) bodies_.groups.push_back({name, body.id});
    bodies_.ids_given = body.id;
    if (body.clump < 0) {
      if (groups_.takes_sphere(name))
        groups_.builder_of(name).add(bodies_, body.position, body.radius, Eigen::Quaterniond::Identity(), body.velocity,
                                     body.spin);
      return 1;
    }
    const FrameClump& clump = *clumps_.at(body.clump);
    std::vector<SampleSphere> spheres;
    for (std::size_t k = first; k < frame_.bodies.size() && frame_.bodies[k].clump == body.clump; ++k)
      spheres.push_back({distance(frame_.bodies[k].position, clump.centre, cell_), frame_.bodies[k].radius});
    if (groups_.takes_clump(name, clump.radius, spheres)) {
      bodies_.clump_ids_given = static_cast<std::uint32_t>(clump.id);
      groups_.builder_of(name).add_clump(bodies_, clump.centre, clump.radius, clump.orientation, clump.velocity,
                                         clump.spin);
    }
    return spheres.size();
  }

  const FrameState& frame_;
  const Cell& cell_;
  SampleGroups groups_;
  std::map<std::int64_t, const FrameClump*> clumps_;
  Bodies bodies_;
};

/// The walls of the run, where they were.
Walls walls_of(const FrameState& frame, const LiveScene& before) {
  Walls walls;
  walls.apply(before.now(), before.components());
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const auto at = std::ranges::find(frame.walls, walls.name(w), &FrameWall::name);
    if (at != frame.walls.end()) walls.put(w, at->pose, {at->velocity, at->spin});
  }
  return walls;
}

}  // namespace

Prepared sample_of_frame(const LiveScene& live, const Registry& registry, StateRequest state) {
  const SceneDescription& scene = live.now();
  const BeginDescription& begin = *scene.begin;
  const ChosenFrame chosen = chosen_frame(begin);
  const FrameState frame = read_frame_state(chosen.path);
  if (frame.groups.empty() && !frame.bodies.empty())
    throw FileError(chosen.path.string() + ": names no group of its bodies; the file is damaged or not of grit");
  const Scene before = scene_of(begin, registry);
  LiveScene live_before(before);
  live_before.go_to(stage_of(frame, before), 0);

  SampleFaults faults;
  const std::string sample = name_of_sample(begin);
  check_groups(scene, {frame.groups.begin(), frame.groups.end()}, sample, faults);
  check_domain(scene.domain, live_before.now().domain, sample, faults);
  if (!faults.empty()) throw PlacedError(std::move(faults));

  Cell cell{frame.cell_low, frame.cell_high, live_before.now().domain.periodic, frame.strain_rate};
  cell.shear_rate = frame.shear_rate, cell.tilt = frame.tilt;
  Prepared prepared(FrameBodies(live, frame, cell, sample).make(state),
                    {DeformingCell(cell), walls_of(frame, live_before), {}, {}});
  prepared.sample->walls.drop(walls_with_other_geometry(scene, live_before.now()));
  prepared.note = "begins from frame " + std::to_string(chosen.number) + " of " + begin.from + ", at " +
                  number(chosen.time) + " s; frames hold no contact springs, which start at zero";
  return prepared;
}

}  // namespace grit
