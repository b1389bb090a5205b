// Packings that other codes wrote.
#include "bodies/packing_formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bodies/packing_file.hpp"
#include "grit/error.hpp"
#include "support/own_folder.hpp"
#include "support/program.hpp"
#include "support/scene.hpp"

namespace grit::test::packing_formats_tests {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

constexpr const char* data_of_liggghts = R"(LIGGGHTS data file via write_data

3 atoms
2 atom types

0 0.1 xlo xhi
-0.1 0.1 ylo yhi
0 0.2 zlo zhi

Atoms # sphere

2 1 0.002 2500 0.01 0.02 0.03 0 0 1
7 2 0.004 2500 0.04 -0.05 0.06 0 0 0
1 1 0.006 2500 0.07 0.08 0.09 0 0 0

Velocities

1 0.1 0.2 0.3 1 2 3
2 -0.1 0 0.5 4 5 6
7 0 0 1 0 0 0
)";

constexpr const char* dump_of_two_steps = R"(ITEM: TIMESTEP
100
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS pp pp ff
0 1
0 1
0 1
ITEM: ATOMS id type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius 
1 1 0.1 0.2 0.3 0 0 0 1 2 3 9 9 9 4 5 6 0.01 
2 3 0.4 0.5 0.6 0 0 0 0 0 0 9 9 9 0 0 0 0.02 
ITEM: TIMESTEP
200
ITEM: NUMBER OF ATOMS
1
ITEM: BOX BOUNDS pp pp ff
0 1
0 1
0 1
ITEM: ATOMS id type diameter z y x
2 3 0.04 0.7 0.5 0.4
)";

class PackingFormats : public testing::Test {
 protected:
  FileSource source(const std::string& text, const std::string& name = "grains.txt") const {
    FileSource source;
    source.path = folder.write(name, text).string();
    return source;
  }
  std::vector<PackedBody> read(const std::string& text, const std::string& name = "grains.txt") const {
    return read_bodies(source(text, name));
  }
  /// Without the path of the file.
  static std::string problem(const FileSource& source) {
    try {
      read_bodies(source);
    } catch (const DescriptionError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.starts_with(source.path));
      return text.substr(source.path.size());
    }
    return "";
  }
  std::string problem(const std::string& text, const std::string& format = "auto") const {
    FileSource file = source(text);
    file.format = format;
    return problem(file);
  }
  OwnFolder folder;
};

void expect_body(const PackedBody& body, const Vec3& centre, double radius, const Vec3& velocity = Vec3::Zero(),
                 const Vec3& spin = Vec3::Zero()) {
  EXPECT_EQ(xyz(body.sphere), centre);
  EXPECT_EQ(body.sphere.w, radius);
  EXPECT_EQ(body.velocity, velocity);
  EXPECT_EQ(body.spin, spin);
}

TEST_F(PackingFormats, TextHasTheColumnsOfTheDescription) {
  FileSource file = source("a title\nanother\n7 1 2 3 8 0.1 0.2 0.3 x 4 5 6\n");
  file.columns = {"id", "x", "y", "z", "d", "vx", "vy", "vz", "-", "wx", "wy", "wz"};
  file.header_lines = 2;
  file.scale = 0.5;
  const auto bodies = read_bodies(file);
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {0.5, 1, 1.5}, 2, {0.05, 0.1, 0.15}, {4, 5, 6});
}

TEST_F(PackingFormats, TextHasAnySeparator) {
  for (const std::string text :
       {"1 2\t3  4\n", "1,2,3,4\n", "1, 2, 3, 4,\n", "1;2; 3 ;4\n", "\"1\",\"2\",\"3\",\"4\"\n", "x y z r\n1 2 3 4\n",
        "# any\nx;y;z;radius;other\n1;2;3;4;a word\n"}) {
    const auto bodies = read(text);
    ASSERT_EQ(bodies.size(), 1u) << text;
    expect_body(bodies[0], {1, 2, 3}, 4);
  }
  EXPECT_THAT(problem("0,01;0,02;0,03;0,004\n"), HasSubstr(":1: x is \"0,01\": numbers use a point, not a comma"));
  EXPECT_THAT(problem("0,01 0,02 0,03 0,004\n"), HasSubstr(":1: x is \"0,01\": numbers use a point, not a comma"));
  EXPECT_THAT(problem("1,2,3,4\n1,2,,4\n1,2,3\n"),
              AllOf(HasSubstr(":2: z is \"\": empty"), HasSubstr(":3: found 3 columns; expected 4: x y z radius")));
}

