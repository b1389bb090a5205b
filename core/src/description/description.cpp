#include "description/description.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "description/motion_checks.hpp"
#include "format/names.hpp"
#include "format/number.hpp"
#include "grit/toolkit/did_you_mean.hpp"

namespace grit {
namespace {

const std::vector<std::string> one_axis{"x", "y", "z"};
const std::vector<std::string> some_axes{"x", "y", "z", "xy", "xz", "yz", "xyz"};
const std::vector<std::string> all_sides{"-x", "+x", "-y", "+y", "-z", "+z"};

bool is_changeable(const std::string& section) {
  const auto& all = SceneDescription::changeable();
  return std::ranges::find(all, section) != all.end();
}

template <class Names>
std::string any_of(const Names& names, const std::string& otherwise) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "one of " : ", ") + name;
  return text.empty() ? otherwise : text;
}

template <class T>
std::vector<std::string> keys(const std::map<std::string, T>& map) {
  std::vector<std::string> names;
  for (const auto& entry : map) names.push_back(entry.first);
  return names;
}

void declare_sizes(Parameters& p, double& smallest, double& largest) {
  p.add("smallest", smallest).unit("m").symbol("d_min").above(0).doc("smallest diameter");
  p.add("largest", largest).unit("m").symbol("d_max").above(0).doc("largest diameter");
  p.check(
      [&](const Complain& complain) {
        if (largest < smallest)
          complain("largest", number(largest) + " m, below smallest, which is " + number(smallest) + " m",
                   "at least smallest; are the units of both right?");
      },
      {"smallest", "largest"});
}

void check_columns(const FileSource& file, const Complain& complain) {
  const auto& columns = file.columns;
  const bool any_format = file.format == "auto", is_text = any_format || file.format == "text";
  if (!columns.empty() && !is_text && file.format != "lammps-data")
    complain("columns", "columns of the format " + file.format, "none; the file names them");
  if (file.header_lines > 0 && !is_text)
    complain("header_lines", "lines to skip in the format " + file.format, "0; they are for the format text");
  if (file.time_step >= 0 && !any_format && file.format != "lammps-dump")
    complain("time_step", "a time step in the format " + file.format, "-1; it is for the format lammps-dump");
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] != "-" &&
        std::ranges::count(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) == 1)
      complain("columns/" + std::to_string(i), "a second column " + columns[i], "one; - skips a column");
  if (columns.empty()) return;
  const auto has = [&](const char* name) { return std::ranges::find(columns, name) != columns.end(); };
  for (const std::string& axis : one_axis)
    if (!has(axis.c_str())) complain("columns", "no column " + axis, "x, y, z and r or d");
  if (has("r") == has("d"))
    complain("columns", has("r") ? "a radius and a diameter" : "neither a radius nor a diameter", "r or d");
}

/// Reports each axis along which low is not below high.
void check_box(const Vec3& low, const Vec3& high, const Complain& complain) {
  for (int k = 0; k < 3; ++k)
    if (!(low[k] < high[k]))
      complain("high/" + std::to_string(k), "high not above low along " + one_axis[as_index(k)], "low < high");
}

/// Reports names that are not among `names`.
class References {
 public:
  References(std::string what, std::vector<std::string> names, const Complain& complain)
      : names_(std::move(names)), complain_(complain), what_(std::move(what)) {}

  bool has(const std::string& name) const { return std::ranges::find(names_, name) != names_.end(); }
  void check(const std::string& key, const std::string& name) const {
    if (!has(name))
      complain_(key, "the " + what_ + ' ' + in_quotes(name) + ", which is not defined" + did_you_mean(name, names_),
                any_of(names_, "none"));
  }

 private:
  std::vector<std::string> names_;
  const Complain& complain_;
  std::string what_;
};

void check_walls_of(const Condition& condition, const std::string& key, const References& walls) {
  const auto each = [&](const std::vector<Condition>& parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) check_walls_of(parts[i], key + "/of/" + std::to_string(i), walls);
  };
  const auto& is = condition.is.value();
  if (const auto* displacement = std::get_if<DisplacementCondition>(&is))
    walls.check(key + "/wall", displacement->wall);
  if (const auto* pressure = std::get_if<PressureCondition>(&is)) walls.check(key + "/wall", pressure->wall);
  if (const auto* all = std::get_if<AllCondition>(&is)) each(all->of);
  if (const auto* any = std::get_if<AnyCondition>(&is)) each(any->of);
}

/// Reports walls that follow themselves through other walls.
void check_circles(const std::map<std::string, WallDescription>& walls, const Complain& complain) {
  for (const auto& [name, wall] : walls) {
    std::set<std::string> passed;
    const WallDescription* at = &wall;
    while (at->motion.follow && passed.insert(at->motion.follow->wall).second) {
      const auto next = walls.find(at->motion.follow->wall);
      if (next == walls.end()) break;
      at = &next->second;
    }
    if (passed.contains(name))
      complain("walls/" + name + "/motion/follow/wall", "a cycle of walls that follow each other",
               "a wall outside the cycle");
  }
}

// ---- checks between sections

/// A body keeps the index of its material in one byte, that of its group in two.
void check_number_of_materials(const SceneDescription& scene, const Complain& complain) {
  constexpr std::size_t most = 255;
  if (scene.materials.size() > most)
    complain("materials", counted(scene.materials.size(), "material", "materials"), std::to_string(most) + " or fewer");
}
void check_number_of_groups(const SceneDescription& scene, const Complain& complain) {
  constexpr std::size_t most = 65535;
  if (scene.bodies.size() > most)
    complain("bodies", counted(scene.bodies.size(), "group", "groups"), std::to_string(most) + " or fewer");
}

void check_interfaces(const SceneDescription& scene, const Complain& complain) {
  for (const auto& [name, _] : scene.materials)
    if (name.find('+') != std::string::npos)
      complain("materials/" + name, "a name with a +", "a name without +, which joins the materials of an interface");
  const References known("material", keys(scene.materials), complain);
  std::set<std::pair<std::string, std::string>> pairs;
  for (const InterfaceDescription& one : scene.interfaces) {
    const std::string name = one.name(), key = "interfaces/" + name;
    if (one.b.empty()) {
      complain(key, in_quotes(name), "two materials joined by +, e.g. sand+steel");
      continue;
    }
    known.check(key, one.a);
    if (one.a != one.b) known.check(key, one.b);
    if (!pairs.insert(std::minmax(one.a, one.b)).second)
      complain(key, "an interface that is defined twice", "one definition, in either order");
  }
}

void check_materials_of_bodies(const SceneDescription& scene, const Complain& complain) {
  const References known("material", keys(scene.materials), complain);
  for (const auto& [name, group] : scene.bodies) known.check("bodies/" + name + "/material", group.material);
}

void check_materials_of_walls(const SceneDescription& scene, const Complain& complain) {
  const References known("material", keys(scene.materials), complain);
  for (const auto& [name, wall] : scene.walls) known.check("walls/" + name + "/material", wall.material);
}

void check_growth(const SceneDescription& scene, const Complain& complain) {
  const auto grows = [](const StageDescription& stage) { return stage.growth.has_value(); };
  if (std::ranges::none_of(scene.stages, grows)) return;
  for (const auto& [name, engine] : scene.engines) {
    MotionSettings settings;
    engine.engine.make()->settings(settings);
    if (settings.scaled_radius > 0)
      complain("engines/" + name, "density scaling together with growth of bodies in a stage",
               "only one of them, as the scaled masses would not fit the new sizes; remove one");
  }
}

