#pragma once
#include "common/fem/elasticity.hpp"

namespace palpate {

/// How an element answers a deformation.
enum class Law {
  linear,       ///< small strain; forces are those of K u at any displacement
  neo_hookean,  ///< W = mu/2 (tr F^T F - 3) - mu ln J + lambda/2 (ln J)^2, any rotation and stretch
};

/// Energy [J], forces [N] on the corners (-dW/du) and their tangent d2W/du2 [N/m] of one linear tetrahedron.
struct ElementResponse {
  double energy;
  Eigen::Matrix<double, 12, 1> gradient;  ///< dW/du, corner by corner
  Eigen::Matrix<double, 12, 12> tangent;
};

/// Displacements of the corners in the rows of `u` [m]. An element turned inside out has infinite energy.
double element_energy(Law law, const TetGradients& tet, const Lame& lame, const Eigen::Matrix<double, 4, 3>& u);
ElementResponse element_response(Law law, const TetGradients& tet, const Lame& lame,
                                 const Eigen::Matrix<double, 4, 3>& u);

}  // namespace palpate
