#include "report/pictures.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <numeric>
#include <ranges>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "output/grain_view.hpp"
#include "output/map_picture.hpp"
#include "output/picture.hpp"
#include "output/read_frames.hpp"
#include "output/scale.hpp"
#include "output/shown_fields.hpp"
#include "output/strays.hpp"
#include "report/layers.hpp"

namespace grit {
namespace {

std::string text_or(const Description& found, const std::string& other) {
  return found.is_string() ? found.get<std::string>() : other;
}

std::vector<Vec3> vectors(const std::vector<double>& numbers) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) all.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return all;
}

std::optional<Frame> last_frame(RunResults& run) {
  while (!run.frames.empty()) try {
      return read_frame(run.frames.back());
    } catch (const FileError& error) {
      run.problems.emplace_back(error.what());
      run.frames.pop_back();
    }
  return std::nullopt;
}

/// The ends of a colour scale that the description sets, by the first of these names that it has.
ScaleEnds ends_of(const RunResults& run, std::initializer_list<std::string> names) {
  for (const std::string& name : names)
    for (const Description& scale : run.at("/description/output/color_scales")) {
      if (!scale.is_object() || !scale.contains("of") || scale["of"] != name) continue;
      const auto end = [&](const char* key) {
        const auto found = scale.find(key);
        return found != scale.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
      };
      return {end("low"), end("high")};
    }
  return {};
}

std::string view_wanted(const RunResults& run) {
  const std::string view = text_or(run.at("/description/output/picture/view"), "xz");
  return view == "xy" || view == "yz" ? view : "xz";
}

std::vector<std::vector<Vec3>> walls_of(const Frame& frame) {
  std::vector<std::vector<Vec3>> walls;
  for (const auto& wall : frame.walls) walls.push_back(vectors(wall.corners));
  return walls;
}

/// The grains of a frame in the view of the description's picture.
Picture view_of(const RunResults& run, const Frame& frame, const std::string& color, std::span<const int> layers) {
  std::vector<Row> positions, velocities;
  for (std::size_t i = 0; i < frame.bodies(); ++i) {
    const double *x = &frame.position[3 * i], *v = &frame.velocity[3 * i];
    positions.push_back({x[0], x[1], x[2], frame.radius[i]});
    velocities.push_back({v[0], v[1], v[2], 0});
  }
  const auto rotations = vectors(frame.rotation), displacements = vectors(frame.displacement);
  SeenBodies seen{positions, velocities, rotations, displacements};
  seen.layers = layers;
  seen.groups = frame.group, seen.group_names = frame.group_names;
  const auto values = std::ranges::find(frame.values, color, &BodyValues::name);
  if (values != frame.values.end()) seen.values = &*values;
  GrainView view = grain_view(seen, walls_of(frame), view_wanted(run), color);
  view.ends = ends_of(run, {color});
  return {run.title(),
          fmt::format("{} grains  ·  stage {}  ·  {}", grouped(frame.bodies()), frame.stage, written_time(frame.time)),
          {},
          std::move(view)};
}

}  // namespace

std::vector<NamedPicture> map_pictures(RunResults& run) {
  std::vector<NamedPicture> pictures;
  const auto frame = last_frame(run);
  if (!frame) return pictures;
  const std::string view = view_wanted(run);
  const int right = view[0] - 'x', up = view[1] - 'x';
  const auto depth = static_cast<std::size_t>(3 - right - up);
  for (const FieldGroup& map : read_maps(run.frames.back())) {
    const auto &centre = map.fields[0].values, &size = map.fields[1].values;
    const auto at = [](const std::vector<double>& rows, std::size_t cell, auto axis) {
      return rows[3 * cell + static_cast<std::size_t>(axis)];
    };
    std::vector<std::size_t> cells(centre.size() / 3);
    std::iota(cells.begin(), cells.end(), std::size_t{0});
    if (cells.empty()) continue;
    // Through centres of cells, so that the section is never between two.
    const auto depth_of = [&](std::size_t cell) { return at(centre, cell, depth); };
    std::vector<double> depths(cells.size());
    std::ranges::transform(cells, depths.begin(), depth_of);
    const double plane = median(std::move(depths));
    std::erase_if(cells,
                  [&](std::size_t cell) { return std::abs(depth_of(cell) - plane) > 0.49999 * at(size, cell, depth); });
    const std::vector<Segment> walls = cut_walls(walls_of(*frame), view, plane);
    for (const Field& field : map.fields | std::views::drop(2)) {
      if (is_bookkeeping(field)) continue;
      MapPicture picture{
          run.title(),
          fmt::format("{}  ·  stage {}  ·  {}",
                      field.name == map.name ? spelled(field.name) : spelled(field.name) + " of " + map.name,
                      frame->stage, written_time(frame->time)),
          view.substr(0, 1),
          view.substr(1, 1),
          {},
          walls,
          {},
          field.unit};
      const std::vector<std::string> components = components_of(field);
      for (std::size_t k = 0; k < field.width; ++k) {
        const std::string full = map.name + '/' + field.name, component = components.empty() ? "" : components[k];
        ScaleEnds ends = ends_of(run, {full + '/' + component, full});
        ends.most = largest_shown(field);
        picture.panels.push_back(
            {spelled(field.name) + (component.empty() ? "" : ' ' + component), is_signed(field, k), ends});
      }
      for (const std::size_t cell : cells) {
        const auto row = field.values.begin() + static_cast<std::ptrdiff_t>(field.width * cell);
        picture.cells.push_back({at(centre, cell, right),
                                 at(centre, cell, up),
                                 at(size, cell, right),
                                 at(size, cell, up),
                                 {row, row + static_cast<std::ptrdiff_t>(field.width)}});
      }
      pictures.push_back({"map-" + map.name + '-' + field.name, draw(picture)});
    }
  }
  return pictures;
}

