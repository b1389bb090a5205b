// The built-in body kind "clump".
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "bodies/clump_shape.hpp"
#include "grit/body_kind.hpp"
#include "grit/plugin.hpp"

namespace grit {

struct ClumpSphereDescription {
  Vec3 position = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct ListedSpheres {
  static constexpr const char* type_name = "list";
  static constexpr const char* type_doc = "spheres one by one";
  std::deque<ClumpSphereDescription> spheres;
  void declare(Parameters& p);
};
struct SpheresOfFile {
  static constexpr const char* type_name = "file";
  static constexpr const char* type_doc = "spheres from a text file";
  std::string path;
  double scale = 1;  ///< m
  void declare(Parameters& p);
};
struct RodSpheres {
  static constexpr const char* type_name = "rod";
  static constexpr const char* type_doc = "equal spheres in a straight row, each overlapping the next";
  std::int64_t count = 2;
  double spacing = 0.5;
  void declare(Parameters& p);
};
struct AsymmetricSpheres {
  static constexpr const char* type_name = "asymmetric";
  static constexpr const char* type_doc =
      "four spheres of unequal size without an axis of symmetry, like a grain of sand";
  void declare(Parameters&) {}
};

/// Overlapping spheres that are fixed to each other. The shape gives their relative positions and sizes; the grains
/// give the size of each clump.
class ClumpBody : public BodyKind {
 public:
  void declare(Parameters& p) override;
  /// Throws ParameterError for spheres that cannot be read or are not a clump.
  void prepare() override;
  const ClumpShape* clump() const override;
  double volume(double radius) const override { return clump()->volume * radius * radius * radius; }
  /// The smallest principal moment of inertia.
  double inertia(double radius, double mass) const override { return clump()->inertia[0] * mass * radius * radius; }

 private:
  OneOf<AsymmetricSpheres, RodSpheres, ListedSpheres, SpheresOfFile> spheres_{"shape of a clump"};
  std::vector<Ball> balls_;
  double unit_ = 0;                          // of the spheres, m; 0: only their proportions count
  mutable std::optional<ClumpShape> shape_;  // integrated on demand
};

/// For Registry::add().
const PluginInfo& clump_body();

}  // namespace grit
