#pragma once
#include <Eigen/Core>
#include <array>

#include "common/fem/solid_spec.hpp"

namespace palpate {

/// Lamé's constants [Pa] of an isotropic linear material.
struct Lame {
  double lambda, mu;
};

Lame lame(const Material& material);

/// Gradients of the four linear shape functions and the volume of a tetrahedron.
struct TetGradients {
  Eigen::Matrix<double, 4, 3> gradient;  ///< row j: gradient of shape function j [1/m]
  double volume;                         ///< [m^3], positive for a positively oriented tetrahedron
};

/// From the inverse of the vertex matrix. RR3510 App. A's cyclic index formula is not used: there M_j changes
/// sign with j.
TetGradients tet_gradients(const std::array<Eigen::Vector3d, 4>& vertices);

/// Stiffness block K_jk [N/m] between two vertices of a tetrahedron: force at j per displacement of k,
///   K_jk = V (lambda g_j g_k^T + mu g_k g_j^T + mu (g_j . g_k) I).
/// RR3510 eq. 5 prints the two outer products exchanged; as printed it is not the Hessian of its eq. 1.
Eigen::Matrix3d stiffness_block(const TetGradients& tet, const Lame& lame, int j, int k);

/// The whole element: 12 x 12, vertex by vertex, x y z within a vertex [N/m].
Eigen::Matrix<double, 12, 12> element_stiffness(const TetGradients& tet, const Lame& lame);

/// Constant small strain of an element [1] and its stress [Pa] for vertex displacements in the rows of `u`
/// [m].
Eigen::Matrix3d element_strain(const TetGradients& tet, const Eigen::Matrix<double, 4, 3>& u);
Eigen::Matrix3d element_stress(const TetGradients& tet, const Lame& lame, const Eigen::Matrix<double, 4, 3>& u);

/// Elastic energy of an element [J]: V (lambda/2 (tr e)^2 + mu e:e) (RR3510 eq. 1).
double element_energy(const TetGradients& tet, const Lame& lame, const Eigen::Matrix<double, 4, 3>& u);

}  // namespace palpate
