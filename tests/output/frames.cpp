#include "output/frames.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <boost/property_tree/xml_parser.hpp>
#include <fstream>
#include <sstream>
#include <utility>

#include "fake_world.hpp"
#include "folder.hpp"
#include "grit/error.hpp"
#include "output/frame_size.hpp"
#include "output/read_frames.hpp"
#include "storage/frame_state.hpp"
#include "storage/hdf5.hpp"
#include "support/scene.hpp"
#include "support/stl_file.hpp"

namespace grit::frames_tests {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::Pointwise;

NumberedWorld three_grains() {
  NumberedWorld world;
  world.now = 0.25;
  world.steps = 1000;
  world.add(7, {0.7, 0, 0}, 0.07);
  world.add(2, {0.2, 0, 0}, 0.02);
  world.add(5, {0.5, 0, 0}, 0.05);
  world.add_wall("base", Vec3::Zero());
  world.add_wall("lid", {0, 0, -0.5});
  world.wall[1].pressure = 2e5;
  const Vec3 along(-1, 0, 0), force(1, 2, 3);
  const Contact pair{0, 2, false, 0, 0.2 * along, along, force, Vec3::Zero(), 4, 0.01};
  const Contact contact{1, 1, true, 23, 0.2 * along, along, force, Vec3::Zero(), 4, 0.01};
  world.contact = {pair, contact};
  return world;
}

const std::vector<WallShape> lid{{"lid", {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)}}};

TEST(Frames, SortBodiesById) {
  const Folder folder;
  auto world = three_grains();
  world.rotation = {Vec3(7, 0, 0), Vec3(2, 0, 0), Vec3(5, 0, 0)};
  Frames(folder.path(), {}).write(world, {});

  const hdf5::File file(folder / "frames/000000.h5", hdf5::Mode::read);
  EXPECT_EQ(file.number<double>("time"), 0.25);
  EXPECT_EQ(file.number<std::uint64_t>("step"), 1000u);
  EXPECT_EQ(file.text("stage"), "shear");
  const auto bodies = file.group("bodies");
  EXPECT_THAT(bodies.dataset("id").read<std::int64_t>(), ElementsAre(2, 5, 7));
  EXPECT_THAT(bodies.dataset("position").shape(), ElementsAre(3, 3));
  EXPECT_THAT(bodies.dataset("position").read<double>(), ElementsAre(0.2, 0, 0, 0.5, 0, 0, 0.7, 0, 0));
  EXPECT_THAT(bodies.dataset("radius").read<double>(), ElementsAre(0.02, 0.05, 0.07));
  EXPECT_THAT(bodies.dataset("velocity").read<double>(), ElementsAre(2, 2.25, 2.5, 5, 5.25, 5.5, 7, 7.25, 7.5));
  EXPECT_THAT(bodies.dataset("spin").read<double>(), ElementsAre(-2, 4, 6, -5, 10, 15, -7, 14, 21));
  EXPECT_THAT(bodies.dataset("material").read<std::int32_t>(), ElementsAre(0, 1, 1));
  EXPECT_THAT(bodies.dataset("rotation").read<double>(), ElementsAre(2, 0, 0, 5, 0, 0, 7, 0, 0));
  EXPECT_FALSE(bodies.has("displacement"));
  EXPECT_EQ(bodies.dataset("spin").text("units"), "rad/s");
}