/// Reports groups of bodies that do not exist.
void check_groups(const SceneDescription& scene, const Complain& complain) {
  const References known("group", keys(scene.bodies), complain);
  const auto check = [&](const std::string& key, const std::vector<std::string>& groups) {
    for (std::size_t i = 0; i < groups.size(); ++i) known.check(key + "/groups/" + std::to_string(i), groups[i]);
  };
  for (const auto& [name, wall] : scene.walls) check("walls/" + name, wall.groups);
  for (const auto& [name, engine] : scene.engines) check("engines/" + name, engine.groups);
  for (const auto& [name, probe] : scene.probes) check("probes/" + name, probe.groups);
}

/// Reports groups from a sample without one, settings that the sample gives, and a sample of which no group is used.
void check_sample(const SceneDescription& scene, const Complain& complain) {
  bool used = false;
  for (const auto& [name, group] : scene.bodies) {
    if (!group.is_from_sample()) continue;
    used = true;
    if (!scene.begin)
      complain("bodies/" + name + "/source", "a source of type sample without /begin",
               "a run that begins from a sample: add \"begin\": {\"from\": FOLDER}");
    if (!group.stage.empty())
      complain("bodies/" + name + "/stage", "a group of a sample that appears in a stage",
               "the start of the run; remove stage");
    if (!group.velocity.isZero(0.0))
      complain("bodies/" + name + "/velocity", "a velocity of bodies that come from a sample",
               "none: they keep that of the sample; remove velocity");
    if (group.overlap != BodiesDescription::usual_overlap)
      complain("bodies/" + name + "/overlap", "a maximum overlap of bodies that come from a sample",
               "none: it is for bodies that appear in a stage; remove overlap");
  }
  if (scene.begin && !used)
    complain("begin", "a sample of which no group of bodies is used",
             "a group of bodies with \"source\": {\"type\": \"sample\"}");
}

/// Walls and sources of bodies know no images off the axes.
void check_shear(const SceneDescription& scene, const Complain& complain) {
  if (!scene.domain.shears()) return;
  for (const auto& [name, wall] : scene.walls)
    complain("walls/" + name, "a wall in a domain that shears", "a domain without walls; or no shear of /domain");
  for (const auto& [name, group] : scene.bodies)
    if (!group.stage.empty() || std::holds_alternative<StreamSource>(group.source.value()))
      complain("bodies/" + name, "bodies that appear during the run in a domain that shears",
               "bodies from the start; or no shear of /domain");
}

void check_followers(const SceneDescription& scene, const Complain& complain) {
  const References known("wall", keys(scene.walls), complain);
  for (const auto& [name, wall] : scene.walls)
    if (wall.motion.follow) known.check("walls/" + name + "/motion/follow/wall", wall.motion.follow->wall);
  check_circles(scene.walls, complain);
}

void declare_parts(Parameters& p, std::vector<Condition>& of, const std::string& doc) {
  ListTarget target;
  target.size = [&of] { return of.size(); };
  target.clear = [&of] { of.clear(); };
  target.append = [&of](Parameters& inner) { of.emplace_back().declare(inner); };
  target.declare = [&of](std::size_t i, Parameters& inner) { of[i].declare(inner); };
  p.add_target("of", std::move(target)).required().entries(1).doc(doc);
}

}  // namespace

void DisplacementCadence::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall");
  p.add("axis", axis).one_of(one_axis).doc("axis of the displacement");
  p.add("value", value)
      .unit("m")
      .symbol("u")
      .above(0)
      .required()
      .doc("displacement between two samples or frames, in either direction");
}
void Cadence::declare(Parameters& p) {
  p.add("every_time", every_time).unit("s").above(0).doc("simulated time between two samples or frames");
  p.add("every_steps", every_steps).at_least(0).doc("steps between two samples or frames; 0: not used");
  p.add("every_displacement", every_displacement).doc("displacement of a wall between two samples or frames");
  p.add("every_discharged", every_discharged)
      .above(0)
      .at_most(1)
      .doc("mass discharged between two samples or frames, over the mass of all bodies so far");
  p.check(
      [this](const Complain& complain) {
        std::string key, given;
        int count = 0;
        const auto add = [&](bool there, const char* name, const char* what) {
          if (there) key = name, given += (++count == 1 ? "a cadence " : " and ") + std::string(what);
        };
        add(every_time.has_value(), "every_time", "in time");
        add(every_steps > 0, "every_steps", "in steps");
        add(every_displacement.has_value(), "every_displacement", "in displacement");
        add(every_discharged.has_value(), "every_discharged", "in discharged mass");
        if (count > 1) complain(key, given, "one of them");
      },
      {"every_time", "every_steps", "every_displacement", "every_discharged"});
}

// ---- grains

void UniformSizes::declare(Parameters& p) { declare_sizes(p, smallest, largest); }
void LinearSizes::declare(Parameters& p) { declare_sizes(p, smallest, largest); }
void LogNormalSizes::declare(Parameters& p) {
  p.add("median", median).unit("m").symbol("d_50").above(0).doc("median diameter");
  p.add("log_standard_deviation", log_standard_deviation)
      .above(0)
      .at_most(3)
      .doc("standard deviation of the natural logarithm of the diameter");
  declare_sizes(p, smallest, largest);
}
void SieveSizes::declare(Parameters& p) {
  p.add("diameters", diameters).unit("m").above(0).required().entries(2).doc("sieve openings, increasing");
  p.add("passing", passing)
      .at_least(0)
      .at_most(1)
      .required()
      .entries(2)
      .doc("mass fraction that passes each sieve, increasing to 1");
  p.check(
      [this](const Complain& complain) {
        const auto rises = [](const std::vector<double>& v) {
          return std::ranges::adjacent_find(v, std::greater_equal()) == v.end();
        };
        if (passing.size() != diameters.size())
          complain("passing", counted(passing.size(), "entry", "entries"),
                   std::to_string(diameters.size()) + ", one per diameter");
        if (!rises(diameters)) complain("diameters", "a list that does not increase", "an increasing list");
        if (!rises(passing)) complain("passing", "a list that does not increase", "an increasing list");
        if (passing.back() != 1) complain("passing", "a last entry below 1", "1, all the mass");
      },
      {"diameters", "passing"});
}
void ListSizes::declare(Parameters& p) {
  p.add("diameters", diameters)
      .unit("m")
      .above(0)
      .required()
      .entries(1)
      .doc("diameters, assigned in order and repeated");
}

