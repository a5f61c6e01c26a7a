#pragma once
#include <Eigen/Core>
#include <array>

#include "common/fem/elasticity.hpp"
#include "common/fem/fine_space.hpp"

namespace palpate {

/// Gradients of an element's shape functions in rows [1/m]; edges are straight.
using ShapeGradients = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 10, 3>;

/// Of the 4 linear or 10 quadratic functions at barycentric coordinates `at`.
ShapeGradients shape_gradients(const TetGradients& tet, int functions, const Eigen::Vector4d& at);

/// One point for linear elements, four for quadratic ones: exact for products of two gradients. Weights are
/// equal.
struct ElementQuadrature {
  int count;
  std::array<Eigen::Vector4d, 4> at;  ///< barycentric coordinates
  std::array<ShapeGradients, 4> gradient;
  double weight;  ///< [m^3]
};

TetGradients corner_gradients(const FineSpace& space, int element);
ElementQuadrature quadrature(const FineSpace& space, int element);

/// Block of the stiffness between two nodes of the element [N/m], as stiffness_block() integrated.
Eigen::Matrix3d fine_stiffness_block(const ElementQuadrature& points, const Lame& lame, int j, int k);

}  // namespace palpate