TEST(Frames, PlaceContactsWallsAndFields) {
  const Folder folder;
  const std::vector<FieldGroup> fields{{"chains", {{"strength", "N", "of a chain", 2, {1, 2, 3, 4}}}}};
  Frames(folder.path(), lid).write(three_grains(), fields);
  const hdf5::File file(folder / "frames/000000.h5", hdf5::Mode::read);
  const auto contacts = file.group("contacts");
  EXPECT_THAT(contacts.dataset("body_a").read<std::int64_t>(), ElementsAre(7, 2));
  EXPECT_THAT(contacts.dataset("body_b").read<std::int64_t>(), ElementsAre(5, -2));
  EXPECT_THAT(contacts.dataset("feature").read<std::int64_t>(), ElementsAre(-1, 23));
  EXPECT_THAT(contacts.dataset("force").read<double>(), ElementsAre(1, 2, 3, 1, 2, 3));
  EXPECT_THAT(contacts.dataset("normal_force").read<double>(), ElementsAre(4, 4));
  EXPECT_THAT(contacts.dataset("branch").shape(), ElementsAre(2, 3));
  EXPECT_THAT(contacts.dataset("middle").read<double>(), Pointwise(DoubleEq(), {0.6, 0.0, 0.0, 0.1, 0.0, 0.0}));

  const auto walls = file.group("walls");
  EXPECT_THAT(walls.dataset("base").shape(), ElementsAre(0, 3, 3));
  EXPECT_THAT(walls.dataset("lid").shape(), ElementsAre(1, 3, 3));
  EXPECT_THAT(walls.dataset("lid").read<double>(), ElementsAre(0, 0, 0.5, 1, 0, 0.5, 0, 1, 0.5));
  EXPECT_EQ(walls.dataset("lid").number<std::int64_t>("index"), 1);
  EXPECT_EQ(walls.dataset("lid").number<double>("pressure"), 2e5);
  EXPECT_THAT(file.dataset("corners").shape(), ElementsAre(1, 3));
  EXPECT_THAT(file.dataset("corners").read<std::int32_t>(), ElementsAre(0, 1, 2));

  const auto strength = file.group("probes").group("chains").dataset("strength");
  EXPECT_THAT(strength.shape(), ElementsAre(2, 2));
  EXPECT_EQ(strength.text("units"), "N");

  const std::vector<FieldGroup> ragged{{"chains", {{"strength", "N", "", 3, {1, 2, 3, 4}}}}};
  EXPECT_THAT(error_of<PluginError>([&] { Frames(folder.path(), lid).write(three_grains(), ragged); }),
              HasSubstr("probe 'chains': found 4 values in field 'strength'; allowed are whole rows of 3"));
  EXPECT_FALSE(std::filesystem::exists(folder / "frames/000000.h5")) << "a frame that failed is no frame";
}

TEST(Frames, HoldTheStateOfWallsAndTheCell) {
  const Folder folder;
  auto world = three_grains();
  world.make_periodic({1, 2, 3}, {4, 5, 6});
  world.box.strain_rate = {-1, 0, 0.5};
  Mat3 quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  world.wall[1].pose = {Vec3(1, 0, 1), Vec3(0, 0, -0.5), quarter};
  world.wall[1].velocity = {1, 2, 3}, world.wall[1].spin = {4, 5, 6};
  Frames(folder.path(), lid).write(world, {});
  const FrameState state = read_frame_state(folder / "frames/000000.h5");
  EXPECT_EQ(state.stage, "shear");
  EXPECT_EQ(state.cell_low, Vec3(1, 2, 3));
  EXPECT_EQ(state.cell_high, Vec3(4, 5, 6));
  EXPECT_EQ(state.strain_rate, Vec3(-1, 0, 0.5));
  ASSERT_EQ(state.bodies.size(), 3u);
  EXPECT_EQ(state.bodies[1].id, 5u);
  EXPECT_EQ(state.bodies[1].clump, -1);
  EXPECT_EQ(state.bodies[1].position, Vec3(0.5, 0, 0));
  EXPECT_EQ(state.bodies[1].radius, 0.05);
  EXPECT_EQ(state.bodies[1].velocity, Vec3(5, 5.25, 5.5));
  EXPECT_EQ(state.bodies[1].spin, Vec3(-5, 10, 15));
  ASSERT_EQ(state.walls.size(), 2u);
  EXPECT_FALSE(state.walls[0].pose.turned());
  const FrameWall& wall = state.walls[1];
  EXPECT_EQ(wall.name, "lid");
  EXPECT_EQ(wall.pose.about, Vec3(1, 0, 1));
  EXPECT_EQ(wall.pose.shift, Vec3(0, 0, -0.5));
  EXPECT_LE((wall.pose.turn - quarter).norm(), 1e-15);
  EXPECT_EQ(wall.velocity, Vec3(1, 2, 3));
  EXPECT_EQ(wall.spin, Vec3(4, 5, 6));
  EXPECT_EQ(time_of_frame(folder / "frames/000000.h5"), 0.25);

  hdf5::File(folder / "older.h5", hdf5::Mode::replace).set_attribute("time", 0.5);
  EXPECT_THAT(error_of<FileError>([&] { read_frame_state(folder / "older.h5"); }),
              HasSubstr("older.h5: is of an earlier version of grit, without checksums; run the description again"));
  hdf5::File(folder / "old.h5", hdf5::Mode::write_whole).set_attribute("time", 0.5);
  EXPECT_THAT(error_of<FileError>([&] { read_frame_state(folder / "old.h5"); }),
              HasSubstr("old.h5: is of an earlier version, whose frames hold neither poses of walls nor the cell"));
}

