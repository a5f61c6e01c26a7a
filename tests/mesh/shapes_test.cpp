#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "common/mesh/fill.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"
#include "tools/generate/cylinders.hpp"
#include "tools/generate/flips.hpp"
#include "tools/generate/hepatectomy.hpp"
#include "tools/generate/liver.hpp"
#include "tools/generate/plate.hpp"
#include "tools/generate/plate_cut.hpp"
#include "tools/generate/ribs.hpp"
#include "tools/generate/wrap.hpp"

namespace palpate {
namespace {

const std::filesystem::path kMeshes = PALPATE_SOURCE "/scenes/meshes";

void expect_same(const TetMesh& made, const TetMesh& stored) {
  ASSERT_EQ(made.nodes.size(), stored.nodes.size());
  for (std::size_t n = 0; n < made.nodes.size(); ++n) EXPECT_LT((made.nodes[n] - stored.nodes[n]).norm(), 1e-9);
  EXPECT_EQ(made.tetrahedra, stored.tetrahedra);
  for (const auto& [name, group] : made.groups) {
    EXPECT_EQ(group.nodes, stored.groups.at(name).nodes) << name;
    EXPECT_EQ(group.tetrahedra, stored.groups.at(name).tetrahedra) << name;
  }
}

TEST(Liver, IsWhatItsGeneratorMakes) {
  expect_same(make_liver({}), load_tet_mesh(kMeshes / "liver.msh", 1));
}

TEST(Liver, HasThePapersSizeAHumansExtentAndGoodElements) {
  const TetMesh liver = load_tet_mesh(kMeshes / "liver.msh", 1);
  EXPECT_NEAR(liver.nodes.size(), 1400, 0.03 * 1400);
  EXPECT_NEAR(liver.tetrahedra.size(), 6500, 0.03 * 6500);
  Eigen::Vector3d low = liver.nodes[0], high = low;
  for (const auto& x : liver.nodes) low = low.cwiseMin(x), high = high.cwiseMax(x);
  EXPECT_LT((high - low - Eigen::Vector3d(0.26, 0.165, 0.125)).cwiseAbs().maxCoeff(), 0.006);
  EXPECT_LT((0.5 * (high + low)).cwiseAbs().maxCoeff(), 0.006);
  EXPECT_NEAR(volume_of(liver), 1.9e-3, 0.1e-3);
  for (const auto& t : liver.tetrahedra) EXPECT_GT(min_dihedral_angle(liver, t), 18 * std::numbers::pi / 180);
}

TEST(Liver, SurfaceNodesLieOnTheShapeAndTrianglesAreEven) {
  const TetMesh liver = load_tet_mesh(kMeshes / "liver.msh", 1);
  const Surface surface = extract_surface(liver);
  const ImplicitShape shape = liver_shape();
  EXPECT_EQ(surface.nodes.size(), 642u);
  for (int n : surface.nodes) EXPECT_LT(std::abs(shape(liver.nodes[n])), 2e-6);
  for (const auto& t : surface.triangles) {
    for (int c = 0; c < 3; ++c) {
      const double edge = (liver.nodes[t[c]] - liver.nodes[t[(c + 1) % 3]]).norm();
      EXPECT_GT(edge, 0.006);
      EXPECT_LT(edge, 0.024);
    }
  }
}

TEST(Liver, AttachmentIsAPatchOfTheUpperBackOfTheRightLobe) {
  const TetMesh liver = load_tet_mesh(kMeshes / "liver.msh", 1);
  const Surface surface = extract_surface(liver);
  const auto& nodes = liver.groups.at("attachment").nodes;
  EXPECT_GT(nodes.size(), 30u);
  EXPECT_LT(nodes.size(), 100u);
  for (int n : nodes) {
    EXPECT_TRUE(std::binary_search(surface.nodes.begin(), surface.nodes.end(), n));
    EXPECT_GT(liver.nodes[n].y(), 0.02);
    EXPECT_LT(liver.nodes[n].x(), 0.03);
  }
}

TEST(Plate, IsWhatItsGeneratorMakesWithFourCorners) {
  const TetMesh plate = load_tet_mesh(kMeshes / "plate.msh", 1);
  expect_same(make_plate(), plate);
  const auto& corners = plate.groups.at("corners").nodes;
  EXPECT_EQ(corners.size(), 4u * 9 * 3);
  for (int n : corners) EXPECT_GT(plate.nodes[n].head<2>().cwiseAbs().minCoeff(), 0.038);
}

TEST(Cylinder, FileHasTheSizeOfTheBrainSpecimen) {
  const TetMesh cylinder = load_tet_mesh(kMeshes / "cylinder.msh", 1);
  expect_same(make_cylinder(0.015, 0.013, 6, 6), cylinder);
}

double min_angle(const TetMesh& mesh) {
  double angle = std::numbers::pi;
  for (const auto& t : mesh.tetrahedra) angle = std::min(angle, min_dihedral_angle(mesh, t));
  return angle * 180 / std::numbers::pi;
}

TetMesh part_of(const TetMesh& mesh, const std::string& group) {
  TetMesh part;
  part.nodes = mesh.nodes;
  for (int t : mesh.groups.at(group).tetrahedra) part.tetrahedra.push_back(mesh.tetrahedra[t]);
  return part;
}

TEST(FlipFaces, AddsATetrahedronEachAndKeepsVolumeSurfaceAndSoundness) {
  TetMesh mesh = make_block_of_five({0, 0, 0}, {4, 3, 2}, {4, 3, 2});
  const double volume = volume_of(mesh);
  const std::size_t before = mesh.tetrahedra.size();
  const std::vector<int> surface = extract_surface(mesh).nodes;
  flip_faces(mesh, 5);
  EXPECT_EQ(mesh.tetrahedra.size(), before + 5);
  EXPECT_NO_THROW(check_tet_mesh(mesh, "flipped"));
  EXPECT_NEAR(volume_of(mesh), volume, 1e-12);
  EXPECT_EQ(extract_surface(mesh).nodes, surface);
}

TEST(FlipFaces, RefusesMoreThanThereAre) {
  TetMesh two;
  two.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1}, {0.3, 0.3, -1}};
  two.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  EXPECT_NE(sentence_of([&] { flip_faces(two, 2); }), "");
  flip_faces(two, 1);
  EXPECT_EQ(two.tetrahedra.size(), 3u);
  EXPECT_NEAR(volume_of(two), 1.0 / 3, 1e-15);
}

