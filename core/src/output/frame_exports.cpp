#include "output/frame_exports.hpp"

#include "output/lammps_dump.hpp"
#include "output/vtk.hpp"

namespace grit {

std::span<const FrameExport> frame_exports() {
  static constexpr auto vtk = "<?xml version=\"1.0\"?>\n<VTKFile";
  static constexpr FrameExport all[] = {{"vtk", "_grains.vtp", vtk, "grains.pvd", vtk_grains},
                                        {"vtk", "_walls.vtp", vtk, "walls.pvd", vtk_walls},
                                        {"lammps-dump", ".dump", "ITEM: TIMESTEP", nullptr, lammps_dump}};
  return all;
}

}  // namespace grit
