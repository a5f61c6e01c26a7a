#include "common/fem/elasticity.hpp"

#include <Eigen/LU>

namespace palpate {

Lame lame(const Material& material) {
  const double e = material.young, nu = material.poisson;
  return {e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))};
}

TetGradients tet_gradients(const std::array<Eigen::Vector3d, 4>& vertices) {
  Eigen::Matrix3d edges;
  for (int j = 0; j < 3; ++j) edges.col(j) = vertices[j + 1] - vertices[0];
  TetGradients tet;
  tet.gradient.bottomRows<3>() = edges.inverse();
  tet.gradient.row(0) = -tet.gradient.bottomRows<3>().colwise().sum();
  tet.volume = edges.determinant() / 6;
  return tet;
}

Eigen::Matrix3d stiffness_block(const TetGradients& tet, const Lame& lame, int j, int k) {
  const Eigen::Vector3d gj = tet.gradient.row(j), gk = tet.gradient.row(k);
  return tet.volume * (lame.lambda * gj * gk.transpose() + lame.mu * gk * gj.transpose() +
                       lame.mu * gj.dot(gk) * Eigen::Matrix3d::Identity());
}

Eigen::Matrix<double, 12, 12> element_stiffness(const TetGradients& tet, const Lame& lame) {
  Eigen::Matrix<double, 12, 12> k;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) k.block<3, 3>(3 * i, 3 * j) = stiffness_block(tet, lame, i, j);
  return k;
}

Eigen::Matrix3d element_strain(const TetGradients& tet, const Eigen::Matrix<double, 4, 3>& u) {
  const Eigen::Matrix3d gradient = u.transpose() * tet.gradient;
  return 0.5 * (gradient + gradient.transpose());
}

Eigen::Matrix3d element_stress(const TetGradients& tet, const Lame& lame, const Eigen::Matrix<double, 4, 3>& u) {
  const Eigen::Matrix3d e = element_strain(tet, u);
  return lame.lambda * e.trace() * Eigen::Matrix3d::Identity() + 2 * lame.mu * e;
}

double element_energy(const TetGradients& tet, const Lame& lame, const Eigen::Matrix<double, 4, 3>& u) {
  const Eigen::Matrix3d e = element_strain(tet, u);
  return tet.volume * (0.5 * lame.lambda * e.trace() * e.trace() + lame.mu * e.squaredNorm());
}

}  // namespace palpate