TEST_F(PackingFormats, TextOfOtherColumnsIsNotGuessed) {
  EXPECT_EQ(problem("1 1 2 3 4\n"),
            ":1: found 5 columns in \"1 1 2 3 4\"; expected 4: x y z radius; name others in `columns`");
  EXPECT_EQ(problem("x,y,z,mass\n1,2,3,4\n"), ":1: the columns x y z mass lack radius or diameter");
  EXPECT_EQ(problem("id x y r\n1 2 3 4\n"), ":1: the columns id x y r lack z");
}

TEST_F(PackingFormats, LammpsDataHasVelocitiesById) {
  const auto bodies = read(data_of_liggghts);
  ASSERT_EQ(bodies.size(), 3u);
  expect_body(bodies[0], {0.01, 0.02, 0.03}, 0.001, {-0.1, 0, 0.5}, {4, 5, 6});
  expect_body(bodies[1], {0.04, -0.05, 0.06}, 0.002, {0, 0, 1});
  expect_body(bodies[2], {0.07, 0.08, 0.09}, 0.003, {0.1, 0.2, 0.3}, {1, 2, 3});
}

TEST_F(PackingFormats, LammpsDataOfOneType) {
  FileSource file = source(data_of_liggghts);
  file.particle_type = "2";
  const auto bodies = read_bodies(file);
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {0.04, -0.05, 0.06}, 0.002, {0, 0, 1});
  file.particle_type = "3";
  EXPECT_EQ(problem(file), ": has no body of particle type \"3\"; its types are 1, 2");
}

TEST_F(PackingFormats, LammpsDataOfAnotherStyleNeedsItsColumns) {
  FileSource file = source("title\n\n1 atoms\n\nAtoms # hybrid bond granular\n\n1 1 0.1 0.2 0.3 0.04 2500 1 5\n");
  EXPECT_EQ(problem(file),
            ":5: the atom style is \"hybrid bond granular\"; allowed is sphere or granular; of others, name the "
            "columns in `columns`");
  file.columns = {"id", "type", "x", "y", "z", "d"};
  const auto bodies = read_bodies(file);
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {0.1, 0.2, 0.3}, 0.02);
}

TEST_F(PackingFormats, LammpsDataIsChecked) {
  const std::string good = data_of_liggghts;
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = good;
    return problem(changed.replace(changed.find(old), old.size(), text));
  };
  EXPECT_EQ(with("2 1 0.002 2500 0.01", "2 1 0.002 2500 0,01"), ":12: x is \"0,01\": numbers use a point, not a comma");
  EXPECT_EQ(with("2 1 0.002", "2 1 0"), ":12: diameter is 0 m; it must be above 0");
  EXPECT_EQ(with("7 0 0 1", "8 0 0 1"), ":20: id is \"8\", which the section Atoms does not have");
  EXPECT_EQ(with("7 0 0 1 0", "7 0 0 1"), ":20: found 6 columns; expected 7: id vx vy vz wx wy wz, or the first 4");
  EXPECT_EQ(problem(good.substr(0, good.find("1 1 0.006"))),
            ": has 2 lines in the section Atoms; the header gives 3; the file ends in line 13, in the section of line "
            "10");
  EXPECT_THAT(problem("title\n1 2 3 4\n", "lammps-data"), HasSubstr("the header has no line \"N atoms\""));
}

TEST_F(PackingFormats, LammpsDataHasEachBodyOnceInEachSection) {
  const std::string good = data_of_liggghts;
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = good;
    return problem(changed.replace(changed.find(old), old.size(), text));
  };
  EXPECT_EQ(with("7 2 0.004", "2 2 0.004"), ":13: id is \"2\", as in line 12; each body has an id of its own");
  EXPECT_EQ(with("2 -0.1 0", "1 -0.1 0"), ":19: id is \"1\", as in line 18; each body has one velocity");
  EXPECT_EQ(with("Velocities", "Atoms"), ":16: found a second section Atoms; the first is in line 10; allowed is one");
  EXPECT_EQ(with("0.09 0 0 0", "0.09 0"), ":14: found 8 columns; the first row has 10");
  EXPECT_EQ(with("7 0 0 1 0 0 0", "7 0 0 1"), ":20: found 4 columns; the first row has 7");
  // Cut at a line end: refused wherever the bodies or their velocities are not complete.
  const std::size_t sections = good.find("Atoms"), complete = good.find("Velocities");
  for (std::size_t end = good.find('\n', sections); end + 1 < good.size(); end = good.find('\n', end + 1))
    EXPECT_EQ(problem(good.substr(0, end + 1)).empty(), end + 1 == complete - 1 || end + 1 == complete) << end;
  EXPECT_EQ(problem(good.substr(0, good.find("7 0 0 1"))),
            ": has 2 lines in the section Velocities; the header gives 3; the file ends in line 19, in the section of "
            "line 16");
  EXPECT_EQ(problem("title\n3 atoms\n", "lammps-data"),
            ": has 0 lines in the section Atoms; the header gives 3; the file ends in line 2, in the header");
}

