#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/mesh/generators.hpp"
#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/fineness_options.hpp"
#include "tools/organ/mesh_pieces.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

class MeshCommand : public ::testing::Test {
 protected:
  ProgramResult mesh(const std::string& arguments) const {
    return run_program(program("palpate") + " mesh " + arguments);
  }
  /// Of a surface, held at its bottom, with edges of 20 mm; where it was written.
  std::string mesh_of(const std::string& surface, const std::string& name, const std::string& more = "") const {
    const std::string output = (folder_ / name).string();
    const auto made =
        mesh(surface + " --group attachment=below:z --edge 0.02 --deviation 0.002" + more + " -o " + output);
    EXPECT_EQ(made.status, 0) << made.err;
    return output;
  }
  const OwnFolder folder_{"organ"};
};

TEST_F(MeshCommand, ABallInMillimetresBecomesAGoodMeshOfItsVolumeAndTheSameAgain) {
  const TriangleMesh ball = make_sphere({20, 0, 0}, 50, 40);
  const auto file = write_file(folder_ / "ball.stl", binary_stl(ball, "solid ball", 0));
  const std::string command =
      fmt::format("{} --unit mm --nodes 500 --group attachment=below:z --fine 0.07,0,0,0.01:0.004 -o ", file.string());
  const auto made = mesh(command + (folder_ / "a.msh").string());
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find("announces 0 triangles"), std::string::npos) << made.out;
  const TetMesh body = load_tet_mesh(folder_ / "a.msh", 1);
  const MeshMeasures m = measures_of(body);
  EXPECT_NEAR(m.volume, 4.0 / 3 * std::numbers::pi * 1.25e-4, 5e-3 * 5.236e-4);
  EXPECT_GE(m.min_angle, 12);
  EXPECT_NEAR(static_cast<double>(body.nodes.size()), 500, 50);
  for (const int n : body.groups.at("attachment").nodes) EXPECT_LE(body.nodes[n].z(), -0.05 + 0.0105);
  const Surface surface = extract_surface(body);
  EXPECT_EQ(static_cast<int>(surface.nodes.size()) * 2 - 4, static_cast<int>(surface.triangles.size()));  // one sphere
  int near = 0;
  for (const int n : surface.nodes) near += (body.nodes[n] - Eigen::Vector3d(0.07, 0, 0)).norm() < 0.01;
  EXPECT_GT(near, 20) << "not finer where it was told";
  const auto again = mesh(command + (folder_ / "b.msh").string());
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(text_of(folder_ / "a.msh"), text_of(folder_ / "b.msh"));
}

TEST_F(MeshCommand, TheRadiusOfAToolMakesItFinerOnTheSideThatIsNotHeld) {
  const auto file = write_file(folder_ / "ball.stl", text_stl(make_sphere({0, 0, 0}, 0.05, 20))).string();
  const std::string to = " --edge 0.02 --deviation 0.002 -o " + (folder_ / "a.msh").string();
  const auto made = mesh(file + " --group attachment=below:z --tool-radius 0.008" + to);
  ASSERT_EQ(made.status, 0) << made.err;
  const TetMesh body = load_tet_mesh(folder_ / "a.msh", 1);
  int near = 0, opposite = 0;
  for (const int n : extract_surface(body).nodes) {
    near += (body.nodes[n] - Eigen::Vector3d(0, 0, 0.05)).norm() < 0.02;
    opposite += (body.nodes[n] + Eigen::Vector3d(0, 0, 0.05)).norm() < 0.02;
  }
  EXPECT_GT(near, 5 * opposite) << made.out;
  expect_refusal(program("palpate") + " mesh " + file + " --tool-radius 0.008" + to, {"--tool-radius needs a --group"});
}

TEST_F(MeshCommand, ASceneMakesItFinerWhereItsToolsGo) {
  const auto file = write_file(folder_ / "ball.stl", text_stl(make_sphere({0, 0, 0}, 0.05, 20))).string();
  const std::string coarse = mesh_of(file, "a.msh"), scene = (folder_ / "a.toml").string();
  const auto made = run_program(program("palpate") + " scene " + coarse + " --tissue liver --radius 0.005 -o " + scene);
  ASSERT_EQ(made.status, 0) << made.err;
  const TetMesh body = load_tet_mesh(mesh_of(file, "b.msh", " --for " + scene), 1);
  int near = 0, opposite = 0;  // the scene's tool comes from the side that is not held
  for (const int n : extract_surface(body).nodes) {
    near += (body.nodes[n] - Eigen::Vector3d(0, 0, 0.05)).norm() < 0.02;
    opposite += (body.nodes[n] + Eigen::Vector3d(0, 0, 0.05)).norm() < 0.02;
  }
  EXPECT_GT(near, 5 * opposite);
  const auto far = write_file(folder_ / "far.stl", text_stl(make_sphere({1, 0, 0}, 0.05, 8))).string();
  const auto missed = mesh(far + " --edge 0.02 --for " + scene + " -o " + (folder_ / "c.msh").string());
  EXPECT_EQ(missed.status, 0) << missed.err;
  EXPECT_NE(missed.out.find("warning: no tool of " + scene + " comes here"), std::string::npos) << missed.out;
  const auto absent = mesh(far + " --for none.toml -o " + (folder_ / "c.msh").string());
  EXPECT_EQ(absent.status, 1);
  EXPECT_NE(absent.err.find("none.toml"), std::string::npos) << absent.err;
}