void LatticeSource::declare(Parameters& p) {
  p.add("kind", kind)
      .one_of({"simple-cubic", "bcc", "fcc", "hcp"})
      .required()
      .doc("lattice; of hcp close-packed layers are normal to z");
  p.add("low", low).unit("m").required().doc("lower corner of the box to fill");
  p.add("high", high).unit("m").required().doc("upper corner of the box to fill");
  p.add("diameter", diameter).unit("m").symbol("d").above(0).required().doc("diameter of the bodies");
  p.add("spacing", spacing).unit("m").above(0).doc("distance of nearest neighbours; default: the diameter");
  p.check([this](const Complain& complain) { check_box(low, high, complain); }, {"low", "high"});
}
const std::vector<std::string>& FileSource::column_names() {
  static const std::vector<std::string> names{"x",  "y",  "z",  "r",  "d",    "vx", "vy",
                                              "vz", "wx", "wy", "wz", "type", "id", "-"};
  return names;
}
void FileSource::declare(Parameters& p) {
  p.add("path", path).file().required().doc("text file with one body per line; # starts a comment");
  p.add("format", format)
      .one_of({"auto", "text", "lammps-data", "lammps-dump", "yade", "xyz", "dem-engine"})
      .doc("format of the file; auto: found by its content. lammps-* are also those of LIGGGHTS");
  p.add("columns", columns)
      .one_of(column_names())
      .doc(
          "what the columns hold, for the formats text and lammps-data: r radius, d diameter, vx velocity, wx angular "
          "velocity, - skipped; default: x y z r, or the names in the first line");
  p.add("header_lines", header_lines).at_least(0).doc("lines at the beginning that are skipped, for the format text");
  p.add("scale", scale).unit("m").above(0).doc("length of one file unit, e.g. \"1 mm\"; also scales velocities");
  p.add("particle_type", particle_type).doc("reads only bodies of this type in the file, e.g. \"2\"; default: all");
  p.add("time_step", time_step)
      .at_least(-1)
      .doc("time step of the snapshot to read, for the format lammps-dump; -1: the last one");
  p.check(
      [this](const Complain& complain) {
        if (path.empty()) complain("path", "an empty text", "the path of a file");
      },
      {"path"});
  p.check([this](const Complain& complain) { check_columns(*this, complain); },
          {"format", "columns", "header_lines", "time_step"});
}
void ListedBody::declare(Parameters& p) {
  p.add("position", position).unit("m").required().doc("centre");
  p.add("radius", radius).unit("m").symbol("R").above(0).required().doc("radius");
  p.add("velocity", velocity).unit("m/s").symbol("v").doc("initial velocity");
  p.add("spin", spin).unit("rad/s").symbol("omega").doc("initial angular velocity, right-handed");
  p.add("orientation", orientation)
      .unit("rad")
      .doc("initial orientation of a clump: rotation vector from the orientation in which its shape is given");
}
void ListSource::declare(Parameters& p) { p.add("bodies", bodies).required().entries(1).doc("the bodies, one by one"); }

void RectangleRegion::declare(Parameters& p) {
  p.add("corner", corner).unit("m").required().doc("corner");
  p.add("edge_a", edge_a).unit("m").required().doc("one edge, from the corner");
  p.add("edge_b", edge_b).unit("m").required().doc("the other edge, from the corner");
  p.check([this](const Complain& complain) {
    if (!(edge_a.cross(edge_b).norm() > 0)) complain("edge_b", "parallel edges", "an edge across edge_a");
  });
}
void DiscRegion::declare(Parameters& p) {
  p.add("centre", centre).unit("m").required().doc("centre");
  p.add("normal", normal).doc("normal of the disc");
  p.add("radius", radius).unit("m").above(0).required().doc("radius of the disc");
  p.check([this](const Complain& complain) {
    if (!(normal.norm() > 0)) complain("normal", "a vector of length 0", "a direction");
  });
}
void BoxRegion::declare(Parameters& p) {
  p.add("low", low).unit("m").required().doc("lower corner");
  p.add("high", high).unit("m").required().doc("upper corner");
  p.check([this](const Complain& complain) { check_box(low, high, complain); }, {"low", "high"});
}
void SphereRegion::declare(Parameters& p) {
  p.add("centre", centre).unit("m").required().doc("centre");
  p.add("radius", radius).unit("m").above(0).required().doc("radius");
}
void CylinderRegion::declare(Parameters& p) {
  p.add("start", start).unit("m").required().doc("start of the axis: centre of one end");
  p.add("end", end).unit("m").required().doc("end of the axis: centre of the other end");
  p.add("radius", radius).unit("m").above(0).required().doc("radius");
  p.check([this](const Complain& complain) {
    if (start == end) complain("end", "the start of the axis", "another point");
  });
}
void HalfSpaceRegion::declare(Parameters& p) {
  p.add("point", point).unit("m").required().doc("any point of the plane");
  p.add("normal", normal).doc("normal of the plane, out of the region; any length above 0");
  p.check([this](const Complain& complain) {
    if (!(normal.norm() > 0)) complain("normal", "a vector of length 0", "a direction");
  });
}
void MeshRegion::declare(Parameters& p) {
  p.add("path", path).file().required().doc("STL file, ASCII or binary, of a closed surface");
  p.add("scale", scale).unit("m").required().above(0).doc("length of one file unit, e.g. \"1 mm\"");
  p.add("position", position).unit("m").doc("position of the file's origin in the scene");
}
void CloudSource::declare(Parameters& p) {
  p.add("low", low).unit("m").doc("lower corner of the box to fill; needed without a region");
  p.add("high", high).unit("m").doc("upper corner of the box to fill; needed without a region");
  p.add("region", region).doc("region to fill instead of a box; bodies are inside it as a whole");
  p.add("count", count).at_least(1).at_most(4e9).required().doc("number of bodies");
  p.add("sizes", sizes).required().doc("distribution of diameters");
  p.add("plane_normal", plane_normal)
      .one_of({"none", "x", "y", "z"})
      .doc("normal of the plane through the centre of the box in which all centres lie, for the engine planar");
  p.check(
      [this](const Complain& complain) {
        if (region && (low || high)) complain("region", "a region and a box", "a region, or low and high");
        else if (!region && !(low && high))
          complain("", low || high ? "one corner of a box" : "neither a box nor a region", "low and high, or a region");
        else if (!region) check_box(*low, *high, complain);
      },
      {"low", "high", "region"});
}

void StreamSource::declare(Parameters& p) {
  p.add("region", region).required().doc("where bodies enter: at random positions, without overlaps");
  p.add("number_rate", number_rate).unit("1/s").above(0).doc("bodies per time; needed without mass_rate");
  p.add("mass_rate", mass_rate).unit("kg/s").above(0).doc("mass per time");
  p.add("sizes", sizes).required().doc("distribution of diameters");
  p.add("count", count).at_least(0).at_most(4e9).doc("number of bodies after which the stream ends; 0: no limit");
  p.add("mass", mass).unit("kg").above(0).doc("mass after which the stream ends");
  p.add("time", time).unit("s").above(0).doc("time after which the stream ends, from its beginning");
  p.check(
      [this](const Complain& complain) {
        if (!number_rate && !mass_rate) complain("number_rate", "no rate", "number_rate or mass_rate");
        if (number_rate && mass_rate) complain("mass_rate", "two rates", "number_rate or mass_rate");
      },
      {"number_rate", "mass_rate"});
}

BodiesDescription::BodiesDescription(const Registry& registry) : kind(registry) {}
void BodiesDescription::declare(Parameters& p) {
  p.choose(kind);
  p.add("material", material).required().doc("name of the material");
  p.add("stage", stage).doc("name of the stage at the start of which they appear; default: at the start of the run");
  p.add("velocity", velocity).unit("m/s").symbol("v").doc("initial velocity, added to the velocities in a list");
  p.add("overlap", overlap)
      .at_least(0)
      .doc("maximum overlap with existing walls and bodies when they appear in a stage, over the smaller radius");
  p.add("source", source).required().doc("positions and radii");
}

// ---- walls