TEST(Frames, HaveTheWallShapesOfTheirStage) {
  const Folder folder;
  std::vector<WallShape> shapes = lid;
  shapes.push_back({"lid", {Vec3(0, 0, -7), Vec3(1, 0, -7), Vec3(0, 1, -7)}, "open"});
  auto world = three_grains();
  Frames frames(folder.path(), shapes);
  for (const char* stage : {"closed", "open", "closed"}) world.stage_name = stage, frames.write(world, {});
  const double heights[] = {0.5, -7.5, 0.5};
  for (std::size_t i = 0; i < 3; ++i) {
    const hdf5::File file(folder / ("frames/00000" + std::to_string(i) + ".h5"), hdf5::Mode::read);
    EXPECT_EQ(file.group("walls").dataset("lid").read<double>().at(2), heights[i])
        << "half a metre lower, by its motion";
  }
}

TEST(Frames, RotateWallsAboutTheirReferencePoint) {
  const Folder folder;
  auto world = three_grains();
  Mat3 quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  world.wall[1].pose = {Vec3(1, 0, 1), Vec3(0, 0, -0.5), quarter};
  Frames(folder.path(), lid).write(world, {});
  const hdf5::File file(folder / "frames/000000.h5", hdf5::Mode::read);
  EXPECT_THAT(file.group("walls").dataset("lid").read<double>(), ElementsAre(1, -1, 0.5, 1, 0, 0.5, 0, -1, 0.5));
}

