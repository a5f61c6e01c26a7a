#include "tools/organ/surface_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/organ/surfaces_for_tests.hpp"
#include "tools/organ/surface_fault.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

constexpr double kHole = 0.5;

struct Repaired : RepairedSurface {
  std::vector<Finding> findings;
};

Repaired repaired_of(const TriangleMesh& broken) {
  std::vector<Finding> findings;
  const RepairedSurface surface = repair_surface(broken, kHole, findings);
  return {surface, findings};
}

/// A ball broken in one way at a time.
class SurfaceRepair : public ::testing::Test {
 protected:
  /// The one finding, after which the surface is closed and holds `volume` [m^3].
  static std::string finding(const TriangleMesh& broken, double volume) {
    const Repaired repaired = repaired_of(broken);
    EXPECT_TRUE(rims_of(repaired.mesh).empty());
    EXPECT_NEAR(enclosed_volume(repaired.mesh), volume, 0.01 * volume);
    EXPECT_EQ(repaired.findings.size(), 1u) << (repaired.findings.empty() ? "" : say(repaired.findings.back()));
    return repaired.findings.empty() ? "" : say(repaired.findings[0]);
  }
  static void expect_has(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }

  TriangleMesh ball_ = make_sphere({1, 0, 0}, 1, 12);
  const double volume_ = enclosed_volume(ball_);
};

TEST_F(SurfaceRepair, AGoodSurfaceHasNoFindings) {
  EXPECT_TRUE(repaired_of(ball_).findings.empty());
}

TEST_F(SurfaceRepair, CornersApartAreJoined) {
  TriangleMesh apart;
  for (const auto& t : ball_.triangles) {
    for (const int n : t) apart.nodes.push_back(ball_.nodes[n]);
    const int last = static_cast<int>(apart.nodes.size());
    apart.triangles.push_back({last - 3, last - 2, last - 1});
  }
  const Repaired repaired = repaired_of(apart);
  EXPECT_TRUE(repaired.findings.empty());
  EXPECT_EQ(repaired.mesh.nodes.size(), ball_.nodes.size());
}

TEST_F(SurfaceRepair, TrianglesThereTwiceOrWithoutAreaAreLeftOut) {
  TriangleMesh twice = ball_;
  twice.triangles.push_back(ball_.triangles[5]);
  expect_has(finding(twice, volume_), "1 triangle that is there twice, the first at (");
  TriangleMesh flat = ball_;
  flat.triangles.push_back({3, 3, 4});
  expect_has(finding(flat, volume_), "1 triangle without area");
}

TEST_F(SurfaceRepair, NodesThatNoTriangleUsesAreToldAndChangeNothing) {
  TriangleMesh far = ball_;
  far.nodes.emplace_back(1e5, 0, 0);
  expect_has(finding(far, volume_), "1 node that no triangle uses, the first at (1e+08, 0, 0) mm: left out");
  TriangleMesh sheet = ball_;  // a triangle far away makes a diagonal, and joins no corners
  const int n = static_cast<int>(ball_.nodes.size());
  sheet.nodes.insert(sheet.nodes.end(), {{1e5, 0, 0}, {1e5, 1, 0}, {1e5, 0, 1}});
  sheet.triangles.push_back({n, n + 1, n + 2});
  expect_has(finding(sheet, volume_), "an open sheet of 1 triangle at (1e+08, 0, 0) mm");
}

TEST_F(SurfaceRepair, TurnedTrianglesAreTurnedBack) {
  for (const int first : {0, 4}) {
    TriangleMesh turned = ball_;
    for (const int t : {first, 40, 41}) std::swap(turned.triangles[t][0], turned.triangles[t][1]);
    expect_has(finding(turned, volume_), "3 triangles turned against their neighbours");
  }
  TriangleMesh inside_out = ball_;
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  expect_has(finding(inside_out, volume_),
             "a surface of 576 triangles inside out at (1239, 0, 970.9) mm: turned outward");
}

TEST_F(SurfaceRepair, AHoleIsClosedUpToItsSize) {
  TriangleMesh open = ball_;
  open.triangles.erase(open.triangles.begin() + 25, open.triangles.begin() + 27);
  expect_has(finding(open, volume_), "mm across with 4 edges at (");
  TriangleMesh half = ball_;
  std::erase_if(half.triangles, [&](const auto& t) { return ball_.nodes[t[0]].z() > 0.5; });
  try {
    repaired_of(half);
    FAIL() << "a hole of a third of the ball was closed";
  } catch (const std::runtime_error& error) {
    expect_has(error.what(), "larger than 500 mm");
    expect_has(error.what(), "--hole");
  }
}