TEST_F(PackingFormats, BodiesHaveDifferentIdsInEveryFormat) {
  const std::string again = "id is \"7\", as in line ";
  EXPECT_THAT(problem("id x y z r\n7 1 2 3 4\n8 1 2 3 4\n7 1 2 3 4\n"), HasSubstr(":4: " + again + "2;"));
  EXPECT_THAT(problem("id,x,y,z,r\n7,1,2,3,4\n7,1,2,3,4\n"), HasSubstr(":3: " + again + "2;"));
  EXPECT_THAT(problem("#format id_x_y_z_r_matId\n7 1 2 3 4 0\n7 5 6 7 8 1\n"), HasSubstr(":3: " + again + "2;"));
  EXPECT_THAT(problem("2\nProperties=id:I:1:pos:R:3:radius:R:1\n7 1 2 3 4\n7 5 6 7 8\n"),
              HasSubstr(":4: " + again + "3;"));
  std::string dump = dump_of_two_steps;
  dump.replace(dump.find("1 1 0.1"), 1, "2");
  FileSource file = source(dump);
  EXPECT_EQ(problem(file), "");  // in another snapshot
  file.time_step = 100;
  EXPECT_THAT(problem(file), HasSubstr(":11: id is \"2\", as in line 10;"));
  file = source("7 1 2 3 4 sand\n7 5 6 7 8 clay\n");
  file.columns = {"id", "x", "y", "z", "r", "type"};
  for (const char* type : {"", "sand", "clay"}) {
    file.particle_type = type;
    EXPECT_THAT(problem(file), HasSubstr(":2: " + again + "1;"));
  }
}

TEST_F(PackingFormats, LammpsDumpHasTheLastSnapshotOrAnother) {
  FileSource file = source(dump_of_two_steps);
  auto bodies = read_bodies(file);
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {0.4, 0.5, 0.7}, 0.02);
  file.time_step = 100;
  bodies = read_bodies(file);
  ASSERT_EQ(bodies.size(), 2u);
  expect_body(bodies[0], {0.1, 0.2, 0.3}, 0.01, {1, 2, 3}, {4, 5, 6});
  expect_body(bodies[1], {0.4, 0.5, 0.6}, 0.02);
  file.particle_type = "3";
  EXPECT_EQ(read_bodies(file).size(), 1u);
  file.time_step = 150;
  EXPECT_EQ(problem(file), ": has no snapshot of time step 150; its time steps are 100 … 200, 2 of them");
}

TEST_F(PackingFormats, LammpsDumpIsChecked) {
  const std::string good = dump_of_two_steps;
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = good;
    return problem(changed.replace(changed.find(old), old.size(), text));
  };
  EXPECT_EQ(with("diameter z y x", "diameter zs ys xs"),
            ":20: the columns id type diameter zs ys xs have scaled coordinates; write x y z, as with dump custom id "
            "type x y z radius");
  EXPECT_EQ(with("type diameter z", "type mass z"), ":20: the columns id type mass z y x lack radius or diameter");
  EXPECT_EQ(problem(good.substr(0, good.find("2 3 0.04"))),
            ":20: the snapshot of time step 200 is cut off: it has 0 of 1 body");
  EXPECT_EQ(with("ATOMS\n2\n", "ATOMS\n15\n"), ":12: the snapshot of time step 100 is cut off: it has 2 of 15 bodies");
  const std::string begun = good + "ITEM: TIMESTEP\n300\nITEM: NUMBER OF ATOMS\n1\n";
  const std::string cut =
      ":22: the snapshot that begins here is cut off: it has no line ITEM: ATOMS; the file ends in line 25; choose "
      "another snapshot by time_step";
  EXPECT_EQ(problem(begun), cut);
  FileSource file = source(begun);
  file.time_step = 300;
  EXPECT_EQ(problem(file), cut);
  file.time_step = 200;
  EXPECT_EQ(problem(file), "");
  EXPECT_EQ(with("200\n", "2oo\n"), ":13: found \"2oo\"; expected a time step");
  EXPECT_THAT(problem("0 0 0 1\n", "lammps-dump"),
              testing::StartsWith(":1: found \"0 0 0 1\"; expected ITEM: TIMESTEP, with which"));
}