void ServoDescription::declare(Parameters& p) {
  p.add("axis", axis).one_of(one_axis).doc("axis of the controlled motion");
  p.add("pressure", pressure).unit("Pa").symbol("p").at_least(0).doc("target pressure, compression positive");
  p.add("force", force)
      .unit("N")
      .symbol("F")
      .doc("target force of the wall on the bodies along the axis, signed; for any geometry");
  p.add("max_velocity", max_velocity).unit("m/s").above(0).required().doc("maximum speed of the wall");
  p.add("gain", gain)
      .above(0)
      .at_most(1)
      .doc("fraction of the force error corrected per step if contacts are elastic; less if they are damped");
  p.add("area", area)
      .one_of({"geometry", "specimen"})
      .doc("area on which the pressure acts: that of the geometry, or the current cross-section of the specimen");
  p.check(
      [this](const Complain& complain) {
        if (!pressure && !force) complain("pressure", "neither a pressure nor a force", "one of them");
        if (pressure && force) complain("force", "a pressure and a force", "one of them");
        if (force && area != "geometry")
          complain("area", "an area together with a force", "an area together with a pressure");
      },
      {"pressure", "force", "area"});
}
void FollowDescription::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall to follow");
  p.add("axes", axes).one_of(some_axes).doc("axes along which it follows");
}
void FreeDescription::declare(Parameters& p) {
  p.add("axes", axes).one_of(some_axes).doc("axes along which the wall moves freely under the forces on it");
  p.add("mass", mass).unit("kg").symbol("m").above(0).required().doc("mass of the wall");
  p.add("load", load).unit("N").symbol("F").doc("external force on the wall");
}
void FreeRotationDescription::declare(Parameters& p) {
  p.add("axis", axis).required().doc("axis about which the wall rotates freely, through the point `about`");
  p.add("inertia", inertia)
      .unit("kg m^2")
      .symbol("I")
      .above(0)
      .required()
      .doc("moment of inertia of the wall about the axis");
  p.add("moment", moment).unit("N m").symbol("M").doc("external moment on the wall about the axis, right-handed");
  p.check(
      [this](const Complain& complain) {
        if (!(axis.norm() > 0)) complain("axis", "a vector of length 0", "a direction");
      },
      {"axis"});
}
void OscillationDescription::declare(Parameters& p) {
  p.add("amplitude", amplitude)
      .unit("m")
      .symbol("A")
      .doc("amplitude of the displacement, half of the peak-to-peak distance");
  p.add("angle", angle)
      .unit("rad")
      .symbol("alpha")
      .doc("amplitude of the rotation about the point `about`, right-handed");
  p.add("frequency", frequency).unit("Hz").symbol("f").above(0).required().doc("frequency");
  p.add("phase", phase)
      .unit("rad")
      .symbol("phi")
      .doc("phase at the start; 0: at the mean position, 90 deg: at the positive extreme");
  p.add("amplitude_phase", amplitude_phase)
      .unit("rad")
      .doc(
          "phases of the displacement along x, y and z, added to phase; with a difference of 90 deg a point moves on "
          "an ellipse");
  p.add("angle_phase", angle_phase).unit("rad").doc("the same for the components of angle");
  p.check(
      [this](const Complain& complain) {
        if (amplitude.isZero(0.0) && angle.isZero(0.0))
          complain("amplitude", "neither an amplitude nor an angle", "one that is not 0, or no oscillation");
      },
      {"amplitude", "angle"});
}
void MotionDescription::declare(Parameters& p) {
  p.add("velocity", velocity).unit("m/s").symbol("v").doc("velocity");
  p.add("spin", spin).unit("rad/s").symbol("omega").doc("angular velocity, right-handed");
  p.add("surface_velocity", surface_velocity)
      .unit("m/s")
      .doc(
          "velocity of the surface while the wall stays, as of a belt; contacts see its tangential component; it "
          "turns with the wall");
  p.add("surface_spin", surface_spin)
      .unit("rad/s")
      .doc("angular velocity of the surface about the point `about` while the wall stays, as of a turntable");
  p.add("about", about).unit("m").doc("centre of rotation; default: the reference point of the geometry");
  p.add("ramp_time", ramp_time)
      .unit("s")
      .at_least(0)
      .doc("time over which velocity, spin, those of the surface, and oscillation increase linearly from zero");
  p.add("oscillation", oscillation).doc("sinusoidal motion, added to velocity and spin");
  p.add("servo", servo).doc("motion that keeps a pressure or force");
  p.add("follow", follow).doc("motion of another wall");
  p.add("free", free).doc("free motion under the forces on the wall");
  p.add("free_rotation", free_rotation).doc("free rotation under the moments on the wall");
  p.check(
      [this](const Complain& complain) {
        for (int k = 0; k < 3; ++k) {
          std::vector<std::string> claims;
          const auto claim = [&](bool claimed, const char* key) {
            if (claimed) claims.push_back(key);
          };
          const bool swings = oscillation && oscillation->amplitude[k] != 0;
          claim(velocity[k] != 0 && !swings, "velocity");
          claim(swings, "oscillation");
          claim(servo && servo->axis == one_axis[as_index(k)], "servo");
          claim(follow && follow->axes.find(one_axis[as_index(k)]) != std::string::npos, "follow");
          claim(free && free->axes.find(one_axis[as_index(k)]) != std::string::npos, "free");
          if (claims.size() < 2) continue;
          std::string all;
          for (const auto& one : claims) all += (all.empty() ? "" : " and ") + one;
          complain(claims.back(), "the axis " + one_axis[as_index(k)] + " controlled by " + all,
                   "one of them per axis");
        }
      },
      {"velocity", "oscillation", "servo", "follow", "free"});
  p.check(
      [this](const Complain& complain) {
        if (!free_rotation) return;
        const bool swings = oscillation && !oscillation->angle.isZero(0.0);
        if (spin.isZero(0.0) && !swings) return;
        complain("free_rotation",
                 std::string("a rotation controlled by ") + (swings ? "oscillation" : "spin") + " and free_rotation",
                 "one of them");
      },
      {"spin", "oscillation", "free_rotation"});
}
WallDescription::WallDescription(const Registry& registry) : geometry(registry) {}
void WallDescription::declare(Parameters& p) {
  p.choose(geometry);
  p.add("material", material).required().doc("name of the surface material");
  p.add("groups", groups).doc("names of the groups of bodies on which the wall acts; empty: all");
  p.add("motion", motion).doc("motion, axis by axis; default: fixed");
}

// ---- the rest

