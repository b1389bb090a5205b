// Frames in the formats of other programs.
#include "output/frame_exports.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>

#include "bodies/packing_file.hpp"
#include "fake_world.hpp"
#include "folder.hpp"
#include "output/frames.hpp"
#include "output/lammps_dump.hpp"
#include "output/vtk.hpp"

namespace grit::frame_exports_tests {
namespace {

using boost::property_tree::ptree;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two groups; the bodies are not in the order of their ids.
struct GroupedWorld : NumberedWorld {
  GroupedWorld() {
    now = 0.25, steps = 1000;
    add(7, {1.0 / 3, std::numbers::pi, 0.1}, 0.07);
    add(2, {0.2, 1e-12, -3e5}, 0.02);
    add(5, {0.5, 0, 0}, 0.05);
    add_wall("base", Vec3::Zero());
    add_wall("lid", {0, 0, -0.5});
  }
  std::span<const BodyGroup> groups() const override { return all; }
  std::vector<BodyGroup> all{{"sand", 0}, {"balls", 5}};
};

const std::vector<WallShape> lid{{"lid", {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)}}};

ptree parsed(const std::string& text) {
  std::istringstream stream(text);
  ptree xml;
  read_xml(stream, xml);
  return xml;
}

/// The numbers of an array; checks the size in front of them.
template <class T>
std::vector<T> numbers(const ptree& parent, const std::string& name) {
  for (const auto& [tag, array] : parent) {
    if (tag != "DataArray" || array.get<std::string>("<xmlattr>.Name") != name) continue;
    EXPECT_EQ(array.get<std::string>("<xmlattr>.format"), "binary");
    std::string text = array.get_value<std::string>();
    std::ranges::replace(text, '=', 'A');
    using namespace boost::archive::iterators;
    using Bytes = transform_width<binary_from_base64<std::string::const_iterator>, 8, 6>;
    const std::string bytes(Bytes(text.cbegin()), Bytes(text.cend()));
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data(), sizeof size);
    std::vector<T> values(size / sizeof(T));
    EXPECT_LT(bytes.size() - sizeof size - size, 3u) << name << ": no more than the padding";
    if (size > 0) std::memcpy(values.data(), bytes.data() + sizeof size, size);
    return values;
  }
  ADD_FAILURE() << "there is no array " << name;
  return {};
}

std::vector<PackedBody> read_dump(const std::filesystem::path& path, const std::string& type = "") {
  FileSource source;
  source.path = path.string(), source.particle_type = type;
  return read_bodies(source);
}

TEST(FrameExports, DumpsAreReadAsPackings) {
  const Folder folder;
  const GroupedWorld world;
  const std::vector<std::string> formats{"lammps-dump"};
  Frames(folder.path(), lid, 0, formats).write(world, {});
  const auto bodies = read_dump(folder / "frames/000000.dump");
  ASSERT_EQ(bodies.size(), 3u);
  const std::size_t by_id[] = {1, 2, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t body = by_id[i];
    EXPECT_EQ(xyz(bodies[i].sphere), xyz(world.position[body]));
    EXPECT_EQ(bodies[i].sphere.w, world.position[body].w);
    EXPECT_EQ(bodies[i].velocity, xyz(world.velocity[body]));
    EXPECT_EQ(bodies[i].spin, xyz(world.spin[body]));
  }
  const auto balls = read_dump(folder / "frames/000000.dump", "1"),
             sand = read_dump(folder / "frames/000000.dump", "2");
  ASSERT_EQ(sand.size(), 1u) << "types are the groups in the order of their names";
  EXPECT_EQ(sand[0].sphere.w, 0.02);
  EXPECT_EQ(balls.size(), 2u);
  EXPECT_FALSE(std::filesystem::exists(folder / "grains.pvd")) << "a format that was not asked for";
}

TEST(FrameExports, DumpsHaveABox) {
  NumberedWorld world;
  world.steps = 40;
  world.add(1, {0.5, 2.25, 3}, 0.25);
  world.add(2, {3.5, 2.25, 5}, 0.5);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  world.box = {{1, 0, -infinity}, {3, 9, infinity}, {true, false, false}};
  EXPECT_EQ(lammps_dump(world, {}),
            "ITEM: TIMESTEP\n40\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff ss\n1 3\n0 9\n2.75 5.5\n"
            "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz\n"
            "1 1 2.5 2.25 3 0.25 1 1.25 1.5 -1 2 3\n2 1 1.5 2.25 5 0.5 2 2.25 2.5 -2 4 6\n");
  EXPECT_THAT(lammps_dump(NumberedWorld(), {}), HasSubstr("ss ss ss\n0 1\n0 1\n0 1\n")) << "without bodies";
}

