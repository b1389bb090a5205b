#include "facets.hpp"

#include <algorithm>

#include "grit/error.hpp"
#include "grit/plugin.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

void FacetsProbe::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of a wall whose surface consists of triangles, such as a mesh");
}

void FacetsProbe::prepare(const World& world) {
  index_ = wall_index(world, wall, "wall");
  const Geometry* const geometry = world.walls()[index_].geometry;
  if (geometry == nullptr || !geometry->is_triangulated())
    throw ParameterError(
        {{"wall", "wall \"" + wall + "\", whose surface does not consist of triangles", "a wall of type mesh"}});
}

std::vector<FacetsProbe::Facet> FacetsProbe::facets(const World& world) const {
  const WallView& view = world.walls()[index_];
  const std::vector<Vec3> corners = view.geometry->triangles();
  std::vector<Facet> facets;
  facets.reserve(corners.size() / 3);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Vec3 twice = (corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]);
    const double size = twice.norm();
    facets.push_back({0.5 * size, size > 0 ? Vec3(view.pose.turn * (twice / size)) : Vec3(Vec3::Zero())});
  }
  return facets;
}

std::vector<FacetsProbe::Load> FacetsProbe::loads(const World& world, const std::vector<Facet>& facets) const {
  std::vector<Load> loads(facets.size());
  for (const Contact& contact : world.contacts_with_walls()) {
    if (contact.b != index_) continue;
    const auto facet = world.walls()[index_].geometry->triangle_of(contact.feature);
    if (!facet || *facet >= loads.size()) continue;
    const Vec3& normal = facets[*facet].normal;
    const double outwards = contact.force.dot(normal);
    loads[*facet].normal += contact.normal.dot(normal) > 0 ? outwards : -outwards;
    loads[*facet].shear += contact.force - outwards * normal;
  }
  return loads;
}

std::vector<Channel> FacetsProbe::channels() const {
  return {{"largest_pressure", "Pa", "largest pressure on a facet", {}},
          {"largest_shear", "Pa", "largest shear stress on a facet", {}},
          {"loaded_fraction", "1", "area of facets with pressure over the area of all", {}}};
}

void FacetsProbe::sample(const World& world, ChannelValues& values) {
  const std::vector<Facet> facets = this->facets(world);
  const std::vector<Load> now = loads(world, facets);
  if (sum_.size() != now.size()) sum_.assign(now.size(), {}), samples_ = 0;
  ++samples_;
  double pressure = 0, shear = 0, loaded = 0, all = 0;
  for (std::size_t f = 0; f < now.size(); ++f) {
    sum_[f].normal += now[f].normal, sum_[f].shear += now[f].shear;
    const double area = facets[f].area;
    if (!(area > 0)) continue;
    all += area;
    pressure = std::max(pressure, now[f].normal / area), shear = std::max(shear, now[f].shear.norm() / area);
    if (now[f].normal > 0) loaded += area;
  }
  values["largest_pressure"] = pressure;
  values["largest_shear"] = shear;
  values["loaded_fraction"] = all > 0 ? loaded / all : 0;
}

std::vector<Field> FacetsProbe::fields(const World& world) {
  const std::vector<Facet> facets = this->facets(world);
  const bool sampled = samples_ > 0 && sum_.size() == facets.size();
  const std::vector<Load> loads = sampled ? sum_ : this->loads(world, facets);
  const double samples = sampled ? static_cast<double>(samples_) : 1;
  sum_.clear(), samples_ = 0;
  const auto field = [&](const char* name, const char* unit, const char* doc, std::size_t width) {
    return Field{.name = name, .unit = unit, .doc = doc, .width = width, .values = {}, .components = {}, .wall = wall};
  };
  Field area = field("area", "m2", "area of the facet", 1),
        pressure =
            field("pressure", "Pa", "normal force over area, compression positive; mean since the last frame", 1),
        shear = field("shear", "Pa", "shear force of the bodies over area; mean since the last frame", 3);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const double over = facets[f].area > 0 ? 1 / (samples * facets[f].area) : 0;
    const Vec3 stress = over * loads[f].shear;
    area.values.push_back(facets[f].area);
    pressure.values.push_back(over * loads[f].normal);
    shear.values.insert(shear.values.end(), stress.begin(), stress.end());
  }
  return {area, pressure, shear};
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "facets",
                                     .version = "1.0.0",
                                     .doc = "pressure and shear on each facet of a mesh",
                                     .make_probe = []() -> grit::Probe* { return new grit::FacetsProbe; }};
  return &info;
}