TEST(PlateCut, IsWhatItsGeneratorMakesWithThePapersCounts) {
  const TetMesh plate = load_tet_mesh(kMeshes / "plate_cut.msh", 1);
  expect_same(make_plate_cut(), plate);
  EXPECT_EQ(plate.nodes.size(), 759u);
  EXPECT_EQ(plate.tetrahedra.size(), 2212u);
  EXPECT_EQ(plate.groups.at("corners").nodes.size(), 4u * 4 * 3);
  EXPECT_NEAR(volume_of(plate), 0.05 * 0.11 * 0.01, 1e-16);
  EXPECT_GT(min_angle(plate), 35);
}

TEST(CylinderTear, IsWhatItsGeneratorMakesWithThePapersCounts) {
  const TetMesh cylinder = load_tet_mesh(kMeshes / "cylinder_tear.msh", 1);
  expect_same(make_cylinder_tear(), cylinder);
  EXPECT_EQ(cylinder.nodes.size(), 248u);
  EXPECT_EQ(cylinder.tetrahedra.size(), 889u);
  EXPECT_EQ(cylinder.groups.at("top").nodes.size(), 31u);
  EXPECT_EQ(cylinder.groups.at("bottom").nodes.size(), 31u);
  EXPECT_EQ(cylinder.groups.at("side").nodes.size(), 18u * 8);
  EXPECT_NEAR(volume_of(cylinder), 0.05 * 9 * std::sin(std::numbers::pi / 9) * 0.015 * 0.015, 1e-11);
  EXPECT_GT(min_angle(cylinder), 13.9);
}

// RR3510 fig. 4b: two blocks, of which only the corners of the common face coincide.
TEST(PartialBlocks, AreWhatTheGeneratorMakesAndShareFourNodes) {
  const TetMesh fine = load_tet_mesh(kMeshes / "block_fine.msh", 1),
                coarse = load_tet_mesh(kMeshes / "block_coarse.msh", 1);
  expect_same(make_block({-0.015, -0.015, 0}, {0.015, 0.015, 0.025}, {5, 5, 4}), fine);
  expect_same(make_block({-0.015, -0.015, -0.025}, {0.015, 0.015, 0}, {3, 3, 3}), coarse);
  const auto shared = std::ranges::count_if(fine.nodes, [&](const Eigen::Vector3d& x) {
    return std::ranges::any_of(coarse.nodes, [&](const Eigen::Vector3d& y) { return (x - y).norm() < 1e-6; });
  });
  EXPECT_EQ(shared, 4);
}

TEST(CylinderHybrid, IsWhatItsGeneratorMakesInTwoEqualHalves) {
  const TetMesh cylinder = load_tet_mesh(kMeshes / "cylinder_hybrid.msh", 1);
  expect_same(make_cylinder_hybrid(), cylinder);
  const MeshGroup &lower = cylinder.groups.at("lower"), &upper = cylinder.groups.at("upper");
  EXPECT_EQ(lower.tetrahedra.size(), upper.tetrahedra.size());
  EXPECT_EQ(lower.tetrahedra.size() + upper.tetrahedra.size(), cylinder.tetrahedra.size());
  std::vector<int> shared;
  std::set_intersection(lower.nodes.begin(), lower.nodes.end(), upper.nodes.begin(), upper.nodes.end(),
                        std::back_inserter(shared));
  EXPECT_EQ(shared.size(), 61u);
  for (int n : shared) EXPECT_EQ(cylinder.nodes[n].z(), 0.025);
}

