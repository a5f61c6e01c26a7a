#include "common/fem/fine_element.hpp"

#include <cmath>

#include "common/fem/refine_mesh.hpp"

namespace palpate {

ShapeGradients shape_gradients(const TetGradients& tet, int functions, const Eigen::Vector4d& at) {
  if (functions == 4) return tet.gradient;
  ShapeGradients gradient(10, 3);
  for (int c = 0; c < 4; ++c) gradient.row(c) = (4 * at[c] - 1) * tet.gradient.row(c);
  for (int e = 0; e < 6; ++e) {
    const auto [a, b] = kTetEdges[e];
    gradient.row(4 + e) = 4 * (at[a] * tet.gradient.row(b) + at[b] * tet.gradient.row(a));
  }
  return gradient;
}

TetGradients corner_gradients(const FineSpace& space, int element) {
  const auto& tet = space.mesh.tetrahedra[element];
  const auto& nodes = space.mesh.nodes;
  return tet_gradients({nodes[tet[0]], nodes[tet[1]], nodes[tet[2]], nodes[tet[3]]});
}

ElementQuadrature quadrature(const FineSpace& space, int element) {
  const auto tet = corner_gradients(space, element);
  ElementQuadrature points;
  if (space.per_element == 4) {
    points.count = 1;
    points.at[0].setConstant(0.25);
  } else {
    points.count = 4;
    const double far = (5 - std::sqrt(5.0)) / 20;
    for (int q = 0; q < 4; ++q) {
      points.at[q].setConstant(far);
      points.at[q][q] = 1 - 3 * far;
    }
  }
  points.weight = tet.volume / points.count;
  for (int q = 0; q < points.count; ++q) points.gradient[q] = shape_gradients(tet, space.per_element, points.at[q]);
  return points;
}

Eigen::Matrix3d fine_stiffness_block(const ElementQuadrature& points, const Lame& lame, int j, int k) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  for (int q = 0; q < points.count; ++q) {
    const Eigen::Vector3d gj = points.gradient[q].row(j), gk = points.gradient[q].row(k);
    block += lame.lambda * gj * gk.transpose() + lame.mu * gk * gj.transpose();
    block.diagonal().array() += lame.mu * gj.dot(gk);
  }
  return points.weight * block;
}

}  // namespace palpate
