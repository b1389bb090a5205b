#include "pictures.hpp"

#include <vector>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"
#include "output/grain_view.hpp"
#include "output/picture.hpp"
#include "output/wall_shape.hpp"
#include "report/pictures.hpp"
#include "report/run_results.hpp"

namespace grit::python {

std::string picture_of(const std::string& title, const World& world, const std::string& view,
                       const std::string& color) {
  std::vector<WallShape> walls;
  for (const WallView& wall : world.walls())
    if (wall.geometry != nullptr) walls.push_back({.name = wall.name, .triangles = wall.geometry->triangles()});
  Picture picture;
  picture.title = title;
  picture.facts = grouped(world.positions().size()) + " bodies" +
                  (world.stage().empty() ? "" : "  ·  stage " + world.stage()) + "  ·  " + written_time(world.time());
  picture.grains = grain_view(world, walls, view, color);
  return draw(picture);
}

std::string picture_of(const std::filesystem::path& folder) {
  RunResults run = read_results(folder);
  if (const auto picture = grains_picture(run)) return *picture;
  throw Error(folder.string() + ": there is no frame to draw; run with /output/frames");
}

}  // namespace grit::python
