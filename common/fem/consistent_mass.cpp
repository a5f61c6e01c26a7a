#include "common/fem/consistent_mass.hpp"

#include <array>
#include <utility>

#include "common/fem/refine_mesh.hpp"
#include "common/mesh/quality.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// int N_i N_j as a share of the volume, in 420ths.
double share(int i, int j) {
  if (i > j) std::swap(i, j);
  if (j < 4) return i == j ? 6 : 1;
  const auto& edge = kTetEdges[j - 4];
  if (i < 4) return i == edge[0] || i == edge[1] ? -4 : -6;
  if (i == j) return 32;
  const auto& other = kTetEdges[i - 4];
  const bool meet = other[0] == edge[0] || other[0] == edge[1] || other[1] == edge[0] || other[1] == edge[1];
  return meet ? 16 : 8;
}

Eigen::Matrix<double, 10, 10> shares() {
  Eigen::Matrix<double, 10, 10> all;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) all(i, j) = share(i, j) / 420;
  return all;
}

}  // namespace

MatrixXd times_consistent_mass(const FineSpace& space, const MaterialField& materials, const DofMap& dofs,
                               const MatrixXd& x) {
  const auto of_element = shares();
  MatrixXd product = MatrixXd::Zero(x.rows(), x.cols());
  MatrixXd local(10, x.cols());
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const double density = materials.at(static_cast<int>(e) / space.children).density;
    const double own = density * tet_volume(space.mesh, space.mesh.tetrahedra[e]);
    for (int axis = 0; axis < 3; ++axis) {
      std::array<int, 10> row;
      for (int i = 0; i < 10; ++i) {
        row[i] = dofs.index(space.elements[e][i], axis);
        if (row[i] >= 0)
          local.row(i) = x.row(row[i]);
        else
          local.row(i).setZero();
      }
      const MatrixXd moved = own * (of_element * local);
      for (int i = 0; i < 10; ++i)
        if (row[i] >= 0) product.row(row[i]) += moved.row(i);
    }
  }
  return product;
}

}  // namespace palpate
