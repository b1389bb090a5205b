#include "description/bodies.hpp"

#include <algorithm>
#include <cstddef>

#include "description/axes.hpp"

namespace grit {
namespace {

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

}  // namespace

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

}  // namespace grit
