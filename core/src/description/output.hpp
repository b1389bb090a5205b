// Frames, checkpoints, pictures, references and the summary.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "description/cadence.hpp"
#include "grit/parameters.hpp"

namespace grit {

struct PictureDescription {
  std::string x;
  std::vector<std::string> y;
  std::string view = "xz";
  std::string color = "rotation";
  void declare(Parameters& p);
};
/// Ends of a colour scale, in SI.
struct ColorScaleDescription {
  std::string of;
  std::optional<double> low, high;
  void declare(Parameters& p);
};
/// Reports a name that is not "probe/channel"; "" is allowed.
void check_channel(const std::string& name, const char* key, const Complain& complain);
/// A reference curve: two columns of a CSV file, SI.
struct ReferenceCurve {
  std::string file, x, y;
  void declare(Parameters& p);
};
/// A reference for a curve of the run: a value or a curve.
struct ReferenceDescription {
  std::string of, against;
  std::optional<double> value;
  std::optional<ReferenceCurve> curve;
  void declare(Parameters& p);
};
struct FramesDescription : Cadence {
  std::vector<std::string> formats;  ///< beside HDF5
  bool never() const { return Cadence::never() && formats.empty(); }
  void declare(Parameters& p);
};
struct OutputDescription {
  FramesDescription frames;
  double checkpoint_every = 600;  ///< s of wall clock
  std::optional<PictureDescription> picture;
  std::deque<ColorScaleDescription> color_scales;
  std::map<std::string, ReferenceDescription> references;
  std::vector<std::string> summary;
  void declare(Parameters& p);
};

}  // namespace grit
