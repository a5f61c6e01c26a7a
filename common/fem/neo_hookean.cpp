#include "common/fem/neo_hookean.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

using Corners = Eigen::Matrix<double, 4, 3>;

Eigen::Matrix3d deformation_gradient(const TetGradients& tet, const Corners& u) {
  return Eigen::Matrix3d::Identity() + u.transpose() * tet.gradient;
}

ElementResponse linear_response(const TetGradients& tet, const Lame& lame, const Corners& u) {
  ElementResponse r;
  r.tangent = element_stiffness(tet, lame);
  const Eigen::Matrix<double, 3, 4> columns = u.transpose();
  r.gradient = r.tangent * Eigen::Map<const Eigen::Matrix<double, 12, 1>>(columns.data());
  r.energy = palpate::element_energy(tet, lame, u);
  return r;
}

}  // namespace

double element_energy(Law law, const TetGradients& tet, const Lame& lame, const Corners& u) {
  if (law == Law::linear) return palpate::element_energy(tet, lame, u);
  const Eigen::Matrix3d f = deformation_gradient(tet, u);
  const double j = f.determinant();
  if (j <= 0) return std::numeric_limits<double>::infinity();
  const double log_j = std::log(j);
  return tet.volume * (lame.mu / 2 * (f.squaredNorm() - 3) - lame.mu * log_j + lame.lambda / 2 * log_j * log_j);
}

// First Piola stress P = mu (F - F^-T) + lambda ln J F^-T; with h_a = F^-T g_a,
// K_ab = V (mu g_a.g_b I + (mu - lambda ln J) h_b h_a^T + lambda h_a h_b^T).
ElementResponse element_response(Law law, const TetGradients& tet, const Lame& lame, const Corners& u) {
  if (law == Law::linear) return linear_response(tet, lame, u);
  ElementResponse r;
  r.energy = element_energy(law, tet, lame, u);
  const Eigen::Matrix3d f = deformation_gradient(tet, u), inverse = f.inverse();
  const double log_j = std::log(f.determinant());
  const Eigen::Matrix3d stress = lame.mu * f + (lame.lambda * log_j - lame.mu) * inverse.transpose();
  const Corners h = tet.gradient * inverse;
  for (int a = 0; a < 4; ++a) {
    r.gradient.segment<3>(3 * a) = tet.volume * stress * tet.gradient.row(a).transpose();
    for (int b = 0; b < 4; ++b)
      r.tangent.block<3, 3>(3 * a, 3 * b) =
          tet.volume * (lame.mu * tet.gradient.row(a).dot(tet.gradient.row(b)) * Eigen::Matrix3d::Identity() +
                        (lame.mu - lame.lambda * log_j) * h.row(b).transpose() * h.row(a) +
                        lame.lambda * h.row(a).transpose() * h.row(b));
  }
  return r;
}

}  // namespace palpate
