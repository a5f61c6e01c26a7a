#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

namespace palpate {

/// Symmetric matrix of a chain of particles, three unknowns each, in which a particle meets its neighbours
/// and their neighbours: half bandwidth 8. Only the lower triangle is kept, column by column. Cost is linear
/// in the particles.
class BandMatrix {
 public:
  static constexpr int kBand = 8;            ///< entries below the diagonal
  static constexpr int kColumn = kBand + 1;  ///< stored entries of a column

  explicit BandMatrix(int particles);

  int order() const { return order_; }
  void set_zero();
  /// Takes over the other one's entries; both have the same order.
  void copy(const BandMatrix& other) { entry_ = other.entry_; }
  /// Adds a block at rows of particle `i + apart`, columns of particle `i`, apart = 0, 1, 2. Of a diagonal
  /// block, which must be symmetric, the lower half is read.
  void add(int i, int apart, const Eigen::Matrix3d& block);

  /// Of the lower triangle within the band; before factorise().
  double entry(int row, int column) const { return this->column(column)[row - column]; }

  /// Replaces the matrix by its Cholesky factor. False if it is not positive definite; nothing is usable
  /// then.
  bool factorise();
  /// Solves in place with the factor; `x` has order() + kBand entries, the last kBand of which are scratch.
  void solve(std::span<double> x) const;

 private:
  double* column(int j) { return entry_.data() + kColumn * j; }
  const double* column(int j) const { return entry_.data() + kColumn * j; }

  int order_;
  std::vector<double> entry_;  ///< kColumn per column, kBand empty columns behind; of a factor: inverse diagonal first
};

}  // namespace palpate
