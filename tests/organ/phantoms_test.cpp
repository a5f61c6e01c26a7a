#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "tests/organ/phantom_image.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/mesh_pieces.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

/// [m] Integral of the mean curvature over a closed surface: half of each edge's length times the angle between the
/// normals beside it (Steiner), outward bends positive.
double total_mean_curvature(const TriangleMesh& mesh) {
  std::map<std::array<int, 2>, Eigen::Vector3d> normal_beside;
  double total = 0;
  for (const auto& t : mesh.triangles) {
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

TriangleMesh surface_of(const TetMesh& mesh) {
  return {mesh.nodes, extract_surface(mesh).triangles};
}

TetMesh part_of(const TetMesh& mesh, const std::string& group) {
  TetMesh part{mesh.nodes, {}, {}};
  for (const int t : mesh.groups.at(group).tetrahedra) part.tetrahedra.push_back(mesh.tetrahedra[t]);
  return part;
}

class Phantom : public ::testing::Test {
 protected:
  /// The mesh of label 1 of an image of voxels of 1 mm, and `slice` [mm] across slices.
  template <class Inside>
  TetMesh mesh_of(const std::array<int, 3>& count, const std::string& options, const Inside& inside, double slice = 1) {
    const std::string image = folder_ / "phantom.inr", mesh = folder_ / "phantom.msh";
    write_phantom(image, count, {1, 1, slice}, inside);
    const auto made = run_program(program("palpate") + " organ " + image + " " + options + " -o " + mesh);
    EXPECT_EQ(made.status, 0) << made.out << made.err;
    said_ = made.out;
    return load_tet_mesh(mesh, 1);
  }
  static void expect_measures(const TetMesh& mesh, double volume, int genus, double curvature) {
    EXPECT_NEAR(measures_of(mesh).volume, volume, 0.01 * volume);
    EXPECT_GE(measures_of(mesh).min_angle, 12);
    EXPECT_EQ(topology_of(mesh), (Topology{1, genus}));
    EXPECT_NEAR(total_mean_curvature(surface_of(mesh)), curvature, 0.01 * curvature);
  }
  const OwnFolder folder_{"phantom"};
  std::string said_;  ///< of the last mesh
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
    const TetMesh part = part_of(mesh, name);
    const double ball = 4.0 / 3 * std::numbers::pi * std::pow(0.013, 3);
    EXPECT_NEAR(measures_of(part).volume, ball, 0.02 * ball) << "the lens that they share is the first one's";
    EXPECT_EQ(topology_of(part), (Topology{1, 0}));
    // Of the second one the rim of the lens makes up for what is hollow there, to a thousandth.
    const double curvature = 4 * std::numbers::pi * 0.013;
    EXPECT_NEAR(total_mean_curvature(surface_of(part)), curvature, 0.06 * curvature) << name;
  }
}

// No node of its border lies on the outer surface.
TEST_F(Phantom, ALabelWithinAnotherHasItsVolume) {
  std::array<int, 3> voxels{};
  const TetMesh mesh = mesh_of({40, 40, 40}, "--label 1 --label 2 --nodes 600", [&](int i, int j, int k) {
    const double r = (Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Constant(20)).norm();
    const int label = r < 6 ? 2 : r < 15 ? 1 : 0;
    ++voxels[label];
    return label;
  });
  for (const int label : {1, 2}) {
    const double counted = 1e-9 * voxels[label];
    const TetMesh part = part_of(mesh, fmt::format("label{}", label));
    EXPECT_NEAR(measures_of(part).volume, counted, 1e-3 * counted) << label;
  }
}

// Its inner surface bends the other way: both are looked at by themselves. Steps of voxels that are smoothed over a
// third of the wall are not all gone.
TEST_F(Phantom, AWallOfOneAndAHalfVoxelsKeepsBothItsSides) {
  constexpr double kOuter = 0.01875, kInner = 0.01725;
  std::size_t voxels = 0;
  const TetMesh mesh = mesh_of({46, 46, 46}, "--label 1 --nodes 6000", [&](int i, int j, int k) {
    const double r = 1e-3 * (Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Constant(22.6)).norm();
    const bool inside = r < kOuter && r >= kInner;
    voxels += inside;
    return inside;
  });
  const double counted = 1e-9 * static_cast<double>(voxels);
  EXPECT_NEAR(measures_of(mesh).volume, counted, 0.01 * counted);
  const double wall = 4.0 / 3 * std::numbers::pi * (std::pow(kOuter, 3) - std::pow(kInner, 3));
  EXPECT_NEAR(measures_of(mesh).volume, wall, 0.01 * wall);
  EXPECT_EQ(pieces_of(mesh).size(), 1u);
  EXPECT_EQ(topology_of(mesh), (Topology{2, 0}));
  const TriangleMesh surface = surface_of(mesh);
  std::vector<double> curvatures;
  for (const std::vector<int>& shell : shells_of(surface)) {
    TriangleMesh side{surface.nodes, {}};
    for (const int t : shell) side.triangles.push_back(surface.triangles[t]);
    curvatures.push_back(total_mean_curvature(side));
  }
  std::ranges::sort(curvatures);
  ASSERT_EQ(curvatures.size(), 2u);
  EXPECT_NEAR(curvatures[0], -4 * std::numbers::pi * kInner, 0.06 * 4 * std::numbers::pi * kInner);
  EXPECT_NEAR(curvatures[1], 4 * std::numbers::pi * kOuter, 0.06 * 4 * std::numbers::pi * kOuter);
}

// Smoothing by a voxel would go over a lid's whole thickness, though the sides are thick.
TEST_F(Phantom, AHollowBoxOfThickSlicesKeepsItsLids) {
  const TetMesh mesh = mesh_of(
      {40, 40, 16}, "--label 1 --nodes 2500",
      [](int i, int j, int k) {
        const auto within = [](int n, int low, int high) { return n >= low && n < high; };
        const bool cavity = within(i, 8, 32) && within(j, 8, 32) && within(k, 3, 13);
        return within(i, 2, 38) && within(j, 2, 38) && within(k, 2, 14) && !cavity;
      },
      5);
  EXPECT_EQ(topology_of(mesh), (Topology{2, 0})) << said_;
  EXPECT_EQ(said_.find("warning:"), std::string::npos) << said_;
}

// Midway in a wall of an even number of voxels two are equally deep.
TEST_F(Phantom, ASmallCavityIsKeptWhereverItLies) {
  constexpr double kBall = 14, kCavity = 4;  // [mm] 2.3 % of the ball
  for (const double aside : {0.0, 6.0}) {
    const TetMesh mesh = mesh_of({34, 34, 34}, "--label 1 --nodes 900", [&](int i, int j, int k) {
      const Eigen::Vector3d x(i - 16.5, j - 16.5, k - 16.5);
      return x.norm() < kBall && (x - Eigen::Vector3d(aside, 0, 0)).norm() > kCavity;
    });
    EXPECT_EQ(topology_of(mesh), (Topology{2, 0})) << aside << said_;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& x : mesh.nodes) box.extend(x);
    EXPECT_NEAR(box.sizes().mean(), 2e-3 * kBall, 0.3e-3) << aside;  // the volume is not made up for outside
  }
}

