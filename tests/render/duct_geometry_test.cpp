#include <gtest/gtest.h>

#include <map>

#include "common/mesh/shell_generators.hpp"
#include "common/mesh/shell_quality.hpp"
#include "common/view/instrument.hpp"
#include "common/view/straighten.hpp"
#include "render_node/thick_wall.hpp"
#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;
using Triangles = std::vector<std::array<int, 3>>;

/// Triangles over vertices, of which those at the same place count as one.
class Surface {
 public:
  void add(const std::vector<Eigen::Vector3f>& position, const Triangles& triangles) {
    for (const auto& t : triangles) {
      std::array<int, 3> corners;
      for (int k = 0; k < 3; ++k) corners[k] = vertex(position[t[k]]);
      triangles_.push_back(corners);
    }
  }
  /// Every edge is run along as often in one direction as in the other.
  bool closed() const {
    std::map<std::pair<int, int>, int> balance;
    for (const auto& t : triangles_)
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        balance[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
  }
  double volume() const {  ///< [m^3]
    double sum = 0;
    for (const auto& t : triangles_) sum += points_[t[0]].dot(points_[t[1]].cross(points_[t[2]])) / 6;
    return sum;
  }

 private:
  int vertex(const Eigen::Vector3f& p) {
    const auto key = [](float x) { return std::lround(x * 1e7f); };
    const auto [entry, is_new] =
        known_.try_emplace({key(p.x()), key(p.y()), key(p.z())}, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(p.cast<double>());
    return entry->second;
  }
  std::map<std::array<long, 3>, int> known_;
  std::vector<Eigen::Vector3d> points_;
  Triangles triangles_;
};

bool looks_outward(const std::vector<Eigen::Vector3f>& position, const std::vector<Eigen::Vector3f>& normal,
                   const Triangles& triangles) {
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3f area = (position[b] - position[a]).cross(position[c] - position[a]);
    if (area.norm() < 1e-12f) continue;
    for (const int v : {a, b, c})
      if (!(area.dot(normal[v]) > 0)) return false;
  }
  return true;
}

/// A wall of 1 mm about a tube of 4.5 mm.
struct Duct {
  ShellMesh mesh = make_tube(0.0045, 0.05, 40, 30);
  std::vector<Eigen::Vector3f> position, normal;
  ThickWall wall{mesh.triangles, static_cast<int>(mesh.nodes.size()), 0.001};

  Duct() {
    for (const auto& p : mesh.nodes) position.push_back(p.cast<float>());
    normal.resize(position.size());
    vertex_normals(position, mesh.triangles, normal);
    wall.place(position, normal);
  }
};

TEST(ThickWall, IsClosedAndHasTheVolumeOfItsThickness) {
  const Duct duct;
  Surface surface;
  surface.add(duct.wall.outer().position, duct.wall.outer().triangles);
  EXPECT_FALSE(surface.closed());
  surface.add(duct.wall.inner().position, duct.wall.inner().triangles);
  EXPECT_TRUE(surface.closed());
  const double expected = std::numbers::pi * (0.005 * 0.005 - 0.004 * 0.004) * 0.05;
  EXPECT_NEAR(surface.volume(), expected, 0.01 * expected);  // a polygon of 40 corners
}

TEST(ThickWall, LooksOutwardOnBothSidesAndAtTheRims) {
  const Duct duct;
  for (const ThickWall::Side* side : {&duct.wall.outer(), &duct.wall.inner()}) {
    EXPECT_TRUE(looks_outward(side->position, side->normal, side->triangles));
    for (std::size_t v = 0; v < side->normal.size(); ++v) EXPECT_NEAR(side->normal[v].norm(), 1, 1e-4) << v;
  }
  const ThickWall::Side& inner = duct.wall.inner();
  ASSERT_EQ(inner.position.size(),
            duct.position.size() + 4 * 40);  // two mouths of 40 nodes, each with two rims' corners
  for (std::size_t v = duct.position.size(); v < inner.position.size(); ++v) {
    EXPECT_NEAR(std::abs(inner.normal[v].z()), 1, 1e-3);
    EXPECT_GT(inner.normal[v].z() * (inner.position[v].z() - 0.025f), 0);
    EXPECT_NEAR((inner.position[v] - duct.position[inner.from[v]]).norm(), 0.0005, 1e-6);
  }
}

TEST(ThickWall, FollowsItsMiddleSurface) {
  Duct duct;
  for (auto& p : duct.position) p = Eigen::Vector3f(p.x() + 200 * p.z() * p.z() * 0.01f, p.y(), p.z());
  vertex_normals(duct.position, duct.mesh.triangles, duct.normal);
  duct.wall.place(duct.position, duct.normal);
  Surface surface;
  surface.add(duct.wall.outer().position, duct.wall.outer().triangles);
  surface.add(duct.wall.inner().position, duct.wall.inner().triangles);
  EXPECT_TRUE(surface.closed());
  for (std::size_t v = 0; v < duct.position.size(); ++v) {
    EXPECT_LT((duct.wall.outer().position[v] - duct.position[v] - 0.0005f * duct.normal[v]).norm(), 1e-7f);
    EXPECT_LT((duct.wall.inner().position[v] - duct.position[v] + 0.0005f * duct.normal[v]).norm(), 1e-7f);
  }
}

TEST(ThickWall, ASheetGetsOneRimAllAround) {
  const Triangles square{{0, 1, 2}, {0, 2, 3}};
  const std::vector<Eigen::Vector3f> x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, n(4, Eigen::Vector3f::UnitZ());
  ThickWall wall(square, 4, 0.2);
  wall.place(x, n);
  Surface surface;
  surface.add(wall.outer().position, wall.outer().triangles);
  surface.add(wall.inner().position, wall.inner().triangles);
  EXPECT_TRUE(surface.closed());
  EXPECT_NEAR(surface.volume(), 0.2, 1e-6);
}

TEST(Straighten, RunsAlongABentTube) {
  // A quarter of a circle of radius 30 mm.
  const double bend = 0.03, wide = 0.004;
  const auto centre = [&](double t) {
    const double a = 0.5 * std::numbers::pi * t;
    return Eigen::Vector3d(bend * std::cos(a), bend * std::sin(a), 0);
  };
  const ShellMesh tube = make_tube(
      centre, [&](double) { return wide; }, 16, 30);
  SurfaceMap map;
  map.position = tube.nodes;
  map.triangles = tube.triangles;
  const std::vector<Eigen::Vector3f> straight = straighten(map);
  const bool from_first = straight[0].z() < straight.back().z();
  for (int ring = 0; ring <= 30; ++ring)
    for (int j = 0; j < 16; ++j) {
      const Eigen::Vector3f& p = straight[16 * ring + j];
      const double share = (from_first ? ring : 30 - ring) / 30.0;
      EXPECT_NEAR(p.z(), share * 0.5 * std::numbers::pi * bend, 0.0015);
      EXPECT_NEAR(p.head<2>().norm(), wide, 0.0003);
      // Carried along without a twist: the same node of each ring has the same direction.
      EXPECT_GT(p.head<2>().normalized().dot(straight[j].head<2>().normalized()), 0.98f);
    }
}

TEST(Straighten, OtherShapesTurnTheirLongestExtentAlongZ) {
  SurfaceMap map;
  map.position = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.02, 0}, {0, 0.02, 0}};
  map.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Eigen::Vector3f> turned = straighten(map);
  EXPECT_NEAR(std::abs(turned[1].z() - turned[0].z()), 0.1, 1e-6);
  EXPECT_NEAR((turned[2] - turned[1]).norm(), 0.02, 1e-6);
}