std::optional<std::string> grains_picture(RunResults& run) {
  const auto frame = last_frame(run);
  if (!frame) return std::nullopt;
  const std::string wanted = text_or(run.at("/description/output/picture/color"), "rotation");
  const bool kept = (wanted != "rotation" || !frame->rotation.empty()) &&
                    (wanted != "displacement" || !frame->displacement.empty()) &&
                    (wanted != "group" || !frame->group.empty()) &&
                    (!names_a_field(wanted) || std::ranges::count(frame->values, wanted, &BodyValues::name) > 0);
  return draw(view_of(run, *frame, kept ? wanted : "speed", {}));
}

namespace {

/// Faint grains below links, of a width proportional to the normal force; and the largest force [N].
std::pair<Picture, double> picture_of_links(const RunResults& run, const Frame& frame,
                                            const std::vector<std::size_t>& contacts) {
  std::pair<Picture, double> made{view_of(run, frame, "speed", {}), 0};
  auto& [picture, strongest] = made;
  GrainView& view = *picture.grains;
  for (Disc& disc : view.discs) disc.value = std::numeric_limits<double>::quiet_NaN();
  const std::string axes = view_wanted(run);
  const auto right = static_cast<std::size_t>(axes[0] - 'x'), up = static_cast<std::size_t>(axes[1] - 'x');
  std::vector<Link> links;
  for (const std::size_t k : contacts) {
    const auto body = std::ranges::lower_bound(frame.id, frame.body_a[k]);
    if (body == frame.id.end() || *body != frame.body_a[k]) continue;
    const double* start = &frame.position[3 * static_cast<std::size_t>(body - frame.id.begin())];
    const double* branch = &frame.branch[3 * k];
    links.push_back(
        {start[right], start[up], start[right] + branch[right], start[up] + branch[up], frame.normal_force[k]});
    if (drawable(frame.normal_force[k])) strongest = std::max(strongest, frame.normal_force[k]);
  }
  for (Link& link : links) link.weight /= strongest > 0 ? strongest : 1;
  view.links = std::move(links);
  return made;
}

}  // namespace

std::optional<std::string> force_chains_picture(RunResults& run) {
  const auto frame = last_frame(run);
  if (!frame) return std::nullopt;
  double sum = 0, count = 0;
  for (const double force : frame->normal_force)
    if (drawable(force)) sum += std::abs(force), ++count;
  std::vector<std::size_t> above;
  for (std::size_t k = 0; k < frame->normal_force.size(); ++k)
    if (std::abs(frame->normal_force[k]) * count > sum) above.push_back(k);
  if (above.empty()) return std::nullopt;
  auto [picture, strongest] = picture_of_links(run, *frame, above);
  picture.facts +=
      fmt::format("  ·  contacts above the mean of {:.3g} N, width proportional to normal force, at most {:.3g} N",
                  sum / count, strongest);
  return draw(picture);
}

std::optional<std::string> chains_picture(RunResults& run) {
  const auto frame = last_frame(run);
  if (!frame) return std::nullopt;
  std::vector<std::size_t> linked;
  std::uint32_t last = 0;
  for (std::size_t k = 0; k < frame->chain.size(); ++k)
    if (frame->chain[k] > 0) linked.push_back(k), last = std::max(last, frame->chain[k]);
  if (linked.empty()) return std::nullopt;
  auto [picture, strongest] = picture_of_links(run, *frame, linked);
  picture.facts += fmt::format("  ·  {} linear chains, width proportional to normal force, at most {:.3g} N",
                               grouped(last), strongest);
  return draw(picture);
}

std::optional<std::string> layers_picture(RunResults& run) {
  const auto frame = last_frame(run);
  if (!frame) return std::nullopt;
  std::vector<StageAndCount> instants;
  std::erase_if(run.frames, [&](const std::filesystem::path& file) {
    try {
      instants.push_back({stage_of_frame(file), bodies_in_frame(file)});
      return false;
    } catch (const FileError& error) {
      run.problems.emplace_back(error.what());
      return true;
    }
  });
  if (instants.empty()) return std::nullopt;
  const auto [first, stage] = where_layers_begin(instants);
  if (first + 1 == run.frames.size()) return std::nullopt;
  const Frame start = read_frame(run.frames[first]);
  const auto up = static_cast<std::size_t>(view_wanted(run)[1] - 'x');
  const auto height = [&](std::size_t i) { return start.position[3 * i + up]; };
  std::map<std::int64_t, int> layer_of;
  // Without grains far from all others, as on the page.
  const Fences fences(start, far_to_see);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < start.bodies(); ++i)
    if (fences.hold(start.position, i)) low = std::min(low, height(i)), high = std::max(high, height(i));
  for (std::size_t i = 0; i < start.bodies(); ++i)
    if (std::isfinite(height(i))) {
      const double fraction = high > low ? std::clamp((height(i) - low) / (high - low), 0.0, 1.0) : 0;
      layer_of[start.id[i]] = 1 + std::min(layer_count - 1, static_cast<int>(layer_count * fraction));
    }
  std::vector<int> layers;
  for (const std::int64_t id : frame->id) {
    const auto found = layer_of.find(id);
    layers.push_back(found == layer_of.end() ? 0 : found->second);
  }
  Picture picture = view_of(run, *frame, "layer", layers);
  picture.facts += fmt::format("  ·  layers by {} at the start of {}", "xyz"[up], stage);
  return draw(picture);
}

}  // namespace grit