TEST_F(Phantom, WallsAreToldWhetherTheirVoxelsAreEvenOrOdd) {
  for (const int wall : {1, 2, 3}) {
    const std::string image = folder_ / "walls.inr";
    write_phantom(image, {26, 26, 26}, 1, [&](int i, int j, int k) {
      const int r = std::max({std::abs(i - 13), std::abs(j - 13), std::abs(k - 13)});
      return r <= 10 && r > 10 - wall;
    });
    // Edges that are refused: what is found comes before.
    const auto result = run_program(fmt::format("{} organ {} --label 1 --edge 0.014 -o {}", program("palpate"), image,
                                                (folder_ / "walls.msh").string()));
    EXPECT_NE(result.out.find("found: walls "), std::string::npos) << wall << result.out;
    EXPECT_NE(result.err.find("edges of 14 mm are too long: its walls are "), std::string::npos) << wall << result.err;
  }
}

TEST_F(Phantom, ATunnelThatSmoothingClosesIsWarnedOf) {
  const TetMesh mesh = mesh_of({26, 26, 14}, "--label 1 --nodes 300", [](int i, int j, int k) {
    const bool tunnel = i == 12 && j == 12;
    return i > 1 && i < 24 && j > 1 && j < 24 && k > 1 && k < 12 && !tunnel;
  });
  EXPECT_EQ(topology_of(mesh), (Topology{1, 0}));
  EXPECT_NE(
      said_.find("warning: 'label1' has 1 piece, 1 closed surface, genus 0, and its voxels have 1 piece, 1 closed "
                 "surface, genus 1"),
      std::string::npos)
      << said_;
}

}  // namespace
}  // namespace palpate
