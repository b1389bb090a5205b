#include "wall-profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "grit/plugin.hpp"
#include "grit/toolkit/specimen.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {
namespace {

/// Of the sum of all contact forces: more than what rounding leaves of them where nothing has weight.
constexpr double negligible = 1e-10;

}  // namespace

void WallProfile::declare(Parameters& p) {
  p.add("walls", walls).required().entries(1).doc("names of the vertical walls, whose forces are added");
  p.add("bottom", bottom).doc("names of the walls below the bodies; default: no bottom_force");
  p.add("along", along).one_of({"x", "y", "z"}).doc("vertical axis");
  p.add("width", width).unit("m").required().above(0).doc("total width of all walls, across their height");
  p.add("low", low).unit("m").doc("lower end of the profile; default: lower side of the specimen");
  p.add("high", high).unit("m").doc("upper end of the profile; default: upper side of the specimen");
  p.add("strips", strips).at_least(1).at_most(10000).doc("number of strips of equal height of the profile");
  p.check(
      [this](const Complain& complain) {
        if (low && high && !(*low < *high))
          complain("high", std::to_string(*high) + " m", "above low, " + std::to_string(*low) + " m");
      },
      {"low", "high"});
  p.check(
      [this](const Complain& complain) {
        for (const auto& name : bottom)
          if (std::ranges::find(walls, name) != walls.end())
            complain("bottom", '"' + name + "\", which is in walls as well", "names that are not in walls");
      },
      {"walls", "bottom"});
}

void WallProfile::prepare(const World& world) {
  chosen_.assign(world.walls().size(), false), below_ = chosen_;
  for (const auto& name : walls) {
    const std::size_t index = wall_index(world, name, "walls");
    const Vec3& normal = world.walls()[index].normal;
    if (!(normal.norm() > 0.5))
      throw ParameterError(
          {{"walls", "wall \"" + name + "\", which has no normal of its own", "flat or grooved walls"}});
    if (!(std::abs(normal[axis()]) < 1e-6))
      throw ParameterError({{"walls", "wall \"" + name + "\", which is not parallel to " + along,
                             "walls parallel to " + along + ", or another axis for `along`"}});
    chosen_[index] = true;
  }
  for (const auto& name : bottom) below_[wall_index(world, name, "bottom")] = true;
}

std::vector<Channel> WallProfile::channels() const {
  const std::vector<std::size_t> each{static_cast<std::size_t>(strips)};
  const std::string share = " over weight, of all walls together; NaN without weight";
  std::vector<Channel> all{
      {"position", "m", "middle of each strip, along " + along, each},
      {"normal_stress", "Pa", "normal force over the area of the strip, positive in compression", each, "position"},
      {"shear_stress", "Pa",
       "shear force against " + along + " over the area of the strip, positive if the walls carry sand", each,
       "position"},
      {"normal_force", "N", "normal force of all contacts, within the profile and beyond", {}},
      {"shear_force", "N", "shear force of all contacts, against " + along, {}},
      {"friction_angle", "degree", "mobilised: atan of shear_force over normal_force; 0 without contacts", {}},
      {"weight", "N", "weight G of all bodies in the domain, against " + along + "; NaN without any", {}},
      {"shear_fraction", "1", "T/G: shear_force" + share, {}},
      {"normal_fraction", "1", "N/G: normal_force" + share, {}}};
  if (bottom.empty()) return all;
  all.push_back({"bottom_force", "N", "force P on the bottom, positive against " + along, {}});
  all.push_back({"bottom_fraction", "1", "P/G: bottom_force over weight; NaN without weight", {}});
  return all;
}

WallProfile::Ends WallProfile::ends(const World& world) const {
  const Region box = specimen_box(world);
  return {low.value_or(box.low[axis()]), high.value_or(box.high[axis()])};
}

// Net forces are without local damping, and forces between bodies add up to nothing: less those of walls, weight is
// what is left.
double WallProfile::weight(const World& world) const {
  double down = 0;
  const auto clump_of = world.clump_of();
  for (std::size_t i = 0; i < world.forces().size(); ++i)
    if (clump_of.empty() || clump_of[i] == no_clump) down -= xyz(world.forces()[i])[axis()];
  for (const ClumpView& clump : world.clumps()) down -= clump.force[axis()];
  for (const Contact& contact : world.contacts_with_walls()) down -= contact.force[axis()];
  // A body has some contacts, so that this is less than their sum.
  const double rounding = negligible * world.mean_contact_force() * static_cast<double>(world.positions().size());
  return down > rounding ? down : std::numeric_limits<double>::quiet_NaN();
}

void WallProfile::sample(const World& world, ChannelValues& values) {
  const Ends end = ends(world);
  const double height = (end.high - end.low) / static_cast<double>(strips);
  const auto places = values.list("position");
  const auto normal_stress = values.list("normal_stress");
  const auto shear_stress = values.list("shear_stress");
  for (std::size_t s = 0; s < static_cast<std::size_t>(strips); ++s)
    places[s] = end.low + (static_cast<double>(s) + 0.5) * height, normal_stress[s] = shear_stress[s] = 0;
  double normal = 0, shear = 0, borne = 0;
  for (const Contact& contact : world.contacts_with_walls()) {
    const double hanging = -contact.force[axis()];
    if (below_[contact.b]) borne += hanging;
    if (!chosen_[contact.b]) continue;
    const double pressing = -contact.force.dot(world.walls()[contact.b].normal);
    normal += pressing, shear += hanging;
    const double place = xyz(world.positions()[contact.a])[axis()] + contact.branch[axis()];
    if (!(place >= end.low && place < end.high)) continue;
    const auto strip =
        static_cast<std::size_t>(std::min(std::floor((place - end.low) / height), static_cast<double>(strips - 1)));
    normal_stress[strip] += pressing / (width * height), shear_stress[strip] += hanging / (width * height);
  }
  values["normal_force"] = normal;
  values["shear_force"] = shear;
  values["friction_angle"] = normal == 0 && shear == 0 ? 0 : std::atan2(shear, normal) * 180 / std::numbers::pi;
  const double whole = weight(world);
  values["weight"] = whole;
  values["shear_fraction"] = shear / whole;
  values["normal_fraction"] = normal / whole;
  if (bottom.empty()) return;
  values["bottom_force"] = borne;
  values["bottom_fraction"] = borne / whole;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "wall-profile",
                                     .version = "1.0.0",
                                     .doc = "profile of normal and shear stress on vertical walls",
                                     .make_probe = []() -> grit::Probe* { return new grit::WallProfile; }};
  return &info;
}
