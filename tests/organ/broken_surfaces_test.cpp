#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numbers>

#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/mesh_pieces.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

constexpr double kBall = 4.0 / 3 * std::numbers::pi * 1.25e-4;  // [m^3], of 50 mm radius

TriangleMesh make_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh box;
  for (int i = 0; i < 8; ++i)
    box.nodes.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z());
  for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    box.triangles.push_back({a, b, c});
    box.triangles.push_back({a, c, d});
  }
  return box;
}

/// A surface of real life: how its file is written, what is said, and what comes of it.
struct Broken {
  std::string name, bytes, options;
  std::vector<std::string> said;  ///< in the output, or in the refusal
  double volume = 0;              ///< [m^3] of the mesh; 0: it is refused
  double within = 0.01;           ///< of the volume
};

std::string stl(const TriangleMesh& mesh) {
  return binary_stl(mesh, "made by hand", static_cast<std::uint32_t>(mesh.triangles.size()));
}

std::string obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& x : mesh.nodes) text += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

std::string vtk(const TriangleMesh& mesh) {
  std::string text =
      fmt::format("# vtk DataFile Version 3.0\nball\nASCII\nDATASET POLYDATA\nPOINTS {} double\n", mesh.nodes.size());
  for (const Eigen::Vector3d& x : mesh.nodes) text += fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
  text += fmt::format("POLYGONS {} {}\n", mesh.triangles.size(), 4 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

std::vector<Broken> broken_surfaces() {
  const TriangleMesh ball = make_sphere({0, 0, 0}, 50, 20);  // millimetres
  const std::string mm = "--unit mm --nodes 300";
  std::vector<Broken> all;
  TriangleMesh holes = ball;
  holes.triangles.erase(holes.triangles.begin() + 300, holes.triangles.begin() + 302);
  holes.triangles.erase(holes.triangles.begin() + 100);
  all.push_back({"holes.stl", stl(holes), mm, {"a hole of", "mm across with", "(the first of 3 holes)"}, kBall});
  TriangleMesh flipped = ball;
  for (const int t : {4, 40, 41, 700}) std::swap(flipped.triangles[t][0], flipped.triangles[t][1]);
  all.push_back(
      {"flipped.stl", stl(flipped), mm, {"4 triangles turned against their neighbours, the first at"}, kBall});
  TriangleMesh doubled = ball;
  append(doubled, ball);
  all.push_back({"doubled.stl", stl(doubled), mm, {"1600 triangles that are there twice"}, kBall});
  TriangleMesh crossing = ball;
  append(crossing, make_sphere({60, 1, 2}, 40, 16));
  // Both balls less the lens that they share.
  const double lens = std::numbers::pi * std::pow(90 - 60.0415, 2) * (60.0415 * 60.0415 + 2 * 60.0415 * 90 - 3 * 100) /
                      (12 * 60.0415) * 1e-9;
  all.push_back({"crossing.stl",
                 stl(crossing),
                 mm,
                 {"pairs of triangles that cross one another, the first at"},
                 kBall + 4.0 / 3 * std::numbers::pi * 6.4e-5 - lens,
                 0.05});
  TriangleMesh at_node = make_box({0, 0, 0}, {40, 40, 40});
  append(at_node, make_box({40, 40, 40}, {60, 60, 60}));
  all.push_back(
      {"at_node.stl", stl(at_node), mm + " --deviation 0.002", {"a stray shell of 12 triangles"}, 6.4e-5, 0.02});
  TriangleMesh at_edge = make_box({0, 0, 0}, {40, 40, 40});
  append(at_edge, make_box({40, 40, 0}, {60, 60, 40}));
  all.push_back({"at_edge.stl",
                 stl(at_edge),
                 mm + " --deviation 0.002",
                 {"edges that more than two triangles share, the first at"},
                 6.4e-5,
                 0.02});
  all.push_back({"metres.stl", stl(ball), "--nodes 300", {"warning: 100 m across: is --unit right?"}, 1e9 * kBall});
  TriangleMesh far = ball;
  far.nodes.emplace_back(1e8, 0, 0);
  all.push_back({"far.obj", obj(far), mm, {"1 node that no triangle uses, the first at (1e+08, 0, 0) mm"}, kBall});
  all.push_back({"lying.stl",
                 binary_stl(ball, "solid ball", 7),
                 mm,
                 {"first line is that of a text file", "announces 7 triangles and the file holds 1600"},
                 kBall});
  all.push_back({"text.stl",
                 text_stl(ball),
                 mm + " --group a=above:z --group b=box:-1,-1,-1,1,1,0 --group c=plane:0,0,0,1,0,0",
                 {"nothing to repair", "group 'a'", "group 'b'", "group 'c'"},
                 kBall});
  all.push_back({"ball.vtk", vtk(ball), mm, {"1600 triangles", "nothing to repair"}, kBall});
  const TriangleMesh many = make_sphere({0, 0, 0}, 50, 158);
  all.push_back({"many.stl", stl(many), mm, {"99856 triangles", "nothing to repair"}, kBall});
  TriangleMesh half = ball;
  std::erase_if(half.triangles, [&](const auto& t) { return ball.nodes[t[0]].z() > 0; });
  all.push_back({"half.stl", stl(half), mm, {"half.stl: a hole of", "larger than", "--hole"}});
  all.push_back({"slab.stl",
                 stl(make_box({0, 0, 0}, {200, 100, 0.8})),
                 mm,
                 {"its walls are 0.8 mm thick at (", "ask for --edge 0.0008, which is about"}});
  TriangleMesh shell = ball, inner = make_sphere({0, 0, 0}, 48.5, 20);
  append(shell, inner);
  all.push_back({"shell.stl", stl(shell), mm, {"its walls are 1.", "mm thick at (", "ask for --edge 0.001"}});
  constexpr std::array kLong{"doubled.stl", "at_edge.stl", "metres.stl", "ball.vtk", "many.stl"};
  if (!std::getenv("PALPATE_LONG_TESTS"))
    std::erase_if(all, [&](const Broken& broken) { return std::ranges::find(kLong, broken.name) != kLong.end(); });
  return all;
}

class BrokenSurface : public ::testing::TestWithParam<Broken> {
 protected:
  const OwnFolder folder_{"broken"};
};

TEST_P(BrokenSurface, EndsInAGoodMeshOrInWordsThatSayWhere) {
  const Broken& broken = GetParam();
  const auto file = write_file(folder_ / broken.name, broken.bytes), mesh = folder_ / "a.msh";
  const ProgramResult made =
      run_program(program("palpate") + " mesh " + file.string() + " " + broken.options + " -o " + mesh.string());
  EXPECT_EQ((made.out + made.err).find("CGAL"), std::string::npos) << made.out << made.err;
  for (const std::string& part : broken.said)
    EXPECT_NE((broken.volume > 0 ? made.out : made.err).find(part), std::string::npos) << "lacks '" << part << "':\n"
                                                                                       << made.out << made.err;
  ASSERT_EQ(made.status, broken.volume > 0 ? 0 : 1) << made.err;
  ASSERT_EQ(std::filesystem::exists(mesh), broken.volume > 0);
  if (broken.volume == 0) return;
  const TetMesh body = load_tet_mesh(mesh, 1);
  const MeshMeasures measures = measures_of(body);
  EXPECT_NEAR(measures.volume, broken.volume, broken.within * broken.volume);
  EXPECT_GE(measures.min_angle, 12);
  EXPECT_EQ(topology_of(body), (Topology{1, 0}));
}

INSTANTIATE_TEST_SUITE_P(Surfaces, BrokenSurface, ::testing::ValuesIn(broken_surfaces()), [](const auto& surface) {
  return surface.param.name.substr(0, surface.param.name.find('.')) + (surface.param.name.ends_with("k") ? "_vtk" : "");
});

}  // namespace
}  // namespace palpate