// A square of four triangles that meet at its centre; one ball rests on the second triangle and one on the last.
TEST(Frames, HaveTheForceOnEachFacetOfAMesh) {
  const std::vector<Vec3> corner{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  std::vector<Vec3> facets;
  for (std::size_t i = 0; i < 4; ++i) facets.insert(facets.end(), {Vec3::Zero(), corner[i], corner[(i + 1) % 4]});
  const test::StlFile file(test::stl_text(facets));
  Description d = test::description("linear-frictional", {{"contact_modulus", 1e6}, {"density", 2600}},
                                    {{{-0.3, 0.3, 0.0999}, 0.1}, {{0.3, -0.3, 0.1999}, 0.2}});
  d["walls"]["other"] = test::plane({0, 0, -5}, Vec3::UnitZ());
  d["walls"]["sheet"] = {
      {"type", "mesh"}, {"path", file.path()}, {"scale", 1.0}, {"open", true}, {"material", "grain"}};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  test::Trial trial(d);
  for (int i = 0; i < 20000; ++i) trial.step();
  const Folder folder;
  Frames(folder.path(), {{"sheet", facets}}).write(trial.world(), {});

  const hdf5::File frame(folder / "frames/000000.h5", hdf5::Mode::read);
  const auto contacts = frame.group("contacts"), walls = frame.group("walls");
  const auto index = walls.dataset("sheet").number<std::int64_t>("index");
  const auto body_b = contacts.dataset("body_b").read<std::int64_t>(),
             feature = contacts.dataset("feature").read<std::int64_t>();
  const auto force = contacts.dataset("force").read<double>();
  std::vector<Vec3> on_facet(walls.dataset("sheet").rows(), Vec3::Zero());
  for (std::size_t i = 0; i < body_b.size(); ++i)
    if (body_b[i] == -1 - index)
      on_facet.at(static_cast<std::size_t>(feature[i]) / 7) += Vec3(force[3 * i], force[3 * i + 1], force[3 * i + 2]);
  ASSERT_EQ(on_facet.size(), 4u);
  const double g = 9.81;
  EXPECT_EQ(on_facet[0], Vec3::Zero());
  EXPECT_LE((on_facet[1] + Vec3(0, 0, g * trial.mass(0))).norm(), 1e-9 * g * trial.mass(0));
  EXPECT_EQ(on_facet[2], Vec3::Zero());
  EXPECT_LE((on_facet[3] + Vec3(0, 0, g * trial.mass(1))).norm(), 1e-9 * g * trial.mass(1));
}

/// Whether the data item names a dataset with the given dimensions.
void check_item(const boost::property_tree::ptree& item, const std::filesystem::path& folder) {
  const auto text = item.get_value<std::string>();
  const auto colon = text.find(':');
  ASSERT_NE(colon, std::string::npos) << text;
  const hdf5::File file(folder / text.substr(0, colon), hdf5::Mode::read);
  std::istringstream dimensions(item.get<std::string>("<xmlattr>.Dimensions"));
  const hdf5::Shape stated{std::istream_iterator<std::size_t>(dimensions), {}};
  EXPECT_EQ(file.dataset(text.substr(colon + 2)).shape(), stated) << text;
}

TEST(Frames, IndexNamesAllDatasets) {
  const Folder folder;
  Frames frames(folder.path(), lid);
  auto world = three_grains();
  frames.write(world, {});
  world.add(9, {0.9, 0, 0}, 0.09);
  world.now = 0.5;
  world.rotation.assign(4, Vec3::Zero());
  world.displacement.assign(4, Vec3::Zero());
  frames.write(world, {});

  boost::property_tree::ptree xml;
  read_xml((folder / "frames.xdmf").string(), xml);
  std::map<std::string, std::vector<std::size_t>> elements, items;
  for (const auto& [tag, series] : xml.get_child("Xdmf.Domain")) {
    EXPECT_EQ(series.get<std::string>("<xmlattr>.CollectionType"), "Temporal");
    const auto of = series.get<std::string>("<xmlattr>.Name");
    std::vector<double> times;
    for (const auto& [name, grid] : series) {
      if (name != "Grid") continue;
      times.push_back(grid.get<double>("Time.<xmlattr>.Value"));
      elements[of].push_back(grid.get<std::size_t>("Topology.<xmlattr>.NumberOfElements"));
      EXPECT_EQ(grid.get<std::string>("Topology.<xmlattr>.TopologyType"), of == "lid" ? "Triangle" : "Polyvertex");
      items[of].push_back(0);
      for (const auto& [kind, child] : grid)
        if (const auto item = child.get_child_optional("DataItem")) {
          check_item(*item, folder.path());
          ++items[of].back();
        }
    }
    EXPECT_THAT(times, ElementsAre(0.25, 0.5)) << of;
  }
  EXPECT_THAT(elements, ElementsAre(Pair("contacts", ElementsAre(2, 2)), Pair("grains", ElementsAre(3, 4)),
                                    Pair("lid", ElementsAre(1, 1))));
  EXPECT_THAT(items, ElementsAre(Pair("contacts", ElementsAre(6, 6)), Pair("grains", ElementsAre(6, 8)),
                                 Pair("lid", ElementsAre(2, 2))));
}

TEST(Frames, DoNotCostMoreTheMoreThereAre) {
  const Folder folder;
  Frames frames(folder.path(), {});
  auto world = three_grains();
  const auto index = folder / "frames.xdmf";
  std::uintmax_t written = 0;
  ino_t last = 0;
  constexpr int count = 400;
  for (int i = 0; i < count; ++i) {
    world.now = i;
    frames.write(world, {});
    struct stat file {};
    ASSERT_EQ(::stat(index.c_str(), &file), 0);
    if (file.st_ino != std::exchange(last, file.st_ino)) written += static_cast<std::uintmax_t>(file.st_size);
    boost::property_tree::ptree whole;
    if (i % 50 == 0) EXPECT_NO_THROW(read_xml(index.string(), whole)) << i;
  }
  frames.update_indices();
  EXPECT_LT(written, 60 * std::filesystem::file_size(index)) << "written anew with each frame it is 200 times that";
  const std::string text = text_of(index);
  for (int i = 0; i < count; ++i)
    EXPECT_THAT(text, HasSubstr("frames/" + frame_name(static_cast<std::size_t>(i)) + ":/bodies/id")) << i;
}

TEST(Frames, HaveTheSizeThatCheckEstimates) {
  NumberedWorld world;
  for (std::uint32_t i = 0; i < 1000; ++i) world.add(i, {0.1 * i, 1.0 / 3, 0}, 0.05);
  for (std::uint32_t i = 0; i + 3 < 1000; ++i)
    for (std::uint32_t k = 1; k < 4; ++k)
      world.contact.push_back({i, i + k, false, 0, Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitX(), Vec3::Zero(), 4, 0.01});
  world.rotation.assign(1000, Vec3::UnitX());
  const std::vector<FieldGroup> fields{{"cells", {{"stress", "Pa", "", 9, std::vector<double>(9 * 500, 1.5)}}}};
  const std::vector<std::vector<std::string>> formats{{}, {"vtk"}};
  for (const auto& more : formats) {
    const Folder folder;
    Frames(folder.path(), lid, 0, more).write(world, fields);
    double bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "frames"))
      bytes += static_cast<double>(entry.file_size());
    const double contacts = static_cast<double>(world.contact.size());
    EXPECT_NEAR(frame_bytes(world, {1000, contacts, 1}, fields, more) / bytes, 1, 0.15) << more.size();
  }
}

