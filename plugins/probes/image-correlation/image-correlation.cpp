#include "image-correlation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "grit/error.hpp"
#include "grit/plugin.hpp"
#include "grit/toolkit/displacement_fit.hpp"
#include "grit/toolkit/specimen.hpp"

namespace grit {
namespace {

constexpr double most_pixels = 1 << 26;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void ImageCorrelation::declare(Parameters& p) {
  p.add("depth_axis", depth_axis).one_of({"x", "y", "z"}).doc("axis perpendicular to the picture; not periodic");
  p.add("pixels_per_diameter", pixels_per_diameter)
      .at_least(8)
      .at_most(200)
      .doc("number of pixels along a mean diameter");
  p.add("subset", subset).at_least(0.2).at_most(20).doc("side of a subset of pixels, over the mean diameter");
  p.add("step", step).at_least(0.02).doc("distance between neighbouring subsets, over the mean diameter");
  p.add("window", window)
      .above(0)
      .doc("side of the square window for a strain, over the mean diameter; at least two steps");
  p.add("search_range", search_range)
      .at_least(0.2)
      .at_most(40)
      .doc("search distance along each axis, over the mean diameter");
  p.add("min_correlation", min_correlation)
      .at_least(0.5)
      .below(1)
      .doc("minimum zero-mean normalised correlation of a subset that counts as found");
  p.add("seed", seed).at_least(0).doc("seed of the speckles on the grains");
  p.add("sliding", sliding)
      .doc("lengths over which the specimen slides on a wall and shears internally; default: not evaluated");
  p.check(
      [this](const Complain& complain) {
        if (window < 2 * step)
          complain("window", std::to_string(window),
                   "at least two steps, " + std::to_string(2 * step) + ", so that subsets on both sides count");
      },
      {"window", "step"});
  p.check(
      [this](const Complain& complain) {
        if (subset * pixels_per_diameter < 10)
          complain("subset", std::to_string(subset * pixels_per_diameter) + " pixels",
                   "at least 10 pixels: larger, or with more pixels_per_diameter");
      },
      {"subset", "pixels_per_diameter"});
}

ImageCorrelation::Axes ImageCorrelation::axes() const {
  switch (depth_axis[0]) {
    case 'x':
      return {1, 2, 0, -1};
    case 'y':
      return {0, 2, 1, 1};
    default:
      return {0, 1, 2, -1};
  }
}

double ImageCorrelation::pixels(const World& world) const {
  if (!(world.mean_diameter() > 0)) return 0;
  const Region box = specimen_box(world);
  const Axes look = axes();
  const double pixel = world.mean_diameter() / pixels_per_diameter,
               margin = 2 * (search_range + subset) * pixels_per_diameter;
  return ((box.high[look.right] - box.low[look.right]) / pixel + margin) *
         ((box.high[look.up] - box.low[look.up]) / pixel + margin);
}

void ImageCorrelation::prepare(const World& world) {
  if (world.cell().periodic[static_cast<std::size_t>(axes().depth)])
    throw ParameterError({{"depth_axis", depth_axis + ", along which the domain is periodic and has no face",
                           "an axis that is not periodic"}});
  if (const double count = pixels(world); count > most_pixels)
    throw ParameterError({{"pixels_per_diameter",
                           std::to_string(pixels_per_diameter) + ", with which a picture of the specimen has " +
                               std::to_string(count * 1e-6) + " million pixels",
                           "at most " + std::to_string(most_pixels * 1e-6) +
                               " million pixels; use fewer per diameter, or a smaller search_range"}});
  if (sliding) sliding->prepare(world, axes().right, axes().up, "sliding");
  camera_.emplace(static_cast<std::uint64_t>(seed), pixels_per_diameter);
  began_ = false;
}

std::optional<ImageCorrelation::View> ImageCorrelation::view(const World& world) const {
  if (const double count = pixels(world); !(count > 0 && count <= most_pixels)) return std::nullopt;
  const Region box = specimen_box(world);
  const Axes look = axes();
  View view;
  view.diameter = world.mean_diameter(), view.pixel = view.diameter / pixels_per_diameter;
  view.face = (look.away > 0 ? box.low : box.high)[look.depth];
  const std::ptrdiff_t half = this->half();
  const auto margin = static_cast<std::ptrdiff_t>(std::ceil(search_range * pixels_per_diameter)) + half + 4;
  view.subsets.apart = std::max(1l, std::lround(step * pixels_per_diameter));
  // The same along both axes.
  const auto lay_out = [&](int axis, std::ptrdiff_t& size, std::ptrdiff_t& count, std::ptrdiff_t& first) {
    const double length = (box.high[axis] - box.low[axis]) / view.pixel;
    size = static_cast<std::ptrdiff_t>(std::ceil(length)) + 2 * margin;
    const auto room = static_cast<std::ptrdiff_t>(length + 1e-6) - (2 * half + 1);
    count = room < 0 ? 0 : room / view.subsets.apart + 1;
    first = margin + half + (room - (count - 1) * view.subsets.apart) / 2;
    return box.low[axis] - (static_cast<double>(margin) - 0.5) * view.pixel;
  };
  view.corner.x() = lay_out(look.right, view.width, view.subsets.columns, view.subsets.left);
  view.corner.y() = lay_out(look.up, view.height, view.subsets.rows, view.subsets.bottom);
  return view;
}

Image ImageCorrelation::picture(const World& world, const View& view) const {
  const Axes look = axes();
  const Cell& cell = world.cell();
  std::vector<Disc> discs;
  const auto see = [&](double right, double up, std::size_t i) {
    const Vec3 centre = xyz(world.positions()[i]);
    const Disc disc{.x = (right - view.corner.x()) / view.pixel,
                    .y = (up - view.corner.y()) / view.pixel,
                    .depth = look.away * (centre[look.depth] - view.face) / view.pixel,
                    .radius = world.positions()[i].w / view.pixel,
                    .angle = -look.away * world.rotations()[i][look.depth],
                    .id = world.ids()[i]};
    if (disc.x + disc.radius > -1 && disc.x - disc.radius < static_cast<double>(view.width) &&
        disc.y + disc.radius > -1 && disc.y - disc.radius < static_cast<double>(view.height))
      discs.push_back(disc);
  };
  // Beyond a periodic side the specimen goes on, as often as the picture reaches over.
  struct Images {
    double first, last, period;
  };
  const auto images = [&](int axis, double place, double radius, double corner, std::ptrdiff_t pixels) -> Images {
    if (!cell.periodic[static_cast<std::size_t>(axis)]) return {0, 0, 0};
    const double period = cell.high[axis] - cell.low[axis], end = corner + static_cast<double>(pixels) * view.pixel;
    return {std::ceil((corner - view.pixel - radius - place) / period), std::floor((end + radius - place) / period),
            period};
  };
  for (std::size_t i = 0; i < std::min(world.positions().size(), world.rotations().size()); ++i) {
    const Vec3 centre = xyz(world.positions()[i]);
    if (!centre.allFinite() || !world.rotations()[i].allFinite()) continue;  // a run that has failed
    const double radius = world.positions()[i].w;
    const Images across = images(look.right, centre[look.right], radius, view.corner.x(), view.width),
                 upwards = images(look.up, centre[look.up], radius, view.corner.y(), view.height);
    if (std::max(std::abs(across.first), std::abs(upwards.first)) > 1e6) continue;  // thrown out of the domain
    for (double a = across.first; a <= across.last; ++a)
      for (double b = upwards.first; b <= upwards.last; ++b)
        see(centre[look.right] + a * across.period, centre[look.up] + b * upwards.period, i);
  }
  return camera_->picture(discs, view.width, view.height);
}

Image ImageCorrelation::picture(const World& world) {
  look(world);
  return view_ ? picture(world, *view_) : Image();
}

void ImageCorrelation::look(const World& world) {
  if (!began_ || stage_ != world.stage()) {
    began_ = true, stage_ = world.stage();
    if (sliding) walls_ = sliding->now(world);
    view_ = view(world);
    start_ = view_ ? ReferenceImage(picture(world, *view_)) : ReferenceImage();
    subsets_ = view_ ? subsets_of(unmoved()) : std::vector<Subset>();
  } else if (step_ != world.step()) {
    subsets_ = view_ ? subsets_of(found(picture(world, *view_))) : std::vector<Subset>();
  }
  step_ = world.step();
}

std::ptrdiff_t ImageCorrelation::half() const {
  return static_cast<std::ptrdiff_t>(std::lround(0.5 * subset * pixels_per_diameter));
}

MatchGrid ImageCorrelation::unmoved() const {
  const SquareGrid& grid = view_->subsets;
  MatchGrid all{grid.columns, grid.rows, {}};
  for (std::ptrdiff_t j = 0; j < grid.rows; ++j)
    for (std::ptrdiff_t i = 0; i < grid.columns; ++i)
      all.match.push_back(has_pattern(start_, grid.left + i * grid.apart, grid.bottom + j * grid.apart, half())
                              ? std::optional(Match{.correlation = 1})
                              : std::nullopt);
  return all;
}

MatchGrid ImageCorrelation::found(Image now) const {
  const SquareGrid& grid = view_->subsets;
  const auto apart = [&](double diameters) {
    return std::max(1l, std::lround(diameters * pixels_per_diameter / static_cast<double>(grid.apart)));
  };
  return matches(Correlation(start_, DeformedImage(std::move(now)), half()), grid, apart(3),
                 static_cast<std::ptrdiff_t>(std::ceil(search_range * pixels_per_diameter)), min_correlation);
}

std::vector<ImageCorrelation::Subset> ImageCorrelation::subsets_of(const MatchGrid& found) const {
  const SquareGrid& grid = view_->subsets;
  std::vector<Subset> all;
  for (std::ptrdiff_t j = 0; j < grid.rows; ++j)
    for (std::ptrdiff_t i = 0; i < grid.columns; ++i) {
      const auto& match = found.match[all.size()];
      const Vec2 middle(static_cast<double>(grid.left + i * grid.apart),
                        static_cast<double>(grid.bottom + j * grid.apart));
      all.push_back({.start = view_->corner + middle * view_->pixel,
                     .moved = match ? Vec2(match->moved * view_->pixel) : Vec2::Constant(unknown),
                     .green = {unknown, unknown, unknown},
                     .correlation = match ? match->correlation : unknown});
    }
  const auto reach =
      static_cast<std::ptrdiff_t>(0.5 * window * pixels_per_diameter / static_cast<double>(grid.apart) + 1e-9);
  const std::ptrdiff_t around = std::max<std::ptrdiff_t>(1, reach);
  DisplacementFit fit;
  for (std::ptrdiff_t j = 0; j < grid.rows; ++j)
    for (std::ptrdiff_t i = 0; i < grid.columns; ++i) {
      fit.clear();
      for (std::ptrdiff_t b = std::max<std::ptrdiff_t>(0, j - around); b <= std::min(grid.rows - 1, j + around); ++b)
        for (std::ptrdiff_t a = std::max<std::ptrdiff_t>(0, i - around); a <= std::min(grid.columns - 1, i + around);
             ++a)
          if (const Subset& one = all[static_cast<std::size_t>(b * grid.columns + a)]; one.moved.allFinite())
            fit.add(one.start, one.moved);
      all[static_cast<std::size_t>(j * grid.columns + i)].green = fit.green(6, 0.01);
    }
  return all;
}

std::vector<Channel> ImageCorrelation::channels() const {
  const std::string a{"xyz"[axes().right]}, b{"xyz"[axes().up]};
  std::vector<Channel> channels{
      {"strain",
       "1",
       "E_" + a + a + ", E_" + b + b + ", E_" + a + b +
           " of all subsets that were found, Green-Lagrange since the first sample of the stage, positive in "
           "extension; "
           "NaN with fewer than four",
       {3},
       {},
       {a + a, b + b, a + b}},
      {"largest_shear", "1", "largest magnitude of E_" + a + b + " of a window; 0 without any", {}},
      {"found", "1", "fraction of the subsets that were found; NaN without any", {}},
      {"correlation", "1", "mean correlation of the subsets that were found; NaN without any", {}}};
  if (sliding) std::ranges::move(SlidingLengths::channels(), std::back_inserter(channels));
  return channels;
}

void ImageCorrelation::sample(const World& world, ChannelValues& values) {
  look(world);
  DisplacementFit whole;
  double largest = 0, sum = 0;
  for (const Subset& one : subsets_) {
    if (one.moved.allFinite()) whole.add(one.start, one.moved), sum += one.correlation;
    if (const double shear = std::abs(one.green[2]); shear > largest) largest = shear;
  }
  std::ranges::copy(whole.green(4, 1e-12), values.list("strain").begin());
  const double count = whole.points();
  values["largest_shear"] = largest;
  values["found"] = subsets_.empty() ? unknown : count / static_cast<double>(subsets_.size());
  values["correlation"] = count > 0 ? sum / count : unknown;
  if (!sliding) return;
  const auto component = [&](const Vec2& of, int axis) { return of[axis == axes().right ? 0 : 1]; };
  std::vector<SlidingLengths::Point> points;
  for (const Subset& one : subsets_)
    points.push_back({.along = component(one.start + one.moved, sliding->along()),
                      .across = component(one.start + one.moved, sliding->across()),
                      .moved = component(one.moved, sliding->along())});
  SlidingLengths::fill(sliding->of(world, points, walls_), values);
}

std::vector<Field> ImageCorrelation::fields(const World& world) {
  look(world);
  const Axes look = axes();
  const std::string a{"xyz"[look.right]}, b{"xyz"[look.up]};
  std::vector<Field> fields{
      {"centre",
       "m",
       "present centre of each subset, the initial one if it was lost; half a diameter behind the face",
       3,
       {}},
      {"size", "m", "one step by one step, one mean diameter deep", 3, {}},
      {"displacement",
       "m",
       "along " + a + " and " + b + " since the first sample of the stage; NaN where it was lost",
       2,
       {},
       {a, b}},
      {"strain",
       "1",
       "E_" + a + a + ", E_" + b + b + ", E_" + a + b +
           " of the window around it, Green-Lagrange, positive in extension; NaN with fewer than six, or nearly on one "
           "line",
       3,
       {},
       {a + a, b + b, a + b}},
      {"correlation", "1", "zero-mean normalised correlation; NaN where the subset was lost", 1, {}}};
  for (const Subset& one : subsets_) {
    const Vec2 now = one.moved.allFinite() ? Vec2(one.start + one.moved) : one.start;
    Vec3 centre = Vec3::Constant(view_->face + 0.5 * look.away * view_->diameter),
         size = Vec3::Constant(view_->diameter);
    centre[look.right] = now.x(), centre[look.up] = now.y();
    size[look.right] = size[look.up] = static_cast<double>(view_->subsets.apart) * view_->pixel;
    fields[0].values.insert(fields[0].values.end(), centre.begin(), centre.end());
    fields[1].values.insert(fields[1].values.end(), size.begin(), size.end());
    fields[2].values.insert(fields[2].values.end(), one.moved.begin(), one.moved.end());
    fields[3].values.insert(fields[3].values.end(), one.green.begin(), one.green.end());
    fields[4].values.push_back(one.correlation);
  }
  return fields;
}

void ImageCorrelation::check_restored(const Image& start) const {
  if (!view_) {
    if (!start.grey.empty() || !subsets_.empty()) throw Error("the saved picture has no view");
    return;
  }
  const auto fits = [](std::ptrdiff_t size) { return size > 0 && size <= static_cast<std::ptrdiff_t>(most_pixels); };
  const SquareGrid& grid = view_->subsets;
  const auto lies_within = [&](std::ptrdiff_t first, std::ptrdiff_t count, std::ptrdiff_t size) {
    return count >= 0 && count <= size &&
           (count == 0 || (first >= half() && first < size && first + (count - 1) * grid.apart + half() < size));
  };
  if (!fits(view_->width) || !fits(view_->height) || start.width != view_->width || start.height != view_->height ||
      static_cast<std::size_t>(start.width * start.height) != start.grey.size() || !fits(grid.apart) ||
      !lies_within(grid.left, grid.columns, view_->width) || !lies_within(grid.bottom, grid.rows, view_->height) ||
      static_cast<std::size_t>(grid.columns * grid.rows) != subsets_.size() || !(view_->pixel > 0))
    throw Error("the saved picture does not fit its view");
}

void ImageCorrelation::serialize(Archive& archive) {
  archive.part("image-correlation", 1);
  Image start = start_.full;  // what is made of it is made again
  archive(began_, stage_, step_, view_, start.width, start.height, start.grey, walls_.wall, walls_.driver, subsets_);
  if (!archive.restoring()) return;
  check_restored(start);
  start_ = start.grey.empty() ? ReferenceImage() : ReferenceImage(std::move(start));
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "probe",
      .name = "image-correlation",
      .version = "1.0.0",
      .doc = "strain in a plane from pictures of the grains, by digital image correlation (DIC)",
      .make_probe = []() -> grit::Probe* { return new grit::ImageCorrelation; }};
  return &info;
}