void MaterialDescription::declare(const std::string& name, ContactLaw* law, Parameters& p) {
  p.add("density", density).unit("kg/m^3").symbol("rho").above(0).doc("density of the solid");
  if (law == nullptr) return p.leave_open(), p.add_values(values);
  law->declare_material(name, p);
  p.when_read([this, name, law] {
    Parameters own;
    law->declare_material(name, own);
    values = write(own);
  });
}
InterfaceDescription::InterfaceDescription(const std::string& name) : a(name.substr(0, name.find('+'))) {
  if (a.size() < name.size()) b = name.substr(a.size() + 1);
}
void InterfaceDescription::declare(ContactLaw* law, Parameters& p) {
  if (law == nullptr || b.empty()) return p.leave_open(), p.add_values(values);
  law->declare_interface(a, b, p);
  p.when_read([this, law] {
    Parameters own;
    law->declare_interface(a, b, own);
    values = write(own);
  });
}
void CellStressDescription::declare(Parameters& p) {
  for (const auto& [name, value] : {std::pair("xx", &xx), std::pair("yy", &yy), std::pair("zz", &zz)})
    p.add(name, *value).unit("Pa").symbol(std::string("sigma_") + name).doc("target, compression positive");
  for (const auto& [name, value] : {std::pair("xy", &xy), std::pair("xz", &xz), std::pair("yz", &yz)})
    p.add(name, *value)
        .unit("Pa")
        .symbol(std::string("sigma_") + name)
        .doc("target; a positive shear rate makes it negative, as extension does with normal stresses");
}
void ShearRateDescription::declare(Parameters& p) {
  p.add("xy", xy).unit("1/s").symbol("gamma_dot_xy").doc("gradient of the velocity along x in the direction y");
  p.add("xz", xz).unit("1/s").symbol("gamma_dot_xz").doc("gradient of the velocity along x in the direction z");
  p.add("yz", yz).unit("1/s").symbol("gamma_dot_yz").doc("gradient of the velocity along y in the direction z");
}
void CellServoDescription::declare(Parameters& p) {
  p.add("stress", stress)
      .required()
      .doc("stresses of the whole cell to keep; the strain rate of other components is prescribed");
  p.add("max_strain_rate", max_strain_rate)
      .unit("1/s")
      .above(0)
      .required()
      .doc("maximum strain rate of each component; without contacts the cell contracts at this rate");
  p.add("gain", gain)
      .above(0)
      .at_most(1)
      .doc("fraction of the error in stress that is corrected in an interval if bodies move with the mean flow");
  p.add("interval", interval).at_least(1).at_most(1000).doc("steps between evaluations of the stress");
}
const std::vector<std::string>& DomainDescription::changeable() {
  static const std::vector<std::string> keys{"strain_rate", "shear_rate", "servo"};
  return keys;
}
void DomainDescription::declare(Parameters& p) {
  p.add("low", low).unit("m").doc("lower corner; default: unbounded");
  p.add("high", high).unit("m").doc("upper corner; default: unbounded");
  p.add("periodic", periodic).doc("axes along which the domain is periodic");
  p.add("strain_rate", strain_rate)
      .unit("1/s")
      .symbol("eps_dot")
      .doc("strain rate along periodic axes, positive in extension");
  p.add("shear_rate", shear_rate).doc("simple shear of a domain that is periodic along all axes, without walls");
  p.add("servo", servo).doc("strain rates that keep stresses of a cell that is periodic along all axes");
  p.add("open_sides", open_sides)
      .doc("sides through which bodies may leave; they are removed: -x, +x, -y, +y, -z, +z; elsewhere it is an error");
  p.check(
      [this](const Complain& complain) {
        if (low && high) check_box(*low, *high, complain);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::string axis = '/' + std::to_string(k);
          if (periodic[k] && !(low && high))
            complain("periodic" + axis, "a periodic axis without bounds", "a periodic axis with low and high");
          if (!periodic[k] && strain_rate[static_cast<int>(k)] != 0)
            complain("strain_rate" + axis, "a strain rate along an axis that is not periodic",
                     "0; or set domain/periodic for this axis");
        }
      },
      {"low", "high", "periodic", "strain_rate"});
  p.check(
      [this](const Complain& complain) {
        const bool periodic_everywhere = periodic[0] && periodic[1] && periodic[2];
        const Vec3 shear = shear_rate.vector();
        if (!shear.isZero(0.0) && !periodic_everywhere)
          complain("shear_rate", "shear of a domain that is not periodic along all axes",
                   "one with domain/periodic along x, y and z");
        if (!servo) return;
        if (!periodic_everywhere)
          complain("servo", "a servo of a domain that is not periodic along all axes",
                   "one with domain/periodic along x, y and z");
        const auto targets = servo->targets();
        if (std::ranges::none_of(targets, [](const auto& one) { return one.has_value(); }))
          complain("servo/stress", "no target stress", "at least one, or no servo");
        for (std::size_t k = 0; k < 3; ++k) {
          if (targets[k] && strain_rate[static_cast<int>(k)] != 0)
            complain("servo/stress/" + cell_components[k], "a target along an axis that has a strain rate",
                     "one of them");
          if (targets[k + 3] && shear[static_cast<int>(k)] != 0)
            complain("servo/stress/" + cell_components[k + 3], "a target together with a shear rate", "one of them");
        }
      },
      {"servo", "periodic", "strain_rate", "shear_rate"});
  p.check(
      [this](const Complain& complain) {
        for (std::size_t i = 0; i < open_sides.size(); ++i) {
          const std::string& side = open_sides[i];
          const std::string at = "open_sides/" + std::to_string(i);
          const bool known = side.size() == 2 && (side[0] == '-' || side[0] == '+') && side[1] >= 'x' && side[1] <= 'z';
          if (!known) complain(at, in_quotes(side) + did_you_mean(side, all_sides), any_of(all_sides, ""));
          else if (periodic[static_cast<std::size_t>(side[1] - 'x')])
            complain(at, "a side of a periodic axis", "a side of an axis that is not periodic");
          else if (!(side[0] == '-' ? low : high))
            complain(at, "an open side without a bound",
                     side[0] == '-' ? "an open side with domain/low" : "an open side with domain/high");
        }
      },
      {"low", "high", "periodic", "open_sides"});
}
void BeginDescription::declare(Parameters& p) {
  p.add("from", from).file().required().doc("folder of results of the run whose state is the sample");
  p.add("at", at)
      .one_of({"end", "checkpoint", "frame"})
      .doc("end: the end of a complete run; checkpoint: the last checkpoint of an incomplete one; frame: a frame");
  p.add("frame", frame).at_least(-1).doc("number of the frame, as in frames/000012.h5; -1: the last one");
  p.add("time", time).unit("s").at_least(0).doc("time of the frame in its run, instead of its number; the nearest one");
  p.add("springs", springs)
      .one_of({"keep", "drop"})
      .doc(
          "whether contacts keep their shear and rolling springs; fields of the same name are kept with another law; "
          "frames hold none");
  p.check(
      [this](const Complain& complain) {
        if (at != "frame" && (frame >= 0 || time))
          complain("at", '"' + at + "\" with " + (time ? "a time" : "the number of a frame"), "\"at\": \"frame\"");
        if (frame >= 0 && time) complain("time", "the number and the time of a frame", "one of them");
      },
      {"at", "frame", "time"});
}
void SpecimenDescription::declare(Parameters& p) {
  p.add("low", low).doc("names of the walls at its lower x, y and z sides; \"\": bound of the domain");
  p.add("high", high).doc("names of the walls at its upper x, y and z sides; \"\": bound of the domain");
  p.check([this](const Complain& complain) {
    for (const auto& [key, walls] : {std::pair("low", &low), std::pair("high", &high)})
      if (!walls->empty() && walls->size() != 3)
        complain(key, "a list of " + std::to_string(walls->size()), "a list of 3, for x, y and z");
  });
}
void TimeStepDescription::declare(Parameters& p) {
  p.add("safety", safety).at_least(1e-6).at_most(10).doc("time step over the critical time step");
  p.add("steps_per_impact", steps_per_impact)
      .at_least(0)
      .at_most(1e6)
      .doc("minimum number of steps in an isolated impact of two bodies; 0: no minimum");
  p.add("max_displacement", max_displacement)
      .at_least(1e-6)
      .doc(
          "the time step is so short that no body moves further than this fraction of its radius in a step, and no "
          "wall "
          "further towards a body; default: 0.8 of guards/travel, at least 0.04");
  p.add("value", value)
      .unit("s")
      .symbol("dt")
      .at_least(1e-15)
      .doc(
          "time step; default: safety times the critical time step, or less if steps_per_impact or max_displacement "
          "requires it");
  p.add("allow_unstable", allow_unstable).doc("allow a time step above the critical one");
  p.check([this](const Complain& complain) {
    if (safety > 1 && !allow_unstable)
      complain("safety", "a time step above the critical one", "at most 1, unless allow_unstable is true");
  });
}
double max_displacement(const TimeStepDescription& time_step, const GuardsDescription& guards) {
  constexpr double of_guard = 0.8, usual = 0.04;
  return time_step.max_displacement.value_or(std::max(usual, of_guard * guards.travel));
}
void GuardsDescription::declare(Parameters& p) {
  p.add("overlap", overlap).above(0).doc("maximum overlap, over the smaller radius");
  p.add("travel", travel).above(0).doc("maximum displacement per step, over the radius");
  p.add("energy", energy)
      .above(0)
      .doc(
          "maximum spurious energy gain, as a fraction of the energy; without an energy probe, dissipation may hide a "
          "gain; not checked if the domain deforms, bodies are held or engines apply forces");
}
void EngineDescription::declare(Parameters& p) {
  p.choose(engine);
  p.add("groups", groups).doc("names of the groups of bodies on which it acts; empty: all");
}
void ProbeDescription::declare(Parameters& p) {
  p.choose(probe);
  cadence.declare(p);
  p.add("groups", groups)
      .doc(
          "names of the groups of bodies sampled: these bodies, their contacts with each other and with walls, and "
          "their loads on walls; empty: all");
  p.add("stages", stages).doc("names of the stages sampled; empty: all");
  p.add("frames", frames).doc("whether its fields are written to frames");
}

