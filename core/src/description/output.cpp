#include "description/output.hpp"

#include <algorithm>

#include "format/names.hpp"
#include "grit/toolkit/did_you_mean.hpp"

namespace grit {
namespace {

/// Reports a name that is neither one of these nor that of a probe's field, which is found later.
void check_color(const std::string& name, const std::vector<std::string>& names, const char* key,
                 const Complain& complain) {
  const auto slash = name.find('/');
  const bool of_probe = slash != std::string::npos && slash > 0 && slash + 1 < name.size();
  if (!of_probe && std::ranges::find(names, name) == names.end())
    complain(key, in_quotes(name) + did_you_mean(name, names), "one of " + listed(names) + ", or probe/field");
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

}  // namespace grit