TEST_F(MeshCommand, AFinePlaceThatMakesNothingFinerIsWarnedOf) {
  const auto file = write_file(folder_ / "ball.stl", text_stl(make_sphere({0, 0, 0}, 0.05, 20))).string();
  const std::string fine = file + " --edge 0.03 --deviation 0.004 -o " + (folder_ / "a.msh").string() + " --fine ";
  const auto far = mesh(fine + "1,0,0,0.01:0.005");
  EXPECT_NE(far.out.find("warning: --fine 1,0,0,0.01:0.005 reaches no part of the body"), std::string::npos) << far.out;
  const auto coarse = mesh(fine + "0.05,0,0,0.01:0.05");
  EXPECT_NE(coarse.out.find("warning: --fine 0.05,0,0,0.01:0.05 asks for edges of 50 mm, where they are 3"),
            std::string::npos)
      << coarse.out;
  const auto good = mesh(fine + "0.05,0,0,0.01:0.01 --fine=-0.01,-0.01,-0.01,0.01,0.01,0.01:0.02");
  EXPECT_EQ(good.out.find("warning"), std::string::npos) << good.out;
}

TEST_F(MeshCommand, WhatIsFoundIsToldAndReportedBeforeARefusal) {
  TriangleMesh half = make_sphere({0, 0, 0}, 0.05, 12);
  std::erase_if(half.triangles, [&](const auto& t) { return half.nodes[t[0]].z() > 0; });
  half.triangles.push_back(half.triangles[40]);
  const auto file = write_file(folder_ / "half.stl", text_stl(half)), report = folder_ / "found.csv";
  const auto refused =
      mesh(fmt::format("{} --report {} -o {}", file.string(), report.string(), (folder_ / "a.msh").string()));
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("half.stl: a hole of"), std::string::npos) << refused.err;
  EXPECT_NE(refused.out.find("found: 1 triangle that is there twice"), std::string::npos) << refused.out;
  for (const char* row : {"1 triangle that is there twice", "a hole of"})
    EXPECT_NE(text_of(report).find(row), std::string::npos) << text_of(report);
}

TEST_F(MeshCommand, FiguresArePrintedAsOneLineOfJson) {
  TriangleMesh twice = make_sphere({0, 0, 0}, 0.05, 20);
  twice.triangles.push_back(twice.triangles[40]);
  const auto file = write_file(folder_ / "ball.stl", text_stl(twice)).string();
  const auto made = mesh(fmt::format("{} --group held=below:z --edge 0.02 --deviation 0.002 --json -o {}", file,
                                     (folder_ / "a.msh").string()));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(std::ranges::count(made.out, '\n'), 1) << made.out;
  const auto json = nlohmann::json::parse(made.out);
  const TetMesh body = load_tet_mesh(folder_ / "a.msh", 1);
  EXPECT_EQ(json["triangles"], twice.triangles.size());
  EXPECT_EQ(json["found"][0]["what"], "1 triangle that is there twice");
  ASSERT_EQ(json["meshes"].size(), 1u);
  const auto& figures = json["meshes"][0];
  EXPECT_EQ(figures["nodes"], body.nodes.size());
  EXPECT_EQ(figures["groups"]["held"]["nodes"], body.groups.at("held").nodes.size());
  EXPECT_NEAR(figures["volume_m3"], measures_of(body).volume, 1e-9);
  EXPECT_NEAR(figures["mass_kg"], 1060 * measures_of(body).volume, 1e-6);
  EXPECT_TRUE(json["warnings"].empty());
}

/// [bytes] That `palpate check` says that a program, or the disk, takes.
std::size_t checked_bytes(const nlohmann::json& checked, const std::string& owner) {
  std::size_t sum = 0;
  for (const auto& part : checked["memory"]) sum += part["owner"] == owner ? part["bytes"].get<std::size_t>() : 0;
  return sum;
}

// 2,402 nodes of the surface, whose tensors are compressed: whole they are 208 MB.
TEST_F(MeshCommand, WhatAFineMeshIsSaidToTakeIsWhatCheckSays) {
  MeshOptions options;
  options.output = (folder_ / "block.msh").string();
  Output said(true);
  said.next_mesh();
  finish_mesh(make_block({0, 0, 0}, {0.1, 0.1, 0.1}, {20, 20, 20}), options, said);
  const auto check = run_program(program("palpate") + " check --json " + options.output);
  ASSERT_EQ(check.status, 0) << check.err;
  const auto checked = nlohmann::json::parse(check.out);
  EXPECT_EQ(said.mesh()["archive_bytes"], checked_bytes(checked, "disk"));
  EXPECT_EQ(said.mesh()["haptic_node_bytes"], checked_bytes(checked, "haptic_node"));
  EXPECT_LT(said.mesh()["archive_bytes"], 60e6);
}