TEST_F(SurfaceRepair, ARoundHoleIsAsLargeAsItIsWide) {
  TriangleMesh cup;  // of radius 0.24, closed below
  constexpr int kAround = 24;
  for (int n = 0; n < 2 * kAround; ++n) {
    const double angle = 2 * std::numbers::pi * n / kAround;
    cup.nodes.emplace_back(0.24 * std::cos(angle), 0.24 * std::sin(angle), n < kAround ? 0 : 2);
  }
  cup.nodes.emplace_back(0, 0, 0);
  for (int n = 0; n < kAround; ++n) {
    const int next = (n + 1) % kAround;
    cup.triangles.push_back({n, next, kAround + next});
    cup.triangles.push_back({n, kAround + next, kAround + n});
    cup.triangles.push_back({2 * kAround, next, n});
  }
  const double prism = 12 * 0.24 * 0.24 * std::sin(2 * std::numbers::pi / kAround) * 2;
  expect_has(finding(cup, prism), "a hole of 480 mm across with 24 edges at (");  // kHole is 500 mm
}

// A tetrahedron's face is as wide as its edge: 1, where a fifth of the diagonal is 0.35.
TEST_F(SurfaceRepair, AShellFarAwayDoesNotMakeALargerHoleOneToBeClosed) {
  TriangleMesh open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}};
  for (const double far : {0.0, 9.0}) {
    for (const Eigen::Vector3d& x : {Eigen::Vector3d(0, 0, 0), {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}})
      open.nodes.emplace_back(x + Eigen::Vector3d::Constant(far));
    if (far > 0) open.triangles.insert(open.triangles.end(), {{8, 10, 9}, {8, 9, 11}, {8, 11, 10}, {9, 10, 11}});
    std::vector<Finding> findings;
    EXPECT_THROW(repair_surface(open, 0, findings), std::runtime_error) << far;
  }
}

// As the patch of a hole can meet an edge that has two triangles.
TEST_F(SurfaceRepair, TrianglesThatMakeNoSurfaceAreRefusedWithThePlace) {
  TriangleMesh wrong = ball_;
  const auto [first, second, third] = wrong.triangles.front();
  wrong.nodes.emplace_back(3, 0, 0);
  wrong.triangles.push_back({first, second, static_cast<int>(wrong.nodes.size()) - 1});
  try {
    check_is_surface(wrong);
    FAIL() << "of edge " << first << ", " << second << " a third triangle is taken, beside node " << third;
  } catch (const std::runtime_error& error) {
    expect_has(error.what(), "its triangles do not make a surface: more than two meet in an edge at (");
  }
  TriangleMesh open = ball_;
  open.triangles.pop_back();
  EXPECT_THROW(check_is_surface(open), std::runtime_error);
  EXPECT_NO_THROW(check_is_surface(ball_));
}

TEST_F(SurfaceRepair, OtherShellsAreReportedByTheirPlace) {
  TriangleMesh stray = ball_;
  append(stray, make_sphere({5, 0, 0}, 0.1, 4));
  expect_has(finding(stray, volume_), "a stray shell of 64 triangles");
  TriangleMesh cavity = ball_;
  append(cavity, make_sphere({1, 0, 0}, 0.5, 12));
  expect_has(finding(cavity, volume_ * 0.875), "taken for a cavity");
  TriangleMesh sheet = ball_;
  sheet.nodes.insert(sheet.nodes.end(), {{9, 0, 0}, {9, 1, 0}, {9, 0, 1}});
  const int n = static_cast<int>(ball_.nodes.size());
  sheet.triangles.push_back({n, n + 1, n + 2});
  expect_has(finding(sheet, volume_), "an open sheet of 1 triangle at (9000, 0, 0) mm");
}

// By where shells lie, however they are wound.
TEST_F(SurfaceRepair, AShellWithinACavityIsALooseIslandThatIsLeftOut) {
  for (const bool turned : {false, true}) {
    TriangleMesh island = ball_, cavity = make_sphere({1, 0, 0}, 0.7, 12);
    if (turned)
      for (auto& t : cavity.triangles) std::swap(t[0], t[1]);
    append(island, make_sphere({1, 0, 0.1}, 0.2, 4));  // in the island
    append(island, cavity);
    append(island, make_sphere({1, 0, 0.1}, 0.5, 8));
    const Repaired repaired = repaired_of(island);
    EXPECT_NEAR(enclosed_volume(repaired.mesh), volume_ - std::abs(enclosed_volume(cavity)), 1e-9);
    EXPECT_EQ(repaired.mesh.triangles.size(), ball_.triangles.size() + cavity.triangles.size());
    ASSERT_EQ(repaired.findings.size(), 3u);
    expect_has(say(repaired.findings[0]), "a shell inside the largest of 576 triangles");
    expect_has(say(repaired.findings[1]), "a loose island, a shell within a cavity, of 256 triangles and 4.");
    expect_has(say(repaired.findings[1]), "at (1000, 0, 600) mm: left out");
    expect_has(say(repaired.findings[2]), "a cavity in a loose island of 64 triangles");
  }
}