TEST(FrameExports, DumpsOfSkewedCellsAreTriclinic) {
  NumberedWorld world;
  world.add(1, {0.25, 0.5, 4}, 0.25);
  world.add(2, {1, 0.25, 6}, 0.5);
  world.make_periodic({0, 0, 0}, {2, 4, 8});
  world.box.tilt = {-0.5, 0.75, 1};
  // The bounds enclose the cell, whose corners are at sums of (2, 0, 0), (-0.5, 4, 0) and (0.75, 1, 8). The image of
  // body 1 in it is one period further along x, that of body 2 along y.
  const std::string dump = lammps_dump(world, {});
  EXPECT_EQ(dump,
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS xy xz yz pp pp pp\n"
            "-0.5 2.75 -0.5\n0 5 0.75\n0 8 1\n"
            "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz\n"
            "1 1 2.25 0.5 4 0.25 1 1.25 1.5 -1 2 3\n2 1 0.5 4.25 6 0.5 2 2.25 2.5 -2 4 6\n");
  const Folder folder;
  std::ofstream(folder / "skewed.dump") << dump;
  const auto bodies = read_dump(folder / "skewed.dump");
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_EQ(xyz(bodies[1].sphere), Vec3(0.5, 4.25, 6));
  EXPECT_EQ(bodies[1].velocity, Vec3(2, 2.25, 2.5));

  world.box.tilt = {0.25, -0.75, -1};
  EXPECT_THAT(lammps_dump(world, {}), HasSubstr("\n-0.75 2.25 0.25\n-1 4 -0.75\n0 8 -1\n"));
  world.box.tilt = Vec3::Zero(), world.box.shear_rate = {1, 0, 0};
  EXPECT_THAT(lammps_dump(world, {}), HasSubstr("xy xz yz pp pp pp\n0 2 0\n0 4 0\n0 8 0\n")) << "will be skewed";
  world.box = {{0, 0, -std::numeric_limits<double>::infinity()}, {2, 4, 9}, {true, true, false}};
  world.box.tilt = {0.5, 0, 0};
  EXPECT_THAT(lammps_dump(world, {}), HasSubstr("xy xz yz pp pp sf\n0 2.5 0.5\n0 4 0\n3.75 9 0\n")) << "open along z";
}

TEST(FrameExports, VtkHasTheGrains) {
  const ptree xml = parsed(vtk_grains(GroupedWorld(), lid));
  EXPECT_EQ(xml.get<std::string>("VTKFile.<xmlattr>.type"), "PolyData");
  EXPECT_EQ(xml.get<std::string>("VTKFile.<xmlattr>.header_type"), "UInt64");
  const ptree& piece = xml.get_child("VTKFile.PolyData.Piece");
  EXPECT_EQ(piece.get<int>("<xmlattr>.NumberOfPoints"), 3);
  EXPECT_EQ(piece.get<int>("<xmlattr>.NumberOfVerts"), 3);
  EXPECT_EQ(piece.get<int>("<xmlattr>.NumberOfPolys"), 0);
  EXPECT_THAT(numbers<double>(piece.get_child("Points"), "position"),
              ElementsAre(0.2, 1e-12, -3e5, 0.5, 0, 0, 1.0 / 3, std::numbers::pi, 0.1));
  const ptree& data = piece.get_child("PointData");
  EXPECT_THAT(numbers<std::int64_t>(data, "id"), ElementsAre(2, 5, 7));
  EXPECT_THAT(numbers<double>(data, "radius"), ElementsAre(0.02, 0.05, 0.07));
  EXPECT_THAT(numbers<std::int32_t>(data, "group"), ElementsAre(1, 0, 0));
  EXPECT_THAT(numbers<std::int32_t>(data, "material"), ElementsAre(0, 1, 1));
  EXPECT_THAT(numbers<double>(data, "velocity"), ElementsAre(2, 2.25, 2.5, 5, 5.25, 5.5, 7, 7.25, 7.5));
  EXPECT_THAT(numbers<double>(data, "spin"), ElementsAre(-2, 4, 6, -5, 10, 15, -7, 14, 21));
  EXPECT_THAT(numbers<std::int64_t>(piece.get_child("Verts"), "connectivity"), ElementsAre(0, 1, 2));
  EXPECT_THAT(numbers<std::int64_t>(piece.get_child("Verts"), "offsets"), ElementsAre(1, 2, 3));
}