// 2,402 nodes of the surface, of which 441 are held: too few for compressed tensors.
TEST_F(MeshCommand, WhatAHeldMeshIsSaidToTakeIsWhatItsSceneTakes) {
  MeshOptions options;
  options.output = (folder_ / "block.msh").string();
  options.groups = {"attachment=below:z:0.001"};
  Output said(true);
  said.next_mesh();
  finish_mesh(make_block({0, 0, 0}, {0.1, 0.1, 0.1}, {20, 20, 20}), options, said);
  const std::string scene = (folder_ / "block.toml").string();
  const auto made = run_program(program("palpate") + " scene " + options.output + " --tissue liver -o " + scene);
  ASSERT_EQ(made.status, 0) << made.err;
  const auto check = run_program(program("palpate") + " check --json " + scene);
  ASSERT_EQ(check.status, 0) << check.err;
  const auto checked = nlohmann::json::parse(check.out)["bodies"][0];
  const auto archive = static_cast<double>(checked_bytes(checked, "disk"));
  EXPECT_GT(archive, 100e6);
  EXPECT_NEAR(said.mesh()["archive_bytes"].get<double>(), archive, 0.02 * archive);
  const auto haptic = static_cast<double>(checked_bytes(checked, "haptic_node"));
  EXPECT_NEAR(said.mesh()["haptic_node_bytes"].get<double>(), haptic, 0.05 * haptic);
}

// In the long tests as many as a scanner gives, in docs/organ.md with its time; a hundredth of that otherwise.
TEST_F(MeshCommand, AMillionTrianglesOfALobedBodyBecomeAMesh) {
  const bool for_long = std::getenv("PALPATE_LONG_TESTS") != nullptr;
  TriangleMesh body = make_sphere({0, 0, 0}, 1, for_long ? 500 : 50);
  for (Eigen::Vector3d& x : body.nodes)
    x = (1 + 0.12 * std::sin(5 * x.x()) * std::cos(4 * x.y() + x.z()) + 0.03 * std::sin(23 * x.x() + 17 * x.z())) *
        x.cwiseProduct(Eigen::Vector3d(0.09, 0.06, 0.04));
  const auto file =
      write_file(folder_ / "lobed.stl", binary_stl(body, "", static_cast<std::uint32_t>(body.triangles.size())));
  const std::string output = folder_ / "a.msh", said = folder_ / "said";
  ASSERT_EQ(run_command(fmt::format("timeout 600 {} mesh {} --nodes {} -o {} >{} 2>&1", program("palpate"),
                                    file.string(), for_long ? 1500 : 400, output, said)),
            0)
      << text_of(said);
  const TetMesh filled = load_tet_mesh(output, 1);
  EXPECT_NEAR(measures_of(filled).volume, enclosed_volume(body), 0.002 * enclosed_volume(body));
  EXPECT_EQ(topology_of(filled), (Topology{1, 0}));
}

TEST_F(MeshCommand, MistakesAreToldInASentence) {
  const auto file = write_file(folder_ / "ball.stl", text_stl(make_sphere({0, 0, 0}, 0.05, 8))).string();
  const std::string to = " -o " + (folder_ / "a.msh").string();
  expect_refusal(program("palpate") + " mesh " + file + " --group held=near:z" + to,
                 {"--group held=near:z", "NAME=PLACE"});
  const std::string twice = program("palpate") + " mesh nowhere.stl --group held=below:z --group held=above:z";
  expect_refusal(twice + to, {"--group held=above:z: there are two groups of that name"});  // before anything is read
  for (const char* name : {R"(a\"b)", R"(a\\b)", "a\nb"})  // as a shell has them in quotes
    expect_refusal(fmt::format("{} mesh {} --group \"{}=below:z\"{}", program("palpate"), file, name, to),
                   {"--group a", "a name has no quotes, backslashes or control characters"});
  expect_refusal(program("palpate") + " mesh " + file + " --fine 1,2,3:0.1" + to,
                 {"--fine 1,2,3:0.1", "x,y,z,RADIUS:EDGE"});
  expect_refusal(program("palpate") + " mesh " + (folder_ / "none.stl").string() + to,
                 {"none.stl: the file does not exist"});
  expect_refusal(program("palpate") + " mesh none.stl -o nowhere/a.msh",
                 {"nowhere/a.msh: it cannot be written, since the folder ", "nowhere is not there"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.msh"));
}

}  // namespace
}  // namespace palpate