TEST_F(PackingFormats, YadeNamesItsFormat) {
  auto bodies = read("#format x_y_z_r_matId\n# comment\n1 2 3 4 0\n5 6 7 8 1\n");
  ASSERT_EQ(bodies.size(), 2u);
  expect_body(bodies[1], {5, 6, 7}, 8);
  bodies = read("#format x_y_z_r_attrs\n# x y z r coordination\n1 2 3 4 12 0.5\n");
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {1, 2, 3}, 4);
  FileSource file = source("#format id_x_y_z_r_matId\n9 1 2 3 4 0\n8 5 6 7 8 1\n");
  file.particle_type = "1";
  bodies = read_bodies(file);
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {5, 6, 7}, 8);
  EXPECT_EQ(problem("#format x_y_z_r_clumpId\n1 2 3 4 0\n"),
            ":1: the format of YADE is \"x_y_z_r_clumpId\"; allowed is one of id_x_y_z_r_matId, x_y_z_r, "
            "x_y_z_r_attrs, x_y_z_r_matId");
  EXPECT_EQ(problem("#format x_y_z_r\n1 2 3 4 5\n"), ":2: found 5 columns; expected 4: x y z radius");
  EXPECT_EQ(read("1 2 3 4\n# end\n5 6 7 8\n").size(), 2u);  // ymport.text
}

TEST_F(PackingFormats, XyzNamesItsProperties) {
  const std::string frame =
      "2\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=species:S:1:pos:R:3:Radius:R:1:velo:R:3:color:R:3 Time=0.5\n"
      "sand 1 2 3 4 0.1 0.2 0.3 1 0 0\nclay 5 6 7 8 0 0 0 1 0 0\n";
  auto bodies = read("1\nProperties=pos:R:3:radius:R:1\n9 9 9 9\n" + frame);
  ASSERT_EQ(bodies.size(), 2u);
  expect_body(bodies[0], {1, 2, 3}, 4, {0.1, 0.2, 0.3});
  FileSource file = source(frame);
  file.particle_type = "clay";
  bodies = read_bodies(file);
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {5, 6, 7}, 8);
  bodies = read("1\nProperties=\"Particle Type:S:1:Position:R:3:Radius:R:1\"\na 1 2 3 4\n");
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {1, 2, 3}, 4);

  EXPECT_EQ(problem("1\nProperties=pos:R:2:radius:R:1\n1 2 3\n"),
            ":2: the columns in \"Properties=pos:R:2:radius:R:1\" lack x, y, z");
  EXPECT_EQ(problem("3\nProperties=pos:R:3:radius:R:1\n1 2 3 4\n"),
            ":3: the last frame is cut off: it has 1 of 3 bodies");
  EXPECT_EQ(problem(source("1\nwater\nO 1 2 3\n", "grains.xyz")),
            ":2: found \"water\"; expected Properties=species:S:1:pos:R:3:radius:R:1 or the like, which names the "
            "columns");
}

TEST_F(PackingFormats, DemEngineNamesItsColumns) {
  const auto bodies = read("X,Y,Z,r,absv,v_x,v_y,v_z,w_x,w_y,w_z,family\n1,2,3,4,7,0.1,0.2,0.3,4,5,6,0\n");
  ASSERT_EQ(bodies.size(), 1u);
  expect_body(bodies[0], {1, 2, 3}, 4, {0.1, 0.2, 0.3}, {4, 5, 6});
  EXPECT_EQ(problem("X,Y,Z,Qw,Qx,Qy,Qz,clump_type\n1,2,3,1,0,0,0,ball\n"),
            ":1: the columns X Y Z Qw Qx Qy Qz clump_type lack radius or diameter");
}

TEST_F(PackingFormats, EachIsRecognised) {
  const auto format = [](const std::string& text, const std::string& name = "a.txt") {
    return recognised_format(text, name);
  };
  EXPECT_EQ(format(data_of_liggghts), "lammps-data");
  EXPECT_EQ(format(dump_of_two_steps), "lammps-dump");
  EXPECT_EQ(format("# a comment\n#format x_y_z_r\n1 2 3 4\n"), "yade");
  EXPECT_EQ(format("1\nProperties=pos:R:3:radius:R:1\n1 2 3 4\n"), "xyz");
  EXPECT_EQ(format("1\nof water\nO 2 3 4\n", "a.xyz"), "xyz");
  EXPECT_EQ(format("X,Y,Z,r\n1,2,3,4\n"), "dem-engine");
  EXPECT_EQ(format("# L 1 atoms\n1 2 3 4\n"), "text");
  EXPECT_EQ(format(""), "text");
}