TEST(FrameExports, VtkHasTheWallsWhereTheyAre) {
  const ptree xml = parsed(vtk_walls(GroupedWorld(), lid));
  const ptree& piece = xml.get_child("VTKFile.PolyData.Piece");
  EXPECT_EQ(piece.get<int>("<xmlattr>.NumberOfPoints"), 3);
  EXPECT_EQ(piece.get<int>("<xmlattr>.NumberOfVerts"), 0);
  EXPECT_EQ(piece.get<int>("<xmlattr>.NumberOfPolys"), 1);
  EXPECT_THAT(numbers<double>(piece.get_child("Points"), "position"), ElementsAre(0, 0, 0.5, 1, 0, 0.5, 0, 1, 0.5));
  EXPECT_THAT(numbers<std::int32_t>(piece.get_child("CellData"), "wall"), ElementsAre(1));
  EXPECT_THAT(numbers<std::int64_t>(piece.get_child("Polys"), "offsets"), ElementsAre(3));
}

struct FrameExportsOfResumedRuns : testing::Test {
  void write(Frames& frames, std::initializer_list<double> times) {
    for (const double time : times) world.now = time, frames.write(world, {});
  }
  bool has(const std::string& file) const { return std::filesystem::exists(folder / file); }
  /// Those of a collection, whose files exist.
  std::vector<double> times(const char* name) const {
    ptree xml;
    read_xml((folder / name).string(), xml);
    std::vector<double> found;
    for (const auto& [tag, one] : xml.get_child("VTKFile.Collection")) {
      if (tag != "DataSet") continue;
      EXPECT_TRUE(has(one.get<std::string>("<xmlattr>.file")));
      found.push_back(one.get<double>("<xmlattr>.timestep"));
    }
    return found;
  }
  /// Whether there is a frame of this number, in all formats or in none.
  bool has_frame(const std::string& number) const {
    for (const char* end : {"_grains.vtp", "_walls.vtp", ".dump"})
      EXPECT_EQ(has("frames/" + number + end), has("frames/" + number + ".h5")) << number << end;
    return has("frames/" + number + ".h5");
  }

  const Folder folder;
  const std::vector<std::string> all{"vtk", "lammps-dump"};
  GroupedWorld world;
};

TEST_F(FrameExportsOfResumedRuns, ContinueFromACount) {
  {
    Frames frames(folder.path(), lid, 0, all);
    write(frames, {0, 1, 2, 3});
  }
  std::ofstream(folder / "frames/mine.txt") << "mine";
  std::ofstream(folder / "frames/000003.txt") << "mine";
  Frames frames(folder.path(), lid, 2, all);
  EXPECT_TRUE(has_frame("000001"));
  EXPECT_FALSE(has_frame("000002"));
  EXPECT_FALSE(has_frame("000003"));
  EXPECT_TRUE(has("frames/mine.txt"));
  EXPECT_TRUE(has("frames/000003.txt"));
  EXPECT_THAT(times("grains.pvd"), ElementsAre(0, 1));
  write(frames, {5});
  EXPECT_THAT(times("grains.pvd"), ElementsAre(0, 1, 5));
  EXPECT_THAT(times("walls.pvd"), ElementsAre(0, 1, 5));
}

TEST_F(FrameExportsOfResumedRuns, RemoveLaterFilesOfFormatsThatWereDropped) {
  {
    Frames frames(folder.path(), lid, 0, all);
    write(frames, {0, 1, 2, 3, 4});
  }
  std::filesystem::remove(folder / "frames/000002.dump");  // those behind a gap are found too
  Frames frames(folder.path(), lid, 2);
  EXPECT_TRUE(has_frame("000001"));
  for (const char* later : {"000002", "000003", "000004"}) EXPECT_FALSE(has_frame(later));
  EXPECT_THAT(times("grains.pvd"), ElementsAre(0, 1));
  EXPECT_THAT(times("walls.pvd"), ElementsAre(0, 1));
  write(frames, {5});
  EXPECT_TRUE(has("frames/000002.h5"));
  EXPECT_FALSE(has("frames/000002.dump"));
  EXPECT_THAT(times("grains.pvd"), ElementsAre(0, 1));
}

TEST_F(FrameExportsOfResumedRuns, MayAddAFormat) {
  {
    Frames frames(folder.path(), lid);
    write(frames, {0, 1});
  }
  const std::vector<std::string> vtk{"vtk"};
  Frames frames(folder.path(), lid, 1, vtk);
  write(frames, {5});
  EXPECT_THAT(times("grains.pvd"), ElementsAre(5)) << "the frame before has no such file";
}

}  // namespace
}  // namespace grit::frame_exports_tests