TEST(Frames, TakeAtLeastTheSizeByWhichRunsAreRefused) {
  NumberedWorld world;
  for (std::uint32_t i = 0; i < 2; ++i) world.add(i, {0.1 * i, 0, 0}, 0.05);
  const Folder folder;
  Frames(folder.path(), {}).write(world, {});
  const auto bytes = static_cast<double>(std::filesystem::file_size(folder / "frames/000000.h5"));
  EXPECT_LE(least_frame_bytes(2, {}), bytes);
  EXPECT_GT(least_frame_bytes(2, {}), 0.5 * bytes);
  EXPECT_EQ(least_frame_bytes(3, BodyState::rotation | BodyState::displacement) - least_frame_bytes(2, {}),
            92 + 3 * 48);
}

TEST(Frames, FieldsOfAWallColourItsTriangles) {
  const Folder folder;
  const auto field = [](const char* name, std::size_t width, std::vector<double> values, const char* wall) {
    return Field{name, "Pa", "of a facet", width, std::move(values), {}, wall};
  };
  const std::vector<FieldGroup> fields{
      {"facets",
       {field("pressure", 1, {7}, "lid"), field("shear", 3, {1, 2, 3}, "lid"), field("elsewhere", 1, {7}, ""),
        field("longer", 1, {7, 8}, "lid"), field("unknown", 1, {7}, "roof")}}};
  const auto world = three_grains();
  { Frames(folder.path(), lid).write(world, fields); }
  const auto check = [&](const char* when) {
    SCOPED_TRACE(when);
    boost::property_tree::ptree xml;
    read_xml((folder / "frames.xdmf").string(), xml);
    std::map<std::string, std::string> types;
    for (const auto& [tag, series] : xml.get_child("Xdmf.Domain")) {
      if (series.get<std::string>("<xmlattr>.Name") != "lid") continue;
      for (const auto& [kind, child] : series.get_child("Grid")) {
        if (kind != "Attribute") continue;
        EXPECT_EQ(child.get<std::string>("<xmlattr>.Center"), "Cell");
        types[child.get<std::string>("<xmlattr>.Name")] = child.get<std::string>("<xmlattr>.AttributeType");
        check_item(child.get_child("DataItem"), folder.path());
      }
    }
    EXPECT_THAT(types, ElementsAre(Pair("facets/pressure", "Scalar"), Pair("facets/shear", "Vector")));
  };
  check("as written");
  Frames(folder.path(), lid, 1);
  check("as read again");
}