InstrumentView forceps_view(double opening = 0) {
  InstrumentView view;
  view.shaft_radius = 0.0025;
  view.jaw_length = 0.012;
  view.jaw_radius = 0.001;
  view.jaw_opening = opening;
  return view;
}

TEST(Forceps, AllPartsAreClosedAndLookOutward) {
  for (const double jaw : {0.012, 0.03})
    for (const double radius : {0.0007, 0.0015}) {
      InstrumentView view = forceps_view();
      view.jaw_length = jaw;
      view.jaw_radius = radius;
      const InstrumentShape shape = make_instrument(view);
      EXPECT_EQ(shape.hinge, 0);
      for (const InstrumentPart& part : shape.parts) {
        Surface surface;
        surface.add(part.position, part.triangles);
        EXPECT_TRUE(surface.closed());
        EXPECT_GT(surface.volume(), 0);
        EXPECT_TRUE(looks_outward(part.position, part.normal, part.triangles));
      }
    }
}

TEST(Forceps, EachJawLiesAlongTheSegmentThatCollides) {
  const double opening = 0.8, length = 0.012, radius = 0.001;
  InstrumentView view = forceps_view(opening);
  view.tip = Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  const InstrumentShape shape = make_instrument(view);
  for (const int jaw : {1, 2}) {
    const double side = jaw == 1 ? 1 : -1;
    const Eigen::Vector3d along(0, side * std::sin(0.5 * opening), std::cos(0.5 * opening));
    const Eigen::Vector3d across(0, side * std::cos(0.5 * opening),
                                 -std::sin(0.5 * opening));  // away from the other jaw
    const Eigen::Isometry3d pose = view.tip.inverse() * part_pose(view, shape, jaw);
    double farthest = 0, inward = 0;
    for (const auto& p : shape.parts[jaw].position) {
      const Eigen::Vector3d q = pose * p.cast<double>();
      farthest = std::max(farthest, q.dot(along));
      if (q.dot(along) >= 0) {
        EXPECT_LT((q - std::min(q.dot(along), length) * along).norm(), 1.9 * radius);
      }
      if (q.dot(along) > 0.4 * length) inward = std::max(inward, -q.dot(across));
    }
    EXPECT_NEAR(farthest, length + radius, 0.15 * radius);
    EXPECT_NEAR(inward, radius, 0.05 * radius);  // the teeth's tops are where the segment's radius ends
  }
}

TEST(Forceps, JawsHaveTeethAndTaper) {
  const InstrumentShape shape = make_instrument(forceps_view());
  std::map<long, float> bite;  // deepest y of the upper jaw by place along it [10 um]
  float wide_at_root = 0, wide_at_nose = 0;
  for (const auto& p : shape.parts[1].position) {
    if (p.z() > 0.003f && p.z() < 0.012f)
      bite[std::lround(1e5f * p.z())] = std::min(bite[std::lround(1e5f * p.z())], p.y());
    if (p.z() > 0.004f && p.z() < 0.007f) wide_at_root = std::max(wide_at_root, p.x());
    if (p.z() > 0.011f && p.z() < 0.012f) wide_at_nose = std::max(wide_at_nose, p.x());
  }
  int teeth = 0;
  for (auto it = std::next(bite.begin()); std::next(it) != bite.end(); ++it)
    teeth += it->second < std::prev(it)->second - 1e-4f && it->second < std::next(it)->second - 1e-4f;
  EXPECT_GE(teeth, 8);
  EXPECT_GT(wide_at_root, 1.15f * wide_at_nose);
}

}  // namespace
}  // namespace palpate
