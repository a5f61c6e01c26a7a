#include "common/shell/condensation.hpp"

#include <algorithm>

#include "common/fem/factorisation.hpp"

namespace palpate {
namespace {

/// Right-hand sides solved at once.
constexpr int kBlock = 64;

}  // namespace

Eigen::MatrixXd condense_rotations(const SparseMatrix& stiffness, int translations) {
  const auto rotations = stiffness.rows() - translations;
  const SparseMatrix tt = stiffness.topLeftCorner(translations, translations);
  Eigen::MatrixXd condensed = Eigen::MatrixXd(tt).selfadjointView<Eigen::Lower>();
  if (rotations == 0) return condensed;

  const SparseMatrix rr = stiffness.bottomRightCorner(rotations, rotations);
  const SparseMatrix rt = stiffness.bottomLeftCorner(rotations, translations);
  const SparseMatrix tr = rt.transpose();
  Factorisation factor(rr);
  factor.factorise(rr);
  for (int first = 0; first < translations; first += kBlock) {
    const int count = std::min(kBlock, translations - first);
    const Eigen::MatrixXd load = rt.middleCols(first, count);
    condensed.middleCols(first, count) -= tr * factor.solve(load);
  }
  return 0.5 * (condensed + condensed.transpose());
}

}  // namespace palpate