// ---- stages

void TimeCondition::declare(Parameters& p) {
  p.add("value", value).unit("s").symbol("t").above(0).required().doc("simulated time since the stage began");
}
void StepsCondition::declare(Parameters& p) {
  p.add("value", value).at_least(1).required().doc("steps since the stage began");
}
void DisplacementCondition::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall");
  p.add("axis", axis).one_of(one_axis).doc("axis of the displacement");
  p.add("value", value)
      .unit("m")
      .symbol("u")
      .required()
      .doc("displacement since the stage began, reached in the direction of its sign");
  p.check(
      [this](const Complain& complain) {
        if (value == 0) complain("value", "0 m", "a displacement with a direction");
      },
      {"value"});
}
void UnbalancedForceCondition::declare(Parameters& p) {
  p.add("below", below)
      .above(0)
      .doc(
          "mean net force of a body over the mean contact force; falling grains with few contacts may meet it: "
          "at-rest excludes them");
}
void AtRestCondition::declare(Parameters& p) {
  p.add("below", below)
      .above(0)
      .at_most(0.5)
      .doc(
          "sum of the net forces on bodies over the sum of their weights and all contact forces: 1 for bodies in "
          "flight; contacts must also carry at least half of the weight, or other load");
}
void KineticEnergyCondition::declare(Parameters& p) {
  p.add("below", below).above(0).doc("kinetic energy of all bodies over the amount of elastic energy of all contacts");
}
void VoidRatioCondition::declare(Parameters& p) {
  p.add("below", below).symbol("e").above(0).doc("void ratio of the specimen to fall below");
  p.add("above", above).symbol("e").above(0).doc("void ratio of the specimen to exceed");
  p.check([this](const Complain& complain) {
    if (!below && !above) complain("", "neither below nor above", "at least one of them");
  });
}
void MeanStressCondition::declare(Parameters& p) {
  p.add("below", below).unit("Pa").symbol("p").above(0).doc("mean stress of the specimen to fall below");
  p.add("above", above).unit("Pa").symbol("p").above(0).doc("mean stress of the specimen to exceed");
  p.check([this](const Complain& complain) {
    if (!below && !above) complain("", "neither below nor above", "at least one of them");
  });
}
void StressCondition::declare(Parameters& p) {
  p.add("component", component)
      .one_of({cell_components.begin(), cell_components.end()})
      .doc("component of the stress tensor");
  p.add("value", value).unit("Pa").symbol("sigma").required().doc("stress, compression positive");
  p.add("within", within).above(0).at_most(1).doc("relative tolerance");
}
void PressureCondition::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall");
  p.add("value", value).unit("Pa").symbol("p").at_least(0).required().doc("pressure on the wall, compression positive");
  p.add("within", within).above(0).at_most(1).doc("relative tolerance");
}
void DischargedCondition::declare(Parameters& p) {
  p.add("fraction", fraction).above(0).at_most(1).doc("discharged mass over the mass of all bodies so far");
}
Conditions::Conditions() = default;
Conditions::Conditions(const Conditions&) = default;
Conditions::Conditions(Conditions&&) noexcept = default;
Conditions& Conditions::operator=(const Conditions&) = default;
Conditions& Conditions::operator=(Conditions&&) noexcept = default;
Conditions::~Conditions() = default;
void AllCondition::declare(Parameters& p) { declare_parts(p, of, "conditions that must all hold at the same time"); }
void AnyCondition::declare(Parameters& p) { declare_parts(p, of, "conditions of which at least one must hold"); }

void RampDescription::declare(Parameters& p) {
  p.add("pointer", pointer).required().doc("JSON pointer of the number, e.g. /walls/top/motion/servo/pressure");
  p.add("from", from).required().doc("value at the start, as in the description");
  p.add("to", to).required().doc("value at the end, kept in later stages");
  p.add("duration", duration).unit("s").above(0).required().doc("simulated time from start to end");
  p.add("increments", increments).at_least(1).at_most(100000).doc("number of equal increments");
  p.check(
      [this](const Complain& complain) {
        const auto second = pointer.find('/', 1);
        const std::string section = pointer.empty() ? "" : pointer.substr(1, second - 1);
        if (pointer.empty() || pointer.front() != '/' || second == std::string::npos || !is_changeable(section))
          complain("pointer", in_quotes(pointer) + did_you_mean(section, SceneDescription::changeable()),
                   "a JSON pointer below " + any_of(SceneDescription::changeable(), ""));
        else if (const auto& of_domain = DomainDescription::changeable();
                 section == "domain" && std::ranges::none_of(of_domain, [&](const std::string& key) {
                   return (pointer + '/').starts_with("/domain/" + key + '/');
                 }))
          complain("pointer", in_quotes(pointer), "in the domain " + any_of(of_domain, ""));
        for (const auto& [key, value] : {std::pair("from", &from), std::pair("to", &to)})
          if (!value->is_number() && !value->is_string())
            complain(key, "neither a number nor a text", "a number or a quantity");
      },
      {"pointer", "from", "to"});
}
void GrowthDescription::declare(Parameters& p) {
  p.add("rate", rate)
      .unit("1/s")
      .above(0)
      .required()
      .doc("growth rate of all radii R: dR/dt = rate R; masses and moments of inertia follow at constant density");
}
void ExpectDescription::declare(Parameters& p) {
  p.add("void_ratio", void_ratio).symbol("e").above(0).doc("void ratio of the specimen at the end of the stage");
  p.add("within", within).above(0).doc("accepted difference");
}
void StageDescription::declare(Parameters& p) {
  p.add("name", name).required().doc("unique name");
  p.add("until", until).required().doc("condition that ends the stage");
  p.add("limit", limit).unit("s").above(0).required().doc("simulated time after which the stage fails");
  p.add("typical_time", typical_time)
      .unit("s")
      .above(0)
      .doc("typical simulated duration of a stage that a condition ends; grit check uses it for estimates");
  p.add("change", change)
      .doc("merge patch (RFC 7396) of the description from this stage on; allowed sections: " +
           any_of(SceneDescription::changeable(), "").substr(7) +
           "; in domain only strain_rate, shear_rate and servo; the geometry of a wall is that before its motion, "
           "which is added "
           "to it");
  p.add("ramps", ramps).doc("numbers that change during the stage, one after the other");
  p.add("growth", growth).doc("growth of all bodies during the stage; default: none");
  p.add("expect", expect).doc("state required at the end of the stage");
  p.check(
      [this](const Complain& complain) {
        if (!change.is_object()) return complain("change", "no object", "an object (a merge patch)");
        for (const auto& [section, patch] : change.items()) {
          if (!is_changeable(section))
            complain("change/" + section,
                     "a change of " + in_quotes(section) + did_you_mean(section, SceneDescription::changeable()),
                     any_of(SceneDescription::changeable(), ""));
          if (section != "domain" || !patch.is_object()) continue;
          const auto& of_domain = DomainDescription::changeable();
          for (const auto& [key, _] : patch.items())
            if (std::ranges::find(of_domain, key) == of_domain.end())
              complain("change/domain/" + key, "a change of " + in_quotes(key) + did_you_mean(key, of_domain),
                       any_of(of_domain, ""));
        }
      },
      {"change"});
  p.check(
      [this](const Complain& complain) {
        if (typical_time && *typical_time > limit)
          complain("typical_time", "a time above the limit of the stage", "at most the limit");
      },
      {"typical_time", "limit"});
  p.check(
      [this](const Complain& complain) {
        if (name.empty()) complain("name", "an empty text", "a name");
      },
      {"name"});
}