TEST(Hepatectomy, IsWhatItsGeneratorMakesOfThePapersSize) {
  const TetMesh liver = load_tet_mesh(kMeshes / "hepatectomy.msh", 1);
  expect_same(make_hepatectomy(), liver);
  EXPECT_NEAR(liver.nodes.size(), 1537, 0.02 * 1537);
  EXPECT_NEAR(liver.tetrahedra.size(), 7039, 0.02 * 7039);
  EXPECT_NEAR(liver.groups.at("segment").tetrahedra.size() / double(liver.tetrahedra.size()), 0.18, 0.005);
  EXPECT_GT(min_angle(liver), 20);
}

TEST(Hepatectomy, PartsAreSoundAndMakeUpTheWhole) {
  const TetMesh liver = load_tet_mesh(kMeshes / "hepatectomy.msh", 1);
  const TetMesh segment = part_of(liver, "segment"), remnant = part_of(liver, "remnant");
  EXPECT_EQ(segment.tetrahedra.size() + remnant.tetrahedra.size(), liver.tetrahedra.size());
  EXPECT_NO_THROW(check_tet_mesh(segment, "segment"));
  EXPECT_NO_THROW(check_tet_mesh(remnant, "remnant"));
  for (int n : liver.groups.at("segment").nodes) EXPECT_GT(liver.nodes[n].x(), 0.03);
}

TEST(Ribs, FileIsSmallAndStaysClearOfTheLiver) {
  const TriangleMesh ribs = load_triangle_mesh(kMeshes / "ribs.stl", 1);
  EXPECT_LT(ribs.triangles.size(), 8000u);
  EXPECT_LT(std::filesystem::file_size(kMeshes / "ribs.stl"), 300000u);
  EXPECT_EQ(ribs.triangles.size(), make_ribs().triangles.size());
  const ImplicitShape liver = liver_shape();
  for (const auto& x : ribs.nodes) EXPECT_GT(liver(x), 0.005);
}

TEST(Ribs, BonesFaceOutwardAndTheWallInward) {
  const TriangleMesh ribs = make_ribs();
  constexpr std::size_t kWall = 2 * (4 + 4 + 6) * 36 - 2 * 36;  // both domes end in a point
  const std::size_t bones = ribs.triangles.size() - kWall;
  const std::vector<std::array<int, 3>> tubes(ribs.triangles.begin(), ribs.triangles.begin() + bones);
  EXPECT_GT(enclosed_volume(ribs.nodes, tubes), 0);
  for (std::size_t i = bones; i < ribs.triangles.size(); ++i) {
    const auto& [a, b, c] = ribs.triangles[i];
    const Eigen::Vector3d normal = (ribs.nodes[b] - ribs.nodes[a]).cross(ribs.nodes[c] - ribs.nodes[a]);
    const Eigen::Vector3d middle = (ribs.nodes[a] + ribs.nodes[b] + ribs.nodes[c]) / 3;
    EXPECT_LT(normal.dot(middle - Eigen::Vector3d(0.02, 0, -0.1)), 0);
  }
}

TEST(GeodesicSphere, HasTheCountsAndIsClosedOutward) {
  for (int f : {1, 2, 5}) {
    const TriangleMesh sphere = geodesic_sphere(f);
    EXPECT_EQ(sphere.nodes.size(), 10u * f * f + 2);
    EXPECT_EQ(sphere.triangles.size(), 20u * f * f);
    EXPECT_GT(enclosed_volume(sphere.nodes, sphere.triangles), 2);
  }
}

TEST(Fill, KeepsTheSurfaceAndItsNumbers) {
  const TriangleMesh sphere = geodesic_sphere(4);
  const TetMesh ball = fill_surface(sphere, 0.4);
  for (std::size_t n = 0; n < sphere.nodes.size(); ++n) EXPECT_EQ(ball.nodes[n], sphere.nodes[n]);
  EXPECT_NO_THROW(check_tet_mesh(ball, "ball"));
  EXPECT_NEAR(volume_of(ball), enclosed_volume(sphere.nodes, sphere.triangles), 1e-12);
  EXPECT_GT(ball.nodes.size(), sphere.nodes.size());
}

TEST(Fill, RefusesAnOpenSurface) {
  TriangleMesh sphere = geodesic_sphere(3);
  sphere.triangles.resize(sphere.triangles.size() / 2);
  EXPECT_NE(sentence_of([&] { fill_surface(sphere, 0.4); }), "");
}

}  // namespace
}  // namespace palpate
