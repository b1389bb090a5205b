#include "output/frame_size.hpp"

#include <algorithm>

#include "output/group_index.hpp"

namespace grit {
namespace {

// Of a dataset with its attributes; measured on small frames.
constexpr double bytes_per_dataset = 1000;
constexpr double datasets = 25;  // without those of probes
constexpr double bytes_per_contact = 13 * sizeof(double);
constexpr double bytes_per_triangle = 9 * sizeof(double);
constexpr double bytes_per_dump_line = 200;
constexpr double base64 = 4.0 / 3.0;

/// Of the columns of bodies, as put_body_columns() writes them.
double bytes_per_body(const World& world) {
  double bytes = 2 * 8 + 3 * 24 + 4;  // id, radius; position, velocity, spin; material
  if (!world.clump_of().empty()) bytes += 8;
  if (group_index(world).names.size() > 1) bytes += 4;
  if (!world.rotations().empty()) bytes += 24;
  if (!world.displacements().empty()) bytes += 24;
  return bytes;
}

}  // namespace

double frame_bytes(const World& world, const FrameContent& content, std::span<const FieldGroup> fields,
                   std::span<const std::string> formats) {
  const double bodies = content.bodies * bytes_per_body(world),
               walls = static_cast<double>(content.triangles) * bytes_per_triangle;
  double bytes = datasets * bytes_per_dataset + bodies + content.contacts * bytes_per_contact + walls;
  for (const FieldGroup& probe : fields)
    for (const Field& field : probe.fields)
      bytes += bytes_per_dataset + sizeof(double) * static_cast<double>(field.values.size());
  const auto has = [&](const char* format) { return std::ranges::find(formats, format) != formats.end(); };
  if (has("vtk")) bytes += base64 * (bodies + 2 * 8 * content.bodies + walls);  // with the cells of the points
  if (has("lammps-dump")) bytes += bytes_per_dump_line * content.bodies;
  return bytes;
}

}  // namespace grit