TEST_F(SurfaceRepair, CavitiesBesideOneAnotherAreAllCavitiesAndCounted) {
  TriangleMesh two = ball_;
  append(two, make_sphere({1, 0.5, 0}, 0.3, 6));
  append(two, make_sphere({1, -0.5, 0}, 0.3, 6));
  const Repaired repaired = repaired_of(two);
  EXPECT_NEAR(enclosed_volume(repaired.mesh), volume_ - 2 * enclosed_volume(make_sphere({0, 0, 0}, 0.3, 6)), 1e-9);
  ASSERT_EQ(repaired.findings.size(), 2u);
  for (const Finding& f : repaired.findings) EXPECT_EQ(f.kind, "shells inside the largest");
}

TEST_F(SurfaceRepair, ClosedSurfacesThatTouchInAnEdgeComeApartWithoutAHole) {
  TriangleMesh cubes = make_cubes(4, [](int x, int y, int z) {
    return (x < 2 && y < 2 && z < 2) || (x >= 2 && x < 3 && y >= 2 && y < 3 && z < 2);
  });
  for (const bool inside_out : {false, true}) {
    if (inside_out)
      for (auto& t : cubes.triangles) std::swap(t[0], t[1]);
    const Repaired repaired = repaired_of(cubes);
    EXPECT_TRUE(rims_of(repaired.mesh).empty());
    EXPECT_NEAR(enclosed_volume(repaired.mesh), 8, 1e-9);
    EXPECT_FALSE(repaired.crosses_itself);
    std::string told;
    for (const Finding& f : repaired.findings) told += say(f) + "\n";
    expect_has(told, "2 edges that more than two triangles share, the first at (2000, 2000, ");
    expect_has(told, "a stray shell of 20 triangles");
    EXPECT_EQ(told.find("hole"), std::string::npos) << told;
  }
}

// Both ends of the edge hang together above and below: nodes of the ends alone do not part it.
TEST_F(SurfaceRepair, AnEdgeWhereABodyTouchesItselfIsParted) {
  const TriangleMesh body = make_cubes(4, [](int x, int y, int z) { return z != 1 || (x < 2) == (y < 2); });
  const Repaired repaired = repaired_of(body);
  EXPECT_TRUE(rims_of(repaired.mesh).empty());
  EXPECT_NEAR(enclosed_volume(repaired.mesh), 56, 1e-9);
  EXPECT_FALSE(repaired.crosses_itself);
  ASSERT_EQ(repaired.findings.size(), 2u);  // the first: nodes of the grid that no triangle uses
  expect_has(say(repaired.findings[1]), "1 edge that more than two triangles share, the first at (2000, 2000, 1500)");
}

TEST_F(SurfaceRepair, ANodeWhereTwoPartsTouchIsParted) {
  TriangleMesh touching = ball_;
  append(touching, make_sphere({1, 0, 1.2}, 0.2, 4));
  const Repaired repaired = repaired_of(touching);
  EXPECT_NEAR(enclosed_volume(repaired.mesh), volume_, 1e-9);
  ASSERT_EQ(repaired.findings.size(), 2u);
  expect_has(say(repaired.findings[0]),
             "1 node where the surface is not manifold, the first at (1000, 0, 1000) mm: parted there");
  expect_has(say(repaired.findings[1]), "a stray shell of 64 triangles");
}

TEST_F(SurfaceRepair, ACrossingSurfaceIsToldWithItsPlace) {
  TriangleMesh two = ball_;
  append(two, make_sphere({2.2, 0.1, 0.05}, 0.9, 12));
  const Repaired repaired = repaired_of(two);
  EXPECT_TRUE(repaired.crosses_itself);
  ASSERT_EQ(repaired.findings.size(), 2u);
  expect_has(say(repaired.findings[0]), "joined to it");
  expect_has(say(repaired.findings[1]), "pairs of triangles that cross one another, the first at (");
}

TEST_F(SurfaceRepair, AnEdgeOfThreeTrianglesIsParted) {
  TriangleMesh fin = ball_;
  fin.nodes.emplace_back(3, 0, 0);
  fin.triangles.push_back({ball_.triangles[50][0], ball_.triangles[50][1], static_cast<int>(ball_.nodes.size())});
  const Repaired repaired = repaired_of(fin);
  EXPECT_TRUE(rims_of(repaired.mesh).empty());
  EXPECT_NEAR(enclosed_volume(repaired.mesh), volume_, 0.02 * volume_);
  ASSERT_FALSE(repaired.findings.empty());
  expect_has(say(repaired.findings[0]), "1 edge that more than two triangles share, the first at (");
}

}  // namespace
}  // namespace palpate
