#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "common/fem/assembly.hpp"

namespace palpate {

/// Supernodal Cholesky factor P K P^T = L L^T of a sparse symmetric positive definite matrix (CHOLMOD, 64-bit
/// indices). Constructing analyses the pattern only; factorise() does the arithmetic.
class Factorisation {
 public:
  /// Room that solving takes, kept from one time to the next. It belongs to the thread that makes it.
  class Scratch {
   public:
    Scratch();
    ~Scratch();

   private:
    friend class Factorisation;
    struct Impl;
    std::unique_ptr<Impl> impl_;
  };

  /// Orders with METIS.
  explicit Factorisation(const SparseMatrix& lower);
  /// Keeps the given order exactly: position i of the factor is row order[i].
  Factorisation(const SparseMatrix& lower, std::span<const std::int64_t> order);
  ~Factorisation();
  Factorisation(Factorisation&&) noexcept;

  double flops() const;                  ///< of the numerical factorisation, known after the analysis
  std::int64_t factor_nonzeros() const;  ///< entries of L

  /// Throws std::runtime_error if the matrix is not positive definite or memory runs out.
  void factorise(const SparseMatrix& lower);

  /// Solves K X = B for all columns of B at once.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// The same into `x`, whose memory serves again where its size is the same; threads solve at once, each with a
  /// scratch of its own.
  void solve_into(const Eigen::MatrixXd& b, Eigen::MatrixXd& x, Scratch& scratch) const;

  /// The last `count` rows and columns of L, dense; above the diagonal zero.
  Eigen::MatrixXd trailing_factor(int count) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate
