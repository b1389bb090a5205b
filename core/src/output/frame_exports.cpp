#include "output/frame_exports.hpp"

#include "output/lammps_dump.hpp"
#include "output/vtk.hpp"

namespace grit {

std::span<const FrameExport> frame_exports() {
  static constexpr FrameExport all[] = {{"vtk", "_grains.vtp", "grains.pvd", vtk_grains},
                                        {"vtk", "_walls.vtp", "walls.pvd", vtk_walls},
                                        {"lammps-dump", ".dump", nullptr, lammps_dump}};
  return all;
}

}  // namespace grit
