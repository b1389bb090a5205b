#include "kernel/inflow.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "bodies/orientation.hpp"
#include "bodies/sizes.hpp"
#include "description/placed_error.hpp"
#include "format/number.hpp"

namespace grit {
namespace {

/// Bodies enter in batches if more than one would enter within so many steps, as each batch needs a neighbour search.
constexpr double steps_of_batch = 50;
constexpr std::size_t most_at_once = 1000;
/// Random positions tried for one body before it waits.
constexpr int tries = 200;

/// The difference of two positions, to the nearest image.
Vec3 nearest_image(Vec3 apart, const Cell& cell) {
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[static_cast<std::size_t>(k)]) {
      const double period = cell.high[k] - cell.low[k];
      apart[k] -= period * std::nearbyint(apart[k] / period);
    }
  return apart;
}

/// What may be in the way of a sphere of this radius in a region.
class Obstacles {
 public:
  Obstacles(const State& state, const World& world, const std::string& group, const Bodies& entering,
            const Region& region, double radius)
      : cell_(state.cell.cell()), world_(world), radius_(radius) {
    const auto& names = state.settings.groups;
    const auto own = static_cast<std::size_t>(std::ranges::find(names, group) - names.begin());
    for (std::size_t wall = 0; wall < state.surfaces.size(); ++wall)
      if (const auto& groups = state.surfaces[wall].groups; groups.empty() || groups[own]) walls_.push_back(wall);
    const Vec3 middle = 0.5 * (region.low + region.high), half = 0.5 * (region.high - region.low);
    const auto add = [&](const Row& body) {
      const Vec3 apart = nearest_image(xyz(body) - middle, cell_).cwiseAbs() - half;
      if (apart.maxCoeff() < body.w + radius) near_.push_back(body);
    };
    for (std::size_t i = 0; i < state.bodies.count(); ++i) add(state.bodies.position[i]);
    for (std::size_t i = 0; i < entering.count(); ++i) add(entering.position[i]);
  }

  bool leave_room_at(const Vec3& centre) const {
    for (const Row& body : near_) {
      const double reach = body.w + radius_;
      if (nearest_image(xyz(body) - centre, cell_).squaredNorm() < reach * reach) return false;
    }
    for (const std::size_t wall : walls_)
      if (world_.clearance(wall, centre, radius_)) return false;
    return true;
  }

 private:
  const Cell& cell_;
  const World& world_;
  std::vector<std::size_t> walls_;
  double radius_;
  std::vector<Row> near_;
};

}  // namespace

Inflow::Inflow(const SceneDescription& scene, const Components& components) {
  std::uint64_t seeds = static_cast<std::uint64_t>(scene.seed) ^ 0x73747265616d;
  for (const auto& [name, group] : scene.bodies) {
    const std::uint64_t seed = split_mix(seeds);
    const auto* source = std::get_if<StreamSource>(&group.source.value());
    if (source == nullptr) continue;
    const Region box = bounds_of(*source);
    for (int k = 0; k < 3; ++k)
      if ((scene.domain.low && box.low[k] < (*scene.domain.low)[k]) ||
          (scene.domain.high && box.high[k] > (*scene.domain.high)[k]))
        throw PlacedError({"bodies", name, "source", "region"}, "the region of the stream leaves the domain along " +
                                                                    std::string(1, "xyz"[k]) +
                                                                    "; move it inside, or enlarge /domain");
    GroupBuilder builder(scene, group, components.body_kinds.at(name));
    if (const double largest = largest_diameter(source->sizes, builder.shape_diameter()), width = width_of(*source);
        largest > width * (1 + 1e-9))
      throw PlacedError({"bodies", name, "source", "region"},
                        "found a region of a stream " + number(width) + " m wide, for bodies of up to " +
                            number(largest) +
                            " m in diameter; allowed is one as wide as the largest body; are the units of both right?");
    entries_.emplace(name, Entry{group.stage, group.velocity, builder, Stream(*source, builder, seed)});
  }
}

void Inflow::begin_stage(const std::string& stage, double time) {
  for (auto& [name, entry] : entries_)
    if (!entry.stream.begun() && (entry.stage.empty() || entry.stage == stage)) entry.stream.begin(time);
}

bool Inflow::due(double time) {
  return std::ranges::any_of(entries_, [&](auto& one) { return one.second.stream.is_due(time); });
}

Bodies Inflow::enter(const State& state, const World& world) {
  const double now = state.time.time;
  Bodies entering;
  for (auto& [name, entry] : entries_) {
    if (!entry.stream.is_due(now)) continue;
    std::size_t left = entry.stream.due(now, most_at_once);
    while (left > 0 && enter_one(name, entry, state, world, entering)) --left;
    entry.stream.let_in(now, left, steps_of_batch * state.time.dt);
  }
  entering.finish(state.bodies.state);
  return entering;
}

bool Inflow::enter_one(const std::string& name, Entry& entry, const State& state, const World& world,
                       Bodies& entering) {
  Stream& stream = entry.stream;
  const double radius = 0.5 * stream.next_diameter();
  const Obstacles obstacles(state, world, name, entering, stream.bounds(), radius);
  Vec3 centre = stream.position(radius);
  for (int tried = 1; !obstacles.leave_room_at(centre); ++tried) {
    if (tried == tries) return false;
    centre = stream.position(radius);
  }
  if (entering.groups.empty() || entering.groups.back().name != name)
    entering.groups.push_back({name, entering.ids_given});
  const Eigen::Quaterniond turn =
      entry.builder.clump() != nullptr ? any_orientation(stream.random()) : Eigen::Quaterniond::Identity();
  entry.builder.add(entering, centre, radius, turn, entry.velocity, Vec3::Zero());
  stream.enter();
  return true;
}

std::string Inflow::waiting() const {
  std::string text;
  for (const auto& [name, entry] : entries_)
    if (const std::size_t bodies = entry.stream.waiting(); bodies > 0)
      text +=
          (text.empty() ? "" : "; ") + std::to_string(bodies) + " bodies of the stream \"" + name + "\" wait for room";
  return text;
}

std::vector<std::string> Inflow::blocked() const {
  constexpr double many = 0.01;  // of the bodies that should have entered; a few wait wherever others fall past
  std::vector<std::string> all;
  for (const auto& [name, entry] : entries_) {
    const Stream& stream = entry.stream;
    const auto waiting = static_cast<double>(stream.waiting());
    if (stream.waiting() < most_at_once && waiting <= many * (waiting + static_cast<double>(stream.entered())))
      continue;
    all.push_back("bodies of the stream \"" + name + "\" find no room, the next with a diameter of " +
                  number(stream.waiting_diameter()) + " m in a region " + number(stream.width()) +
                  " m wide: enlarge the region (/bodies/" + name +
                  "/source/region), move it away from walls and bodies, or let fewer enter per time");
  }
  return all;
}

void Inflow::serialize(Archive& archive) {
  for (auto& [name, entry] : entries_) archive(entry.stream);
}

}  // namespace grit
