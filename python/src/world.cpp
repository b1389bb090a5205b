#include "world.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "grit/error.hpp"
#include "simulation/parts.hpp"

namespace grit::python {
namespace {

py::array_t<double> copy_of(const Vec3& vector) { return py::array_t<double>(3, vector.data()); }
py::array_t<double> copy_of(const Mat3& matrix) {
  return py::array_t<double>({3, 3}, {number_size, 3 * number_size}, matrix.data());
}

using Column = py::array (*)(Driver&);

/// Arrays without a copy, by name. Those behind world_with_forces() depend on forces.
const std::map<std::string, Column>& columns() {
  using A = WorldArray;
  static const std::map<std::string, Column> all{
      {"id", [](Driver& d) { return d.arrays().whole(A::ids, d.world().ids()); }},
      {"position", [](Driver& d) { return d.arrays().whole(A::positions, d.world().positions()); }},
      {"radius", [](Driver& d) { return d.arrays().member(A::positions, d.world().positions(), &Row::w); }},
      {"velocity", [](Driver& d) { return d.arrays().whole(A::velocities, d.world().velocities()); }},
      {"inverse_mass", [](Driver& d) { return d.arrays().member(A::velocities, d.world().velocities(), &Row::w); }},
      {"spin", [](Driver& d) { return d.arrays().whole(A::spins, d.world().spins()); }},
      {"material", [](Driver& d) { return d.arrays().whole(A::materials, d.world().materials()); }},
      {"rotation", [](Driver& d) { return d.arrays().whole(A::rotations, d.world().rotations()); }},
      {"displacement", [](Driver& d) { return d.arrays().whole(A::displacements, d.world().displacements()); }},
      {"force", [](Driver& d) { return d.arrays().whole(A::forces, d.world_with_forces().forces()); }},
      {"moment", [](Driver& d) { return d.arrays().whole(A::moments, d.world_with_forces().moments()); }},
      {"clump_of", [](Driver& d) { return d.arrays().whole(A::clump_of, d.world_with_forces().clump_of()); }},
  };
  return all;
}

template <auto Member>
py::array of_contacts(Driver& driver) {
  return driver.arrays().member(WorldArray::contacts, driver.world_with_forces().contacts(), Member);
}
template <auto Member>
py::array of_clumps(Driver& driver) {
  return driver.arrays().member(WorldArray::clumps, driver.world_with_forces().clumps(), Member);
}
template <auto Member>
py::array of_departures(Driver& driver) {
  return driver.arrays().member(WorldArray::departures, driver.world().departures(), Member);
}

const std::map<std::string, Column>& contact_columns() {
  static const std::map<std::string, Column> all{
      {"a", of_contacts<&Contact::a>},
      {"b", of_contacts<&Contact::b>},
      {"with_wall", of_contacts<&Contact::with_wall>},
      {"feature", of_contacts<&Contact::feature>},
      {"branch", of_contacts<&Contact::branch>},
      {"normal", of_contacts<&Contact::normal>},
      {"force", of_contacts<&Contact::force>},
      {"moment", of_contacts<&Contact::moment>},
      {"normal_force", of_contacts<&Contact::normal_force>},
      {"overlap", of_contacts<&Contact::overlap>},
  };
  return all;
}

const std::map<std::string, Column>& clump_columns() {
  static const std::map<std::string, Column> all{
      {"id", of_clumps<&ClumpView::id>},
      {"centre", of_clumps<&ClumpView::centre>},
      {"velocity", of_clumps<&ClumpView::velocity>},
      {"spin", of_clumps<&ClumpView::spin>},
      {"angular_momentum", of_clumps<&ClumpView::momentum>},
      {"force", of_clumps<&ClumpView::force>},
      {"moment", of_clumps<&ClumpView::moment>},
      {"radius", of_clumps<&ClumpView::radius>},
      {"mass", of_clumps<&ClumpView::mass>},
      {"axes", of_clumps<&ClumpView::axes>},
      {"inertia", of_clumps<&ClumpView::inertia>},
  };
  return all;
}

const std::map<std::string, Column>& departure_columns() {
  static const std::map<std::string, Column> all{
      {"id", of_departures<&Departure::id>},
      {"material", of_departures<&Departure::material>},
      {"time", of_departures<&Departure::time>},
      {"mass", of_departures<&Departure::mass>},
      {"position", of_departures<&Departure::position>},
  };
  return all;
}

py::dict wall(Driver& driver, std::size_t index) {
  const WallView& wall = driver.world_with_forces().walls()[index];
  py::dict all;
  all["position"] = copy_of(wall.position);
  all["stage_position"] = copy_of(wall.stage_position);
  all["velocity"] = copy_of(wall.velocity);
  all["spin"] = copy_of(wall.spin);
  all["force"] = copy_of(wall.force);
  all["moment"] = copy_of(wall.moment);
  all["normal"] = copy_of(wall.normal);
  all["area"] = wall.area;
  all["pressure"] = wall.pressure;
  all["contacts"] = wall.contacts;
  return all;
}

py::dict cell(Driver& driver) {
  const Cell& cell = driver.world().cell();
  py::dict all;
  all["low"] = copy_of(cell.low);
  all["high"] = copy_of(cell.high);
  all["periodic"] = cell.periodic;
  all["strain_rate"] = copy_of(cell.strain_rate);
  all["shear_rate"] = copy_of(cell.shear_rate);
  all["tilt"] = copy_of(cell.tilt);
  return all;
}

py::object energies(Driver& driver) {
  if (!driver.simulation().parts().kernel.state().bodies.energies()) return py::none();
  const Energies now = driver.world_with_forces().energies();
  py::dict all;
  all["kinetic"] = now.kinetic;
  all["elastic_normal"] = now.elastic_normal;
  all["elastic_shear"] = now.elastic_shear;
  all["elastic_rolling"] = now.elastic_rolling;
  all["gravitational"] = now.gravitational;
  all["walls"] = now.walls;
  all["cell"] = now.cell;
  all["engines"] = now.engines;
  all["settings"] = now.settings;
  all["friction"] = now.friction;
  all["rolling"] = now.rolling;
  all["viscosity"] = now.viscosity;
  all["local_damping"] = now.local_damping;
  all["closure_error"] = now.closure_error;
  return all;
}

using Box = std::pair<std::array<double, 3>, std::array<double, 3>>;

Region region_of(const World& world, const std::optional<Box>& box) {
  if (!box) return world.specimen();
  return {Vec3(box->first.data()), Vec3(box->second.data())};
}

std::vector<std::string> names_of_walls(Driver& driver) {
  std::vector<std::string> names;
  for (const WallView& wall : driver.world().walls()) names.push_back(wall.name);
  return names;
}

std::vector<std::pair<std::uint32_t, std::string>> groups(Driver& driver) {
  std::vector<std::pair<std::uint32_t, std::string>> all;
  for (const BodyGroup& group : driver.world().groups()) all.emplace_back(group.first_id, group.name);
  return all;
}

}  // namespace

void bind_world(py::class_<Driver>& simulation) {
  using Table = const std::map<std::string, Column>& (*)();
  for (const auto& [name, table] :
       std::initializer_list<std::pair<const char*, Table>>{{"body_column", columns},
                                                            {"contact_column", contact_columns},
                                                            {"clump_column", clump_columns},
                                                            {"departure_column", departure_columns}})
    simulation.def(name, [table](Driver& d, const std::string& column) { return table().at(column)(d); });
  simulation.def_property_readonly("time", [](Driver& d) { return d.world().time(); })
      .def_property_readonly("step", [](Driver& d) { return d.world().step(); })
      .def_property_readonly("dt", [](Driver& d) { return d.world().dt(); })
      .def_property_readonly("stage", [](Driver& d) { return d.world().stage(); })
      .def_property_readonly("done", &Driver::done)
      .def_property_readonly("failed", &Driver::failed)
      .def_property_readonly("bodies", [](Driver& d) { return d.world().ids().size(); })
      .def_property_readonly("mean_diameter", [](Driver& d) { return d.world().mean_diameter(); })
      .def_property_readonly("solid_density", [](Driver& d) { return d.world().solid_density(); })
      .def("description", [](Driver& d) { return d.simulation().description().dump(); })
      .def("material_names",
           [](Driver& d) {
             const auto names = d.world().material_names();
             return std::vector<std::string>(names.begin(), names.end());
           })
      .def("groups", groups)
      .def("unscaled_shares",
           [](Driver& d) {
             const auto shares = d.world().unscaled_shares();
             return std::vector<double>(shares.begin(), shares.end());
           })
      .def("walls", names_of_walls)
      .def("wall", wall)
      .def("cell", cell)
      .def("energies", energies)
      .def("specimen",
           [](Driver& d) {
             const Region region = d.world().specimen();
             return std::pair(copy_of(region.low), copy_of(region.high));
           })
      .def("equilibrium",
           [](Driver& d) {
             const Equilibrium now = equilibrium(d.world_with_forces());
             return std::tuple(now.kinetic_energy, now.unbalanced_force, now.mean_contact_force);
           })
      .def("stress",
           [](Driver& d, const std::optional<Box>& box) {
             const World& world = d.world_with_forces();
             return copy_of(mean_stress(world, region_of(world, box)));
           })
      .def("void_ratio",
           [](Driver& d, const std::optional<Box>& box) { return void_ratio(d.world(), region_of(d.world(), box)); });
}

}  // namespace grit::python
