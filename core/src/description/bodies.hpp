// Groups of bodies and their sources.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/regions.hpp"
#include "description/sizes.hpp"
#include "grit/parameters.hpp"
#include "grit/vec.hpp"
#include "plugins/component.hpp"

namespace grit {

/// Equal bodies at regular positions.
struct LatticeSource {
  static constexpr const char* type_name = "lattice";
  static constexpr const char* type_doc = "equal bodies on a crystal lattice";
  std::string kind = "simple-cubic";
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  double diameter = 0;            ///< m
  std::optional<double> spacing;  ///< of nearest neighbours, m; none: the diameter
  void declare(Parameters& p);
};
/// A text file with a body in each line, written by grit or another code.
struct FileSource {
  static constexpr const char* type_name = "file";
  static constexpr const char* type_doc = "bodies from a text file";
  /// What columns may hold: x, y, z, r (radius), d (diameter), velocity, spin, type, id; - is skipped.
  static const std::vector<std::string>& column_names();
  std::string path, format = "auto";
  std::vector<std::string> columns;  ///< empty: those of the format
  std::int64_t header_lines = 0;
  double scale = 1;             ///< m
  std::string particle_type;    ///< empty: all
  std::int64_t time_step = -1;  ///< below 0: the last one
  void declare(Parameters& p);
};
struct ListedBody {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero(), orientation = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct ListSource {
  static constexpr const char* type_name = "list";
  static constexpr const char* type_doc = "bodies one by one";
  std::deque<ListedBody> bodies;
  void declare(Parameters& p);
};
/// The bodies of the group of this name in the sample from which the run begins.
struct SampleSource {
  static constexpr const char* type_name = "sample";
  static constexpr const char* type_doc =
      "the bodies of the group of this name in the sample that /begin names, with their positions and velocities";
  void declare(Parameters&) {}
};
/// What a cloud fills.
struct CloudRegion {
  OneOf<BoxRegion, SphereRegion, CylinderRegion, MeshRegion> is{"region"};
  void declare(Parameters& p) { p.choose(is); }
};
/// Bodies at random positions without overlap.
struct CloudSource {
  static constexpr const char* type_name = "cloud";
  static constexpr const char* type_doc = "bodies at random positions without overlap";
  std::optional<Vec3> low, high;      ///< of a box
  std::optional<CloudRegion> region;  ///< instead
  std::int64_t count = 0;
  Sizes sizes{"size distribution"};
  std::string plane_normal = "none";
  void declare(Parameters& p);
};
/// Bodies that enter one after the other during the run.
struct StreamSource {
  static constexpr const char* type_name = "stream";
  static constexpr const char* type_doc = "bodies that enter through a region at a rate, during the run";
  OneOf<RectangleRegion, DiscRegion, BoxRegion> region{"region"};
  std::optional<double> number_rate, mass_rate;  ///< 1/s, kg/s
  Sizes sizes{"size distribution"};
  std::int64_t count = 0;            ///< limit; 0: none
  std::optional<double> mass, time;  ///< limits [kg, s]
  void declare(Parameters& p);
};

struct BodiesDescription {
  Component<BodyKind> kind;
  std::string material;
  std::string stage;  ///< at the start of which they appear; empty: the start of the run
  Vec3 velocity = Vec3::Zero();
  static constexpr double usual_overlap = 0.01;
  double overlap = usual_overlap;  ///< of the smaller radius
  OneOf<CloudSource, FileSource, LatticeSource, ListSource, StreamSource, SampleSource> source{"source of bodies"};
  bool is_from_sample() const { return std::holds_alternative<SampleSource>(source.value()); }
  explicit BodiesDescription(const Registry& registry);
  void declare(Parameters& p);
};

}  // namespace grit
