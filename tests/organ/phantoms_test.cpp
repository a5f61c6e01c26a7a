#include <gtest/gtest.h>

#include <numbers>

#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "tests/organ/phantom_image.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/mesh_pieces.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

/// [m] Integral of the mean curvature over a closed surface: half of each edge's length times the angle between the
/// normals beside it (Steiner), outward bends positive.
double total_mean_curvature(const TetMesh& mesh) {
  const Surface surface = extract_surface(mesh);
  std::map<std::array<int, 2>, Eigen::Vector3d> normal_beside;
  double total = 0;
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d normal =
        (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]).normalized();
    for (int c = 0; c < 3; ++c) {
      const int a = t[c], b = t[(c + 1) % 3];
      const auto [other, is_new] = normal_beside.emplace(std::array{std::min(a, b), std::max(a, b)}, normal);
      if (is_new) continue;
      const Eigen::Vector3d edge = mesh.nodes[b] - mesh.nodes[a];  // in this triangle's sense
      const double bend = std::atan2(normal.cross(other->second).dot(edge) / edge.norm(), normal.dot(other->second));
      total += 0.5 * edge.norm() * bend;
    }
  }
  return total;
}

class Phantom : public ::testing::Test {
 protected:
  /// The mesh of label 1 of an image of voxels of 1 mm, and `slice` [mm] across slices.
  template <class Inside>
  TetMesh mesh_of(const std::array<int, 3>& count, const std::string& options, const Inside& inside,
                  double slice = 1) const {
    const std::string image = folder_ / "phantom.inr", mesh = folder_ / "phantom.msh";
    write_phantom(image, count, {1, 1, slice}, inside);
    const auto made = run_program(program("palpate") + " organ " + image + " " + options + " -o " + mesh);
    EXPECT_EQ(made.status, 0) << made.out << made.err;
    return load_tet_mesh(mesh, 1);
  }
  static void expect_measures(const TetMesh& mesh, double volume, int genus, double curvature) {
    EXPECT_NEAR(measures_of(mesh).volume, volume, 0.01 * volume);
    EXPECT_GE(measures_of(mesh).smallest_angle, 12);
    EXPECT_EQ(topology_of(mesh), (Topology{1, genus}));
    EXPECT_NEAR(total_mean_curvature(mesh), curvature, 0.01 * curvature);
  }
  const OwnFolder folder_{"phantom"};
};

TEST_F(Phantom, ASphereHasItsVolumeAndItsCurvature) {
  constexpr double kRadius = 0.0143;
  const TetMesh mesh = mesh_of({40, 40, 40}, "--label 1 --nodes 600", [](int i, int j, int k) {
    return (Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Constant(19.6)).norm() < 1e3 * kRadius;
  });
  expect_measures(mesh, 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3), 0, 4 * std::numbers::pi * kRadius);
}

TEST_F(Phantom, ATorusHasItsHandleAndItsCurvature) {
  constexpr double kRing = 0.016, kTube = 0.0062;
  const TetMesh mesh = mesh_of({60, 60, 28}, "--label 1 --nodes 800", [](int i, int j, int k) {
    return std::hypot(std::hypot(i - 29.6, j - 29.4) - 1e3 * kRing, k - 13.7) < 1e3 * kTube;
  });
  const double square = std::numbers::pi * std::numbers::pi;
  expect_measures(mesh, 2 * square * kRing * kTube * kTube, 1, 2 * square * kRing);
}

// Between slices the border of the voxels goes in steps, which are no thin walls.
TEST_F(Phantom, ThickSlicesOfASphereAreNoWalls) {
  constexpr double kRadius = 22;  // [mm]
  for (const double slice : {3.0, 5.0}) {
    const int slices = static_cast<int>(60 / slice);
    const TetMesh mesh = mesh_of(
        {60, 60, slices}, "--label 1 --nodes 600",
        [&](int i, int j, int k) {
          return Eigen::Vector3d(i - 29.6, j - 29.4, slice * (k - 0.5 * slices + 0.3)).norm() < kRadius;
        },
        slice);
    const double ball = 4.0 / 3 * std::numbers::pi * std::pow(1e-3 * kRadius, 3);
    EXPECT_NEAR(measures_of(mesh).volume, ball, 0.02 * ball) << slice;
    EXPECT_EQ(topology_of(mesh), (Topology{1, 0})) << slice;
  }
}

TEST_F(Phantom, TwoSpheresThatTouchMakeOneMeshOfTwoParts) {
  const TetMesh mesh = mesh_of({64, 36, 36}, "--label 1 --label 2 --nodes 900", [](int i, int j, int k) {
    const auto from = [&](double x) { return (Eigen::Vector3d(i, j, k) - Eigen::Vector3d(x, 17.5, 17.5)).norm(); };
    return from(18.5) < 13 ? 1 : from(43.5) < 13 ? 2 : 0;
  });
  for (const char* name : {"label1", "label2"}) {
    TetMesh part{mesh.nodes, {}, {}};
    for (const int t : mesh.groups.at(name).tetrahedra) part.tetrahedra.push_back(mesh.tetrahedra[t]);
    const double ball = 4.0 / 3 * std::numbers::pi * std::pow(0.013, 3);
    EXPECT_NEAR(measures_of(part).volume, ball, 0.02 * ball) << "the lens that they share is the first one's";
    EXPECT_EQ(topology_of(part), (Topology{1, 0}));
  }
}

}  // namespace
}  // namespace palpate
