// Time to find the contacts of 4096 spheres near a wall. A new geometry needs a line in `walls`.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "dense.hpp"

namespace grit::bench {
namespace {

/// A file that is removed at the end of the program.
class Scratch {
 public:
  explicit Scratch(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "-" + name)) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The square [0, 1] × [0, 1] m at z = 0 in 3200 triangles.
const std::filesystem::path& sheet_of_triangles() {
  static const Scratch sheet("bench-sheet.stl");
  std::ofstream out(sheet.path());
  out << "solid sheet\n";
  const auto facet = [&out](std::array<Vec3, 3> corners) {
    out << "facet normal 0 0 1\nouter loop\n";
    for (const Vec3& at : corners) out << "vertex " << at.x() << ' ' << at.y() << ' ' << at.z() << '\n';
    out << "endloop\nendfacet\n";
  };
  constexpr int cells = 40;
  const auto corner = [](int i, int j) {
    return Vec3(static_cast<double>(i) / cells, static_cast<double>(j) / cells, 0);
  };
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      facet({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
      facet({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  out << "endsolid sheet\n";
  return sheet.path();
}

void contact(benchmark::State& state, Description wall) {
  if (wall["type"] == "mesh") wall["path"] = sheet_of_triangles().string();
  auto plain = test::description("linear-rolling", {{"contact_modulus", 1e8}}, {{Vec3::Zero(), 1e-3}});
  plain["walls"]["wall"] = wall;
  plain["walls"]["wall"]["material"] = "grain";
  const Scene scene = test::scene_of(plain);
  const LiveScene live(scene);
  const Geometry& geometry = *live.components().geometries.at("wall");
  // A layer about z = 0, half of which overlaps the face, slightly larger than the square [0, 1] × [0, 1] m.
  Random random(1);
  std::vector<Sphere> spheres;
  for (std::uint32_t i = 0; i < 4096; ++i)
    spheres.push_back(
        {Vec3(1.1 * random.uniform() - 0.05, 1.1 * random.uniform() - 0.05, 0.008 + 0.004 * random.uniform()), 0.01,
         i});
  std::vector<SurfaceContact> contacts;
  for (auto _ : state) {
    contacts.clear();
    geometry.find_contacts({}, spheres, contacts);
    benchmark::DoNotOptimize(contacts.data());
  }
  state.counters["spheres_per_s"] =
      benchmark::Counter(static_cast<double>(spheres.size()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["touching_fraction"] = static_cast<double>(contacts.size()) / static_cast<double>(spheres.size());
}

[[maybe_unused]] const bool registered = [] {
  const std::pair<const char*, Description> walls[] = {
      {"plane", {{"type", "plane"}}},
      {"rectangle", {{"type", "rectangle"}, {"corner", {0, 0, 0}}, {"edge_a", {1, 0, 0}}, {"edge_b", {0, 1, 0}}}},
      {"saw-tooth",
       {{"type", "saw-tooth"},
        {"corner", {0, 0, 0}},
        {"edge_a", {1, 0, 0}},
        {"edge_b", {0, 1, 0}},
        {"depth", 0.01},
        {"spacing", 0.02}}},
      {"sinusoidal",
       {{"type", "sinusoidal"},
        {"corner", {0, 0, 0}},
        {"edge_a", {1, 0, 0}},
        {"edge_b", {0, 1, 0}},
        {"depth", 0.01},
        {"wavelength", 0.1}}},
      // Its lowest line is y = 0.5, z = 0; the layer meets it over 0.035 m to either side.
      {"cylinder", {{"type", "cylinder"}, {"start", {0, 0.5, 0.1}}, {"end", {1, 0.5, 0.1}}, {"radius", 0.1}}},
      // As the cylinder, slightly wider at its end.
      {"cone",
       {{"type", "cone"},
        {"start", {0, 0.5, 0.1}},
        {"end", {1, 0.5, 0.101}},
        {"start_radius", 0.1},
        {"end_radius", 0.101}}},
      {"mesh", {{"type", "mesh"}, {"scale", 1}, {"open", true}}},
      {"container", {{"type", "box"}, {"low", {0, 0, 0}}, {"high", {1, 1, 1}}}},
      {"block", {{"type", "box"}, {"low", {0, 0, -1}}, {"high", {1, 1, 0}}, {"inside", false}}},
  };
  for (const auto& [name, wall] : walls)
    benchmark::RegisterBenchmark((std::string("touch/") + name).c_str(),
                                 [wall = wall](benchmark::State& state) { contact(state, wall); });
  return true;
}();

}  // namespace
}  // namespace grit::bench