TEST(Frames, ContinueFromACount) {
  const Folder folder;
  auto world = three_grains();
  {
    Frames frames(folder.path(), {});
    for (world.steps = 0; world.steps < 50; world.steps += 10) frames.write(world, {});
  }
  std::ofstream(folder / "frames/000005.h5.part") << "torn";
  Frames frames(folder.path(), {}, 3);
  EXPECT_EQ(frames.count(), 3u);
  EXPECT_FALSE(std::filesystem::exists(folder / "frames/000003.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "frames/000004.h5"));
  frames.write(world, {});
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/000003.h5"));
}

TEST(Frames, ReplaceNoFileThatTheyDidNotWrite) {
  const Folder folder;
  auto world = three_grains();
  const auto mine = [&](const std::string& name) {
    EXPECT_EQ(text_of(folder / ("frames/" + name)), "mine");
    std::filesystem::remove(folder / ("frames/" + name));
  };
  const std::vector<std::string> formats{"vtk", "lammps-dump"};
  Frames frames(folder.path(), {}, 0, formats);
  frames.write(world, {});
  for (const std::string name : {"000001.h5", "000001_grains.vtp", "000001_walls.vtp", "000001.dump"}) {
    EXPECT_NO_THROW(frames.expect_room());
    folder.write("frames/" + name, "mine");
    EXPECT_THAT(error_of<RefusedRecord>([&] { frames.expect_room(); }),
                testing::AllOf(testing::HasSubstr(name + ": grit did not write"), testing::HasSubstr("move it away")));
    EXPECT_THROW(frames.write(world, {}), FileError);
    EXPECT_EQ(frames.count(), 1u);
    // A run that resumes removes its later frames, but not others.
    EXPECT_THAT(error_of<FileError>([&] { Frames again(folder.path(), {}, 1, formats); }), testing::HasSubstr(name));
    mine(name);
    Frames again(folder.path(), {}, 1, formats);
  }
  frames.write(world, {});
  EXPECT_EQ(frames.count(), 2u);
}

/// What a reader shows of a frame.
std::string shown(const std::filesystem::path& path) {
  const Frame frame = read_frame(path);
  std::ostringstream text;
  const auto put = [&](const auto& numbers) {
    for (const auto& one : numbers) text << one << ' ';
  };
  text << std::hexfloat << frame.time << ' ' << frame.step << ' ' << frame.stage << ' ';
  put(frame.id), put(frame.position), put(frame.radius), put(frame.velocity), put(frame.rotation);
  put(frame.body_a), put(frame.normal_force), put(frame.branch);
  for (const auto& wall : frame.walls) text << wall.name << ' ', put(wall.corners), put(wall.displacement);
  for (const auto& map : read_maps(path))
    for (const Field& field : map.fields) text << field.name << ' ' << field.unit << ' ', put(field.values);
  return text.str();
}

TEST(Frames, WithAnyFlippedByteAreTheSameOrRefused) {
  const Folder folder;
  auto world = three_grains();
  world.rotation = {Vec3(7, 0, 0), Vec3(2, 0, 0), Vec3(5, 0, 0)};
  Field centre{"centre", "m", "", 3, {1, 2, 3, 4, 5, 6}}, size = centre, porosity{"porosity", "1", "", 1, {0.3, 0.4}};
  size.name = "size";
  const std::vector<FieldGroup> maps{{"cells", {centre, size, porosity}}};
  Frames(folder.path(), lid).write(world, maps);
  const auto path = folder / "frames/000000.h5";
  const std::string whole = shown(path);
  const auto length = std::filesystem::file_size(path);
  std::size_t refused = 0;
  for (std::uint64_t at = 0; at < length; at += at < 1000 ? 1 : 23) {
    const auto flip = [&] {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(static_cast<std::streamoff>(at));
      const char byte = static_cast<char>(file.get() ^ 1 << at % 8);
      file.seekp(static_cast<std::streamoff>(at));
      file.put(byte);
    };
    flip();
    try {
      EXPECT_EQ(shown(path), whole) << at;
    } catch (const FileError&) {
      ++refused;
    }
    flip();
  }
  EXPECT_GT(refused, 500u);
  EXPECT_EQ(shown(path), whole);
}

}  // namespace
}  // namespace grit::frames_tests
