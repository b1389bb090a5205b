#include "bodies/clump_body.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bodies/clump_shape.hpp"
#include "bodies/packing_file.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

constexpr std::size_t most_faults = 10;
constexpr const char* lines_of_file = "a file with one line per sphere: x y z radius";

struct Balls {
  std::vector<Ball> operator()(std::monostate) const { return {}; }
  std::vector<Ball> operator()(const ListedSpheres& listed) const {
    std::vector<Ball> balls;
    for (const auto& one : listed.spheres)
      balls.push_back({one.position.x(), one.position.y(), one.position.z(), one.radius});
    return balls;
  }
  std::vector<Ball> operator()(const SpheresOfFile& file) const { return read_packing(file.path); }
  std::vector<Ball> operator()(const RodSpheres& rod) const {
    std::vector<Ball> balls;
    for (std::int64_t k = 0; k < rod.count; ++k) balls.push_back({2 * rod.spacing * static_cast<double>(k), 0, 0, 1});
    return balls;
  }
  /// Fitted by search to the clumps of A. Grabowski (Gdańsk 2024): four spheres of 0.5 to 0.6 of the clump's diameter;
  /// volume of the smallest enclosing sphere over that of the clump 2.07, of the convex hull over that of the
  /// clump 1.16, longest over shortest diameter 1.50. This shape has 2.09, 1.14 and 1.49.
  std::vector<Ball> operator()(const AsymmetricSpheres&) const {
    return {{-0.1996, -0.4369, -0.0408, 0.5179},
            {0.0197, 0.3875, 0.2250, 0.5514},
            {-0.0320, 0.2202, -0.4433, 0.5038},
            {0.2350, -0.3590, 0.2188, 0.5183}};
  }
};

}  // namespace

void ClumpSphereDescription::declare(Parameters& p) {
  p.add("position", position).unit("m").required().doc("centre");
  p.add("radius", radius).unit("m").symbol("R").above(0).required().doc("radius");
}
void ListedSpheres::declare(Parameters& p) {
  p.add("spheres", spheres)
      .required()
      .entries(1)
      .doc("list of spheres; only proportions count, except with sizes of type shape");
}
void SpheresOfFile::declare(Parameters& p) {
  p.add("path", path)
      .file()
      .required()
      .doc("text file with one line per sphere: x y z radius; # starts a comment. Other formats as in the source file");
  p.add("scale", scale)
      .unit("m")
      .above(0)
      .doc("length of one file unit, for sizes of type shape; else only proportions count");
}
void RodSpheres::declare(Parameters& p) {
  p.add("count", count).at_least(2).at_most(64).doc("number of equal spheres in a row");
  p.add("spacing", spacing).above(0).below(1).doc("distance of neighbouring centres over the diameter of the spheres");
}

void ClumpBody::declare(Parameters& p) { p.add("shape", spheres_).required().doc("spheres of the clump, to scale"); }

void ClumpBody::prepare() {
  const auto* file = std::get_if<SpheresOfFile>(&spheres_.value());
  try {
    balls_ = std::visit(Balls{}, spheres_.value());
  } catch (const DescriptionError& error) {
    std::vector<ParameterError::Fault> faults;
    for (const Problem& problem : error.problems())
      faults.push_back({"shape/path", DescriptionError({problem}).what(), lines_of_file});
    throw ParameterError(std::move(faults));
  } catch (const FileError& error) {
    throw ParameterError({{"shape/path", error.what(), lines_of_file}});
  }
  unit_ = file != nullptr ? file->scale : spheres_.type() == ListedSpheres::type_name ? 1 : 0;
  const auto defects = clump_defects(balls_);
  if (defects.empty()) return;
  const bool is_rod = spheres_.type() == RodSpheres::type_name;  // has one fault
  const std::string key = file != nullptr ? "shape/path"
                          : is_rod        ? "shape/spacing"
                                          : "shape/spheres",
                    before = file != nullptr ? file->path + ": " : "";
  const std::size_t shown = is_rod ? 1 : std::min(defects.size(), most_faults);
  std::vector<ParameterError::Fault> faults;
  for (const ClumpDefect& defect : std::span(defects).first(shown)) {
    const bool has_own_key = defect.sphere && key == "shape/spheres";
    faults.push_back(
        {has_own_key ? key + '/' + std::to_string(*defect.sphere) : key, before + defect.found, defect.allowed});
  }
  if (const std::size_t more = defects.size() - shown; more > 0 && !is_rod)
    faults.push_back({key, before + std::to_string(more) + " more spheres that are inside another or not connected",
                      "spheres that are connected, and of which none is inside another"});
  throw ParameterError(std::move(faults));
}

const ClumpShape* ClumpBody::clump() const {
  if (!shape_) {
    shape_ = make_clump_shape(balls_);
    shape_->given_radius *= unit_;
  }
  return &*shape_;
}

const PluginInfo& clump_body() {
  static const PluginInfo info = [] {
    PluginInfo clump;
    clump.kind = "body", clump.name = "clump", clump.version = "1.0.0";
    clump.doc = "rigid clump of overlapping spheres; its radius is that of the enclosing sphere";
    clump.make_body = []() -> BodyKind* { return new ClumpBody; };
    return clump;
  }();
  return info;
}

}  // namespace grit
