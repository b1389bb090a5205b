#include "void-ratio.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "free_volume.hpp"
#include "grit/plugin.hpp"

namespace grit {
namespace {

constexpr double surface_error = 1e-3;  // of a mean diameter

/// What a part of the region, or a cell, holds [m³].
struct Volumes {
  double free = 0;  ///< on the bodies' side of walls
  double solid = 0;

  Volumes& operator+=(const Volumes& other) {
    free += other.free, solid += other.solid;
    return *this;
  }
  /// Infinite without solids.
  double void_ratio() const { return solid > 0 ? free / solid - 1 : std::numeric_limits<double>::infinity(); }
};

/// Of each cell; none without bodies.
std::vector<Volumes> volumes(const World& world, const AveragingCells& cells) {
  const double diameter = world.mean_diameter();
  if (!(diameter > 0) || cells.cells() == 0) return {};
  std::vector<Volumes> parts(cells.parts());
  const auto free = free_volumes(world, cells, surface_error * diameter);
  for (std::size_t part = 0; part < parts.size(); ++part) parts[part].free = free[part];
  const auto positions = world.positions();
  const auto shares = world.volume_shares();
  for (std::size_t i = 0; i < positions.size(); ++i)
    cells.share_out_sphere(xyz(positions[i]), positions[i].w, [&](std::size_t part, double volume) {
      parts[part].solid += shares.empty() ? volume : shares[i] * volume;
    });
  return cells.sum_up(parts);
}

/// Whether enough of a cell is before the walls for its void ratio to say something.
bool tells(const Volumes& cell, const Region& box) { return cell.solid > 0 && cell.free >= 0.5 * box.volume(); }

struct Spread {
  double smallest, largest, mean, scatter;
};
Spread spread(const std::vector<double>& ratios) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (ratios.empty()) return {unknown, unknown, unknown, unknown};
  const auto [least, most] = std::ranges::minmax(ratios);
  double sum = 0, squares = 0;
  for (const double ratio : ratios) sum += ratio;
  const double mean = sum / static_cast<double>(ratios.size());
  for (const double ratio : ratios) squares += (ratio - mean) * (ratio - mean);
  return {least, most, mean, std::sqrt(squares / static_cast<double>(ratios.size()))};
}

}  // namespace

void VoidRatio::declare(Parameters& p) { averaging.declare(p, "the specimen's, the grooves of its walls included"); }

std::vector<Channel> VoidRatio::channels() const {
  const std::string which = "of the cells that have solids and half of their volume before the walls; NaN without any";
  return {{"void_ratio", "1", "of the region, up to the surface of walls; infinite without solids", {}},
          {"smallest", "1", which, {}},
          {"largest", "1", which, {}},
          {"mean", "1", which, {}},
          {"scatter", "1", "standard deviation " + which, {}},
          averaging.place_channel(),
          {"void_ratio_profile",
           "1",
           "of each slice; infinite without solids",
           {static_cast<std::size_t>(averaging.slices)}}};
}

void VoidRatio::sample(const World& world, std::span<const std::span<double>> values) {
  const Region box = closed_box(averaging.region(world.envelope()), world);
  const AveragingCells cells = averaging.cells(world, box);
  std::vector<double> ratios;
  const auto of_cells = volumes(world, cells);
  for (std::size_t n = 0; n < of_cells.size(); ++n)
    if (tells(of_cells[n], cells.cell(n))) ratios.push_back(of_cells[n].void_ratio());
  const Spread of = spread(ratios);
  values[1][0] = of.smallest, values[2][0] = of.largest, values[3][0] = of.mean, values[4][0] = of.scatter;

  averaging.fill_places(box, values[5]);
  std::ranges::fill(values[6], std::numeric_limits<double>::infinity());
  Volumes whole;
  const auto of_slices = volumes(world, averaging.profile(world, box));
  for (std::size_t s = 0; s < of_slices.size(); ++s) values[6][s] = of_slices[s].void_ratio(), whole += of_slices[s];
  values[0][0] = whole.void_ratio();
}

std::vector<Field> VoidRatio::fields(const World& world) {
  const AveragingCells cells = averaging.cells(world, closed_box(averaging.region(world.envelope()), world));
  std::vector<Field> fields = map_of(cells);
  Field ratio{"void_ratio", "1", "up to the surface of walls; infinite without solids", 1, {}};
  Field share{"free_share", "1", "of the cell's volume, what lies on the bodies' side of all walls", 1, {}};
  const auto each = volumes(world, cells);
  for (std::size_t n = 0; n < each.size(); ++n) {
    ratio.values.push_back(each[n].void_ratio());
    share.values.push_back(each[n].free / cells.cell(n).volume());
  }
  fields.push_back(std::move(ratio)), fields.push_back(std::move(share));
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "void-ratio",
                                     .version = "1.0.0",
                                     .doc = "void ratio of averaging cells up to the surface of walls, and its profile",
                                     .make_probe = []() -> grit::Probe* { return new grit::VoidRatio; }};
  return &info;
}
