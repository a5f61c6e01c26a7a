#include "common/models/vibration.hpp"

#include "common/models/catheter/chain.hpp"
#include "common/models/catheter/sleeve.hpp"

namespace palpate {
namespace {

/// Far below what a catheter swings at, and far above rounding in its stiffness.
constexpr double kShift = 1;  // [1/s^2]

}  // namespace

/// Straight, in its sleeve and clear of everything else: it slides freely, and without a sleeve it floats.
FreeVibration vibration(const CatheterSpec& body) {
  const Catheter& shape = body.catheter;
  const Chain chain(shape, body.material.young, body.material.density);
  BandMatrix matrix(chain.size());
  matrix.set_zero();
  chain.add_stiffness(chain.rest(), std::vector<double>(chain.size(), 0), matrix);
  std::vector<double> unused(matrix.order() + BandMatrix::kBand);
  Sleeve(shape.tail, shape.tip, shape.sleeve).add_springs(chain.rest(), matrix, unused);
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  for (int column = 0; column < matrix.order(); ++column)
    for (int row = column; row < std::min(matrix.order(), column + BandMatrix::kColumn); ++row)
      entries.emplace_back(row, column, matrix.entry(row, column));
  FreeVibration free{SparseMatrix(matrix.order(), matrix.order()), Eigen::VectorXd(matrix.order()), kShift};
  free.stiffness.setFromTriplets(entries.begin(), entries.end());
  for (int i = 0; i < matrix.order(); ++i) free.mass[i] = chain.mass()[i / 3];
  return free;
}

}  // namespace palpate
