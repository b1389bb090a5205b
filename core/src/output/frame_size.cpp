#include "output/frame_size.hpp"

#include <algorithm>

#include "output/group_index.hpp"

namespace grit {
namespace {

// Estimates, without numbers of bodies, contacts, triangles and fields.
constexpr double bytes_of_empty_frame = 9e3, bytes_of_wall = 3.2e3, bytes_of_field = 400;
constexpr double least_bytes_of_empty_frame = 8e3;
constexpr double bytes_per_contact = 13 * sizeof(double);
constexpr double bytes_per_triangle = 9 * sizeof(double);
constexpr double bytes_per_dump_line = 200;
constexpr double base64_growth = 4.0 / 3.0;

// Of the columns of bodies, as put_body_columns() writes them.
constexpr double bytes_of_columns_alone = 2 * 8 + 3 * 24 + 4;  // id, radius; position, velocity, spin; material
constexpr double bytes_of_vector_column = 24;

double bytes_of_columns(const World& world) {
  double bytes = bytes_of_columns_alone;
  if (!world.clump_of().empty()) bytes += 8;
  if (group_index(world).names.size() > 1) bytes += 4;
  if (!world.rotations().empty()) bytes += bytes_of_vector_column;
  if (!world.displacements().empty()) bytes += bytes_of_vector_column;
  return bytes;
}

}  // namespace

double frame_bytes(const World& world, const FrameContent& content, std::span<const FieldGroup> fields,
                   std::span<const std::string> formats) {
  const double bodies = content.bodies * bytes_of_columns(world),
               walls = static_cast<double>(content.triangles) * bytes_per_triangle;
  double bytes = bytes_of_empty_frame + bodies + content.contacts * bytes_per_contact +
                 static_cast<double>(world.walls().size()) * bytes_of_wall + walls;
  for (const FieldGroup& probe : fields)
    for (const Field& field : probe.fields)
      bytes += bytes_of_field + sizeof(double) * static_cast<double>(field.values.size());
  const auto has = [&](const char* format) { return std::ranges::find(formats, format) != formats.end(); };
  if (has("vtk")) bytes += base64_growth * (bodies + 2 * 8 * content.bodies + walls);  // with the cells of the points
  if (has("lammps-dump")) bytes += bytes_per_dump_line * content.bodies;
  return bytes;
}

double least_frame_bytes(double bodies, StateRequest state) {
  double bytes = bytes_of_columns_alone;
  for (const BodyState vector : {BodyState::rotation, BodyState::displacement})
    if (state.has(vector)) bytes += bytes_of_vector_column;
  return least_bytes_of_empty_frame + bodies * bytes;
}

}  // namespace grit