// ---- output

namespace {

/// Reports a name that is neither one of these nor that of a probe's field, which is found later.
void check_color(const std::string& name, const std::vector<std::string>& names, const char* key,
                 const Complain& complain) {
  const auto slash = name.find('/');
  const bool of_probe = slash != std::string::npos && slash > 0 && slash + 1 < name.size();
  if (!of_probe && std::ranges::find(names, name) == names.end())
    complain(key, in_quotes(name) + did_you_mean(name, names), any_of(names, "") + ", or probe/field");
}

}  // namespace

void PictureDescription::declare(Parameters& p) {
  p.add("x", x).required().doc(
      "series of the horizontal axis: probe/channel or probe/time, e.g. test/shear_displacement");
  p.add("y", y).required().entries(1).doc("series of the vertical axis");
  p.add("view", view).one_of({"xz", "yz", "xy"}).doc("plane in which the bodies are drawn");
  p.add("color", color)
      .doc(
          "colour of the bodies: rotation (about the line of sight), displacement (along the first axis), speed, "
          "radius, "
          "group (of the description), or a field of bodies of a probe, probe/field; of a vector the magnitude, or a "
          "component, probe/field/x");
  p.check(
      [this](const Complain& complain) {
        const std::vector<std::string> names{"rotation", "displacement", "speed", "radius", "group"};
        check_color(color, names, "color", complain);
      },
      {"color"});
}
void ColorScaleDescription::declare(Parameters& p) {
  p.add("of", of).required().doc(
      "colour of bodies (rotation, displacement, speed, radius), or field of a probe on maps or bodies: probe/field, "
      "or "
      "probe/field/xz for one component");
  p.add("low", low).doc("value of the first colour, in SI; default: from the values");
  p.add("high", high).doc("value of the last colour, in SI; default: from the values");
  p.check(
      [this](const Complain& complain) {
        const std::vector<std::string> names{"rotation", "displacement", "speed", "radius"};
        check_color(of, names, "of", complain);
      },
      {"of"});
  p.check(
      [this](const Complain& complain) {
        if (!low && !high) complain("high", "neither low nor high", "one of them, or both");
        if (low && high && !(*low < *high)) complain("high", "a value that is not above low", "above low");
      },
      {"low", "high"});
}
void check_channel(const std::string& name, const char* key, const Complain& complain) {
  const auto slash = name.find('/');
  if (!name.empty() && (slash == 0 || slash == std::string::npos || slash + 1 == name.size()))
    complain(key, '"' + name + '"', "probe/channel, e.g. \"test/stress_ratio\"");
}

void ReferenceCurve::declare(Parameters& p) {
  p.add("file", file).file().required().doc("CSV file with a header line");
  p.add("x", x).required().doc("column of the abscissa, in the unit of the channel");
  p.add("y", y).required().doc("column of the ordinate, in the unit of the channel");
}
void ReferenceDescription::declare(Parameters& p) {
  p.add("of", of).required().doc("series to compare: probe/channel, e.g. test/stress_ratio");
  p.add("against", against).doc("series of the abscissa of a curve, of the same probe; default: time");
  p.add("value", value).doc("reference value, in the unit of the series");
  p.add("curve", curve).doc("reference curve");
  p.check([this](const Complain& complain) {
    check_channel(of, "of", complain), check_channel(against, "against", complain);
    if (!against.empty() && against.substr(0, against.find('/')) != of.substr(0, of.find('/')))
      complain("against", '"' + against + '"', "a series of the same probe as " + of);
    if (value.has_value() == curve.has_value())
      complain("curve", value ? "a value and a curve" : "neither a value nor a curve", "one of them");
  });
}
void FramesDescription::declare(Parameters& p) {
  Cadence::declare(p);
  p.add("formats", formats)
      .one_of({"vtk", "lammps-dump"})
      .doc(
          "formats in which frames are written too: vtk for programs that use VTK, lammps-dump for OVITO and others; "
          "HDF5 files with an XDMF index are always written");
}
void OutputDescription::declare(Parameters& p) {
  p.add("frames", frames)
      .doc(
          "when frames are written; with an interval also at the start and at the end of each stage, with formats but "
          "no interval at the end of the run; default: never");
  p.add("checkpoint_every", checkpoint_every)
      .unit("s")
      .at_least(0)
      .doc(
          "wall-clock interval between checkpoints, from which --resume continues; they take at most 1 % of the run "
          "time; 0: only if the run is interrupted");
  p.add("picture", picture).doc("curves and view of the bodies, drawn at the end");
  p.add("color_scales", color_scales).doc("ends of colour scales, in pictures and on the page");
  p.add("references", references)
      .doc("references for curves of the report, by name: measured, published or calculated");
  p.add("summary", summary).doc("series of which the largest and last values are printed at the end: probe/channel");
}

// ---- the scene

SceneDescription::SceneDescription(const Registry& registry) : contacts(registry), registry_(&registry) {}

const std::vector<std::string>& SceneDescription::changeable() {
  static const std::vector<std::string> sections{"materials", "interfaces", "walls", "engines",
                                                 "domain",    "time_step",  "guards"};
  return sections;
}

std::shared_ptr<ContactLaw> SceneDescription::law_to_read() const {
  return contacts.type().empty() ? nullptr : contacts.make();
}

void SceneDescription::declare_section(const std::string& section, Parameters& p) {
  if (section == "materials") {
    MapTarget target;
    // One law for all materials, made when the first is read.
    const auto law = std::make_shared<std::shared_ptr<ContactLaw>>();
    target.names = [this] { return keys(materials); };
    target.clear = [this, law] { materials.clear(), *law = nullptr; };
    target.declare = [this](const std::string& name, Parameters& inner) {
      materials.at(name).declare(name, nullptr, inner);
    };
    target.insert = [this, law](const std::string& name, Parameters& inner) {
      if (!*law) *law = law_to_read();
      (materials[name] = {}).declare(name, law->get(), inner);
    };
    p.add_target("materials", std::move(target))
        .required()
        .entries(1)
        .doc("materials by name: density and the parameters of the contact law");
  }
  if (section == "interfaces") {
    MapTarget target;
    const auto law = std::make_shared<std::shared_ptr<ContactLaw>>();
    target.names = [this] { return units_of("interfaces"); };
    target.clear = [this, law] { interfaces.clear(), *law = nullptr; };
    target.declare = [this](const std::string& name, Parameters& inner) {
      find_interface(name)->declare(nullptr, inner);
    };
    target.insert = [this, law](const std::string& name, Parameters& inner) {
      if (!*law) *law = law_to_read();
      interfaces.emplace_back(name).declare(law->get(), inner);
    };
    p.add_target("interfaces", std::move(target)).doc("parameters of contacts between two materials, by \"one+other\"");
  }
  if (section == "domain") p.add("domain", domain).doc("bounds of the simulated region");
  if (section == "walls")
    p.add("walls", walls, [this](const std::string&) { return WallDescription(*registry_); }).doc("walls by name");
  if (section == "engines")
    p.add("engines", engines, [this](const std::string&) {
       return EngineDescription(*registry_);
     }).doc("actions on the bodies other than contacts, by name");
  if (section == "time_step") p.add("time_step", time_step).doc("time step");
  if (section == "guards") p.add("guards", guards).doc("limits at which a run stops");
}

