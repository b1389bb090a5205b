#include "void-ratio.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "free_volume.hpp"
#include "grit/plugin.hpp"
#include "grit/toolkit/cell_contents.hpp"

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
};

constexpr double negligible = 1e-6;  // of a box's volume: more than what rounding makes of nothing

/// Of a box; infinite without solids. NaN behind walls, and where more solids lie than there is room before them.
double void_ratio(const Volumes& in, const Region& box) {
  const double nothing = negligible * box.volume();
  if (!(in.free > nothing && in.free >= in.solid - nothing)) return std::numeric_limits<double>::quiet_NaN();
  return in.solid > 0 ? in.free / in.solid - 1 : std::numeric_limits<double>::infinity();
}

/// Of each cell; none without bodies.
std::vector<Volumes> volumes(const World& world, const AveragingCells& cells) {
  const double diameter = world.mean_diameter();
  if (!(diameter > 0) || cells.cells() == 0) return {};
  std::vector<Volumes> parts(cells.parts());
  const auto free = free_volumes(world, cells, surface_error * diameter);
  for (std::size_t part = 0; part < parts.size(); ++part) parts[part].free = free[part];
  share_out_solids(world, cells, [&](std::size_t part, double volume, std::size_t) { parts[part].solid += volume; });
  return cells.sum_up(parts);
}

/// The same of a cell. NaN where too little of it is before the walls for it to say something.
double void_ratio_of_cell(const Volumes& in, const Region& cell) {
  return in.free >= 0.5 * cell.volume() ? void_ratio(in, cell) : std::numeric_limits<double>::quiet_NaN();
}

struct Spread {
  double smallest, largest, mean, standard_deviation;
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

void VoidRatio::declare(Parameters& p) {
  averaging.declare(p, "of the specimen, out to the far side of its walls, including blocks and grooves");
}

std::vector<Channel> VoidRatio::channels() const {
  const std::string which =
      "of the cells that have solids and at least half of their volume in front of the walls; NaN without any";
  const std::string without = "infinite without solids, NaN behind walls";
  const Channel place = averaging.position_channel();
  return {{"void_ratio", "1", "void ratio of the region, up to the surface of walls; " + without, {}},
          {"smallest", "1", which, {}},
          {"largest", "1", which, {}},
          {"mean", "1", which, {}},
          {"standard_deviation", "1", which, {}},
          place,
          {"void_ratio_profile", "1", "void ratio of each slice; " + without, place.shape, place.name}};
}

void VoidRatio::sample(const World& world, ChannelValues& values) {
  const Region box = closed_box(averaging.region(world.envelope()), world);
  const AveragingCells cells = averaging.cells(world, box);
  std::vector<double> ratios;
  const auto of_cells = volumes(world, cells);
  for (std::size_t n = 0; n < of_cells.size(); ++n)
    if (const double ratio = void_ratio_of_cell(of_cells[n], cells.cell(n)); std::isfinite(ratio))
      ratios.push_back(ratio);
  const Spread of = spread(ratios);
  values["smallest"] = of.smallest;
  values["largest"] = of.largest;
  values["mean"] = of.mean;
  values["standard_deviation"] = of.standard_deviation;

  averaging.fill_places(box, values);
  const auto profile = values.list("void_ratio_profile");
  std::ranges::fill(profile, std::numeric_limits<double>::infinity());
  Volumes whole;
  const AveragingCells slices = averaging.profile(world, box);
  const auto of_slices = volumes(world, slices);
  for (std::size_t s = 0; s < of_slices.size(); ++s)
    profile[s] = void_ratio(of_slices[s], slices.cell(s)), whole += of_slices[s];
  values["void_ratio"] = of_slices.empty() ? std::numeric_limits<double>::infinity() : void_ratio(whole, box);
}

void VoidRatio::check_fields(const World& world) const {
  averaging.check_cells(world, closed_box(averaging.region(world.envelope()), world));
}

std::vector<Field> VoidRatio::fields(const World& world) {
  const AveragingCells cells = averaging.cells(world, closed_box(averaging.region(world.envelope()), world));
  std::vector<Field> fields = map_of(cells);
  Field ratio{
      "void_ratio",
      "1",
      "up to the surface of walls; infinite without solids, NaN if less than half of the cell is in front of them",
      1,
      {}};
  Field share{"free_volume_fraction", "1", "fraction of the volume of the cell in front of all walls", 1, {}};
  Field solids{"solid_fraction", "1", "volume of solids over that in front of walls, 1 / (1 + void ratio)", 1, {}};
  const auto each = volumes(world, cells);
  for (std::size_t n = 0; n < each.size(); ++n) {
    ratio.values.push_back(void_ratio_of_cell(each[n], cells.cell(n)));
    solids.values.push_back(1 / (1 + ratio.values.back()));
    share.values.push_back(each[n].free / cells.cell(n).volume());
  }
  for (Field* field : {&ratio, &share, &solids}) fields.push_back(std::move(*field));
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
