#include "output/vtk.hpp"

#include <spdlog/fmt/fmt.h>

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "format/base64.hpp"
#include "output/body_columns.hpp"

namespace grit {
namespace {

template <class T>
constexpr const char* type_of() {
  if constexpr (std::same_as<T, double>) return "Float64";
  else if constexpr (std::same_as<T, std::int64_t>) return "Int64";
  else {
    static_assert(std::same_as<T, std::int32_t>);
    return "Int32";
  }
}

/// Base64 of the size in bytes and the numbers.
template <class T>
std::string array(const std::string& name, std::size_t width, const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::vector<unsigned char> bytes(sizeof(size) + size);
  std::memcpy(bytes.data(), &size, sizeof(size));
  if (size > 0) std::memcpy(bytes.data() + sizeof(size), values.data(), size);
  return fmt::format(
      "    <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n",
      type_of<T>(), name, width, base64(std::move(bytes)));
}

/// Cells of `corners` points each, which follow each other.
std::string cells(const char* tag, std::size_t count, std::size_t corners) {
  std::vector<std::int64_t> points(count * corners), ends(count);
  std::iota(points.begin(), points.end(), 0);
  for (std::size_t i = 0; i < count; ++i) ends[i] = static_cast<std::int64_t>((i + 1) * corners);
  return fmt::format("   <{}>\n{}{}   </{}>\n", tag, array("connectivity", 1, points), array("offsets", 1, ends), tag);
}

std::string vtk_file(const std::string& type, const std::string& content) {
  constexpr const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"{1}\" header_type=\"UInt64\">\n "
      "<{0}>\n{2} </{0}>\n</VTKFile>\n",
      type, order, content);
}

std::string poly_data(const std::vector<double>& points, std::size_t vertices, std::size_t polygons,
                      const std::string& rest) {
  return vtk_file("PolyData", fmt::format("  <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" "
                                          "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n   <Points>\n{}   </Points>\n{}"
                                          "  </Piece>\n",
                                          points.size() / 3, vertices, polygons, array("position", 3, points), rest));
}

}  // namespace

std::string vtk_grains(const World& world, std::span<const WallShape>) {
  std::vector<double> points;
  std::string columns;
  put_body_columns(world, group_index(world), [&]<class T>(const Channel& what, std::size_t width, const T& values) {
    if constexpr (std::same_as<T, std::vector<double>>)
      if (what.name == "position") return void(points = values);
    columns += array(what.name, width, values);
  });
  const std::size_t count = points.size() / 3;
  return poly_data(points, count, 0, "   <PointData>\n" + columns + "   </PointData>\n" + cells("Verts", count, 1));
}

std::string vtk_walls(const World& world, std::span<const WallShape> shapes) {
  std::vector<double> points;
  std::vector<std::int32_t> wall_of;
  const auto walls = world.walls();
  for (std::size_t wall = 0; wall < walls.size(); ++wall) {
    const auto corners = triangles_of(walls[wall], shapes, world.stage());
    for (const Vec3& corner : corners) points.insert(points.end(), corner.begin(), corner.end());
    wall_of.insert(wall_of.end(), corners.size() / 3, static_cast<std::int32_t>(wall));
  }
  const std::size_t count = wall_of.size();
  return poly_data(points, 0, count,
                   "   <CellData>\n" + array("wall", 1, wall_of) + "   </CellData>\n" + cells("Polys", count, 3));
}

std::string vtk_collection(std::span<const TimedFile> files) {
  std::string text;
  for (const auto& [time, path] : files) text += fmt::format("  <DataSet timestep=\"{}\" file=\"{}\"/>\n", time, path);
  return vtk_file("Collection", text);
}

}  // namespace grit
