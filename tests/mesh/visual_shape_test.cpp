#include "common/mesh/visual_shape.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "common/mesh/generators.hpp"
#include "common/mesh/surface.hpp"
#include "tests/mesh/visual_surfaces.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3d;
using Eigen::Vector3f;

const TetMesh kBlock = make_block({-0.05, -0.04, -0.03}, {0.05, 0.04, 0.03}, {5, 4, 3});

/// About the block: its edges are rounded off inside, its faces bulge to 5 mm outside of it.
const VisualMesh kAround = ellipsoid_around({0.055, 0.045, 0.035});

Matrix3f some_map() {
  Matrix3f map;
  map << 1.1f, 0.2f, -0.1f, -0.15f, 0.9f, 0.05f, 0.1f, 0.3f, 0.8f;
  return map;
}
const Vector3f kShift(0.01f, -0.02f, 0.03f);

std::vector<Vector3f> mapped(std::span<const Vector3d> nodes, const Matrix3f& map) {
  std::vector<Vector3f> out;
  for (const Vector3d& x : nodes) out.push_back(map * x.cast<float>() + kShift);
  return out;
}

void expect_mapped(const VisualShape& shape, const std::vector<Vector3f>& rest_normal, const Matrix3f& map) {
  const Matrix3f cofactor = map.determinant() * map.inverse().transpose();
  float off = 0, turned = 0;
  for (std::size_t v = 0; v < shape.position().size(); ++v) {
    off = std::max(off, (shape.position()[v] - (map * shape.mesh().position[v] + kShift)).norm());
    turned = std::max(turned, (shape.normal()[v] - (cofactor * rest_normal[v]).normalized()).norm());
  }
  EXPECT_LT(off, 1e-7) << "m";
  EXPECT_LT(turned, 1e-4);
}

TEST(VisualShape, AnAffineMotionOfTetrahedraIsFollowedExactlyWithItsNormals) {
  VisualShape shape(kAround, bind_visual(kAround.position, kBlock.nodes, {}, kBlock.tetrahedra), kBlock.nodes);
  const std::vector<Vector3f> rest_normal = shape.normal();
  shape.place(mapped(kBlock.nodes, some_map()));
  expect_mapped(shape, rest_normal, some_map());
}

TEST(VisualShape, SoIsThatOfASurfaceWhoseInsideIsNotKnown) {
  const auto triangles = extract_surface(kBlock).triangles;
  VisualShape shape(kAround, bind_visual(kAround.position, kBlock.nodes, triangles, {}), kBlock.nodes);
  const std::vector<Vector3f> rest_normal = shape.normal();
  shape.place(mapped(kBlock.nodes, some_map()));
  expect_mapped(shape, rest_normal, some_map());
}

/// Half of the block's tetrahedra are known, as of a hybrid body.
TEST(VisualShape, SoIsThatOfBothTogether) {
  const auto half = std::span(kBlock.tetrahedra).first(kBlock.tetrahedra.size() / 2);
  const auto triangles = extract_surface(kBlock).triangles;
  const VisualBinding binding = bind_visual(kAround.position, kBlock.nodes, triangles, half);
  EXPECT_GT(binding.cells.size(), half.size());
  VisualShape shape(kAround, binding, kBlock.nodes);
  const std::vector<Vector3f> rest_normal = shape.normal();
  shape.place(mapped(kBlock.nodes, some_map()));
  expect_mapped(shape, rest_normal, some_map());
}

/// A bend whose exact shape is known: x of the nodes is a quadratic function of z. Linear weights miss it by
/// h^2 / 8 times its curvature, 2.5 mm here.
TEST(VisualShape, ABendIsRoundBetweenTheNodes) {
  VisualShape shape(kAround, bind_visual(kAround.position, kBlock.nodes, {}, kBlock.tetrahedra), kBlock.nodes);
  const auto bent = [](const Vector3f& x) { return Vector3f(x.x() + 10 * x.z() * x.z(), x.y(), x.z()); };
  std::vector<Vector3f> nodes;
  for (const Vector3d& x : kBlock.nodes) nodes.push_back(bent(x.cast<float>()));
  shape.place(nodes);
  double square = 0, linear = 0;
  const VisualBinding binding = bind_visual(kAround.position, kBlock.nodes, {}, kBlock.tetrahedra);
  for (std::size_t v = 0; v < shape.position().size(); ++v) {
    const Vector3f truth = bent(kAround.position[v]);
    const auto& tie = binding.ties[v];
    if (tie.distance > 0) continue;
    Vector3f straight = Vector3f::Zero();
    for (int k = 0; k < 4; ++k) straight += tie.weight[k] * nodes[binding.cells[tie.cell][k]];
    square += (shape.position()[v] - truth).squaredNorm();
    linear += (straight - truth).squaredNorm();
  }
  EXPECT_GT(linear, 0);
  EXPECT_LT(square, 0.25 * linear);
}

TEST(VisualShape, WhatHangsOnRemovedTetrahedraGoesAndNothingSpansACut) {
  const VisualBinding binding = bind_visual(kAround.position, kBlock.nodes, {}, kBlock.tetrahedra);
  VisualShape shape(kAround, binding, kBlock.nodes);
  // The middle layer of five along x is taken out, what is left of it moves away.
  std::vector<int> piece;
  for (const auto& t : kBlock.tetrahedra) {
    double middle = 0;
    for (const int n : t) middle += kBlock.nodes[n].x() / 4;
    piece.push_back(std::abs(middle) < 0.01 ? -1 : middle < 0 ? 1 : 2);
  }
  shape.part(piece);
  std::vector<Vector3f> nodes;
  for (const Vector3d& x : kBlock.nodes)
    nodes.push_back(x.cast<float>() + (x.x() < 0 ? Vector3f(-0.1f, 0, 0) : Vector3f::Zero()));
  shape.place(nodes);
  std::size_t left = 0, whole = 0;
  for (std::size_t p = 0; p < shape.mesh().parts.size(); ++p) {
    const int first = shape.mesh().parts[p].first;
    whole += shape.mesh().parts[p].triangles.size();
    for (const auto& t : shape.triangles(p)) {
      ++left;
      for (int k = 0; k < 3; ++k) {
        const int v = first + t[k], w = first + t[(k + 1) % 3];
        const float now = (shape.position()[v] - shape.position()[w]).norm();
        const float then = (kAround.position[v] - kAround.position[w]).norm();
        EXPECT_NEAR(now, then, 1e-6) << "a triangle spans the cut";
      }
    }
  }
  EXPECT_LT(left, whole);
  EXPECT_GT(left, whole / 2);
}

TEST(VisualShape, PlacesWithoutTakingMemory) {
  VisualShape shape(kAround, bind_visual(kAround.position, kBlock.nodes, {}, kBlock.tetrahedra), kBlock.nodes);
  const std::vector<Vector3f> nodes = mapped(kBlock.nodes, some_map());
  const long before = allocations();
  shape.place(nodes);
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace palpate