bool SceneDescription::has_names(const std::string& section) {
  return section == "materials" || section == "interfaces" || section == "walls" || section == "engines";
}

bool SceneDescription::declare_unit(const std::string& section, const std::string& name, ContactLaw* law,
                                    Parameters& p) {
  if (section == "materials") return materials[name].declare(name, law, p), true;
  if (section == "interfaces") {
    InterfaceDescription* const known = find_interface(name);
    return (known != nullptr ? *known : interfaces.emplace_back(name)).declare(law, p), true;
  }
  if (section == "walls") return walls.try_emplace(name, *registry_).first->second.declare(p), true;
  if (section == "engines") return engines.try_emplace(name, *registry_).first->second.declare(p), true;
  if (section == "domain") return domain.declare(p), true;
  if (section == "time_step") return time_step.declare(p), true;
  if (section == "guards") return guards.declare(p), true;
  return false;
}

std::vector<std::string> SceneDescription::units_of(const std::string& section) const {
  if (section == "materials") return keys(materials);
  if (section == "walls") return keys(walls);
  if (section == "engines") return keys(engines);
  if (section != "interfaces") return {""};
  std::vector<std::string> names;
  for (const InterfaceDescription& one : interfaces) names.push_back(one.name());
  return names;
}

bool SceneDescription::has_unit(const std::string& section, const std::string& name) const {
  const auto names = units_of(section);
  return std::ranges::find(names, name) != names.end();
}

std::vector<std::string> SceneDescription::names_of_materials() const {
  std::set<std::string> all;
  for (const auto& [name, _] : materials) all.insert(name);
  for (const StageDescription& stage : stages)
    if (const auto added = stage.change.find("materials"); added != stage.change.end() && added->is_object())
      for (const auto& [name, _] : added->items()) all.insert(name);
  return {all.begin(), all.end()};
}

InterfaceDescription* SceneDescription::find_interface(const std::string& name) {
  const auto found =
      std::ranges::find_if(interfaces, [&](const InterfaceDescription& one) { return one.is_named(name); });
  return found == interfaces.end() ? nullptr : &*found;
}

void SceneDescription::check_together(const Complain& complain) const {
  check_number_of_materials(*this, complain);
  check_interfaces(*this, complain);
  check_materials_of_bodies(*this, complain);
  check_motions(*this, complain);
  check_growth(*this, complain);
  check_materials_of_walls(*this, complain);
  check_groups(*this, complain);
  check_followers(*this, complain);
  check_shear(*this, complain);
}

void SceneDescription::declare(Parameters& p) {
  p.add("title", title).doc("title of the run, one line");
  p.add("seed", seed).at_least(0).doc("seed of the random numbers");
  p.add("contacts", contacts).required().doc("contact law");
  declare_section("materials", p);
  declare_section("interfaces", p);
  declare_section("domain", p);
  p.add("bodies", bodies, [this](const std::string&) { return BodiesDescription(*registry_); })
      .required()
      .entries(1)
      .doc("groups of bodies by name");
  p.add("begin", begin).doc("prepared sample from which the run begins; default: none");
  declare_section("walls", p);
  declare_section("engines", p);
  p.add("specimen", specimen).doc("region over which averages are taken");
  declare_section("time_step", p);
  declare_section("guards", p);
  p.add("stages", stages).required().entries(1).doc("stages of the run, in order");
  p.add("probes", probes, [this](const std::string&) {
     return ProbeDescription(*registry_);
   }).doc("measurements, by name");
  p.add("output", output).doc("frames, checkpoints, picture, references, summary");
  p.resolved_before({"scenario", "extends"});
  // Bodies are placed beside those of a sample when the first stage begins.
  p.when_read([this] {
    if (!begin || stages.empty()) return;
    for (auto& [name, group] : bodies)
      if (!group.is_from_sample() && group.stage.empty()) group.stage = stages.front().name;
  });

  p.check_names([this](const Complain& complain) { check_number_of_materials(*this, complain); });
  p.check_names([this](const Complain& complain) { check_number_of_groups(*this, complain); });
  p.check_names([this](const Complain& complain) { check_interfaces(*this, complain); });
  p.check_names([this](const Complain& complain) { check_materials_of_bodies(*this, complain); });
  p.check([this](const Complain& complain) { check_motions(*this, complain); }, {"bodies", "engines"});
  p.check([this](const Complain& complain) { check_growth(*this, complain); }, {"engines", "stages"});
  p.check_names([this](const Complain& complain) { check_materials_of_walls(*this, complain); });
  p.check_names([this](const Complain& complain) { check_groups(*this, complain); });
  p.check([this](const Complain& complain) { check_sample(*this, complain); }, {"bodies", "begin"});
  p.check_names([this](const Complain& complain) { check_followers(*this, complain); });
  p.check([this](const Complain& complain) { check_shear(*this, complain); }, {"domain", "walls", "bodies"});
  p.check_names([this](const Complain& complain) {
    const References known("wall", keys(walls), complain);
    for (const auto& [key, side] : {std::pair("low", &specimen.low), std::pair("high", &specimen.high)})
      for (std::size_t k = 0; k < side->size(); ++k)
        if (!(*side)[k].empty()) known.check("specimen/" + std::string(key) + '/' + std::to_string(k), (*side)[k]);
  });
  p.check_names([this](const Complain& complain) {
    const References known("wall", keys(walls), complain);
    for (std::size_t i = 0; i < stages.size(); ++i)
      check_walls_of(stages[i].until, "stages/" + std::to_string(i) + "/until", known);
    const auto check_cadence = [&](const std::string& key, const Cadence& cadence) {
      if (cadence.every_displacement) known.check(key + "/every_displacement/wall", cadence.every_displacement->wall);
    };
    for (const auto& [name, probe] : probes) check_cadence("probes/" + name, probe.cadence);
    check_cadence("output/frames", output.frames);
  });
  p.check_names([this](const Complain& complain) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < stages.size(); ++i)
      if (!names.insert(stages[i].name).second)
        complain("stages/" + std::to_string(i) + "/name", in_quotes(stages[i].name) + ", the name of an earlier stage",
                 "a unique name");
  });
  p.check_names([this](const Complain& complain) {
    std::vector<std::string> names;
    for (const auto& stage : stages) names.push_back(stage.name);
    const References known("stage", names, complain);
    for (const auto& [name, group] : bodies)
      if (!group.stage.empty()) known.check("bodies/" + name + "/stage", group.stage);
    for (const auto& [name, probe] : probes)
      for (std::size_t i = 0; i < probe.stages.size(); ++i)
        known.check("probes/" + name + "/stages/" + std::to_string(i), probe.stages[i]);
  });
}

}  // namespace grit