TEST_F(PackingFormats, OthersAreNamed) {
  EXPECT_THAT(problem("\x1f\x8b\x08"), AllOf(HasSubstr(":1: found a gzip file, which is compressed; unpack it"),
                                             EndsWith("allowed is text, or a file of LAMMPS, LIGGGHTS, YADE or "
                                                      "DEM-Engine, or extended xyz")));
  EXPECT_THAT(problem("# vtk DataFile Version 3.0\n"), HasSubstr(":1: found a VTK file;"));
  EXPECT_THAT(problem("<?xml version=\"1.0\"?>\n"), HasSubstr(":1: found an XML file;"));
  FileSource file = source("1 2 3 4\n");
  file.time_step = 100;
  EXPECT_EQ(problem(file), ": is read as text, of which a time step cannot be chosen; remove time_step");
  file.time_step = -1, file.particle_type = "1";
  EXPECT_EQ(problem(file), ": has no types of particles; remove the particle type \"1\"");
}

Description scene_of_file(const Description& source) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, {});
  d["bodies"]["grains"]["source"] = source;
  d["bodies"]["grains"]["velocity"] = {0, 0, 1};
  return d;
}

TEST_F(PackingFormats, VelocitiesReachTheBodies) {
  const std::string path = folder.write("grains.data", data_of_liggghts).string();
  const Trial trial(scene_of_file({{"type", "file"}, {"path", path}, {"scale", "1 mm"}}));
  ASSERT_EQ(trial.world().ids().size(), 3u);
  EXPECT_LT((trial.position(1) - Vec3(0.04e-3, -0.05e-3, 0.06e-3)).norm(), 1e-18);
  EXPECT_LT((trial.velocity(0) - Vec3(-0.1e-3, 0, 1 + 0.5e-3)).norm(), 1e-15);
  EXPECT_EQ(trial.spin(0), Vec3(4, 5, 6));
}

TEST_F(PackingFormats, DescriptionIsChecked) {
  const auto message = [&](Description source) -> std::string {
    source["type"] = "file", source["path"] = folder.write("grains.txt", "1 2 3 4\n").string();
    try {
      scene_of(scene_of_file(source));
    } catch (const DescriptionError& error) {
      return error.what();
    }
    return "";
  };
  const std::string at = "/bodies/grains/source/";
  EXPECT_EQ(message({{"columns", {"x", "y", "z", "-", "-", "r"}}}), "");
  EXPECT_THAT(message({{"columns", {"x", "y", "z", "-"}}}),
              HasSubstr(at + "columns: found neither a radius nor a diameter; allowed is r or d"));
  EXPECT_THAT(message({{"columns", {"x", "y", "z", "r", "d"}}}),
              HasSubstr(at + "columns: found a radius and a diameter; allowed is r or d"));
  EXPECT_THAT(message({{"columns", {"x", "y", "r"}}}), HasSubstr("found no column z; allowed is x, y, z and r or d"));
  EXPECT_THAT(message({{"columns", {"x", "y", "z", "r", "x"}}}),
              HasSubstr(at + "columns/4: found a second column x; allowed is one; - skips a column"));
  EXPECT_THAT(message({{"columns", {"x", "y", "z", "rad"}}}), HasSubstr(at + "columns/3: found \"rad\""));
  EXPECT_THAT(message({{"format", "yade"}, {"columns", {"x", "y", "z", "r"}}}),
              HasSubstr(at + "columns: found columns of the format yade; allowed is none; the file names them"));
  EXPECT_THAT(message({{"format", "xyz"}, {"header_lines", 1}}),
              HasSubstr(at + "header_lines: found lines to skip in the format xyz; allowed is 0"));
  EXPECT_THAT(message({{"format", "text"}, {"time_step", 1}}),
              HasSubstr(at + "time_step: found a time step in the format text; allowed is -1"));
  EXPECT_THAT(message({{"format", "vtk"}}), HasSubstr(at + "format: found \"vtk\""));
}

TEST_F(PackingFormats, ErrorsOfAFileEndTheCommandWithItsLine) {
  folder.write("grains.data", "title\n\n1 atoms\n\nAtoms # atomic\n\n1 1 0 0 0\n");
  folder.write("scene.json", scene_of_file({{"type", "file"}, {"path", "grains.data"}}).dump());
  const Outcome outcome = grit_in(folder.path(), {"check", "scene.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("grains.data:5: the atom style is \"atomic\""));
}

}  // namespace
}  // namespace grit::test::packing_formats_tests
