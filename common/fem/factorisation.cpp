#include "common/fem/factorisation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/fem/cholmod_context.hpp"

namespace palpate {

struct Factorisation::Scratch::Impl {
  CholmodContext context;
  cholmod_dense* workspace[2] = {nullptr, nullptr};  // of cholmod_l_solve2

  ~Impl() {
    for (auto& dense : workspace) cholmod_l_free_dense(&dense, context.get());
  }
};

Factorisation::Scratch::Scratch() : impl_(std::make_unique<Impl>()) {}
Factorisation::Scratch::~Scratch() = default;

namespace {

[[noreturn]] void fail(int status, const std::string& what) {
  if (status == CHOLMOD_OUT_OF_MEMORY) throw std::runtime_error(what + ": not enough memory");
  if (status == CHOLMOD_TOO_LARGE) throw std::runtime_error(what + ": the problem is too large");
  throw std::runtime_error(fmt::format("{} (CHOLMOD status {})", what, status));
}

}  // namespace

struct Factorisation::Impl {
  CholmodContext context;
  Scratch scratch;
  cholmod_factor* factor = nullptr;
  double flops = 0;
  std::int64_t nonzeros = 0;

  ~Impl() { cholmod_l_free_factor(&factor, context.get()); }

  void analyse(const SparseMatrix& lower, std::span<const std::int64_t> order) {
    auto view = cholmod_view(lower);
    context->supernodal = CHOLMOD_SUPERNODAL;
    context->final_ll = true;
    context->nmethods = 1;
    context->method[0].ordering = order.empty() ? CHOLMOD_METIS : CHOLMOD_GIVEN;
    context->postorder = order.empty();
    auto* permutation = const_cast<std::int64_t*>(order.data());
    factor = cholmod_l_analyze_p(&view, reinterpret_cast<SuiteSparse_long*>(permutation), nullptr, 0, context.get());
    if (!factor) fail(context->status, "the analysis of the stiffness matrix failed");
    flops = context->fl;
    nonzeros = static_cast<std::int64_t>(context->lnz);
  }
};

Factorisation::Factorisation(const SparseMatrix& lower) : Factorisation(lower, {}) {}

Factorisation::Factorisation(const SparseMatrix& lower, std::span<const std::int64_t> order)
    : impl_(std::make_unique<Impl>()) {
  impl_->analyse(lower, order);
}

Factorisation::~Factorisation() = default;
Factorisation::Factorisation(Factorisation&&) noexcept = default;

double Factorisation::flops() const {
  return impl_->flops;
}
std::int64_t Factorisation::factor_nonzeros() const {
  return impl_->nonzeros;
}

void Factorisation::factorise(const SparseMatrix& lower) {
  auto view = cholmod_view(lower);
  cholmod_l_factorize(&view, impl_->factor, impl_->context.get());
  if (impl_->context->status == CHOLMOD_NOT_POSDEF)
    throw std::runtime_error(
        "the stiffness matrix is not positive definite: part of the body is not held, or its material or "
        "elements "
        "are degenerate");
  if (impl_->context->status < CHOLMOD_OK)
    fail(impl_->context->status, "the factorisation of the stiffness matrix failed");
}

Eigen::MatrixXd Factorisation::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x;
  solve_into(b, x, impl_->scratch);
  return x;
}

void Factorisation::solve_into(const Eigen::MatrixXd& b, Eigen::MatrixXd& x, Scratch& scratch) const {
  x.resize(b.rows(), b.cols());
  auto right = cholmod_view(b), answer = cholmod_view(x);
  cholmod_dense* into = &answer;  // which CHOLMOD keeps, since it has the size of the answer
  auto& [context, workspace] = *scratch.impl_;
  if (!cholmod_l_solve2(CHOLMOD_A, impl_->factor, &right, nullptr, &into, nullptr, &workspace[0], &workspace[1],
                        context.get()))
    fail(context->status, "the solution with the factor failed");
}

Eigen::MatrixXd Factorisation::trailing_factor(int count) const {
  const auto& factor = *impl_->factor;
  const auto* super = static_cast<const SuiteSparse_long*>(factor.super);
  const auto* row_begin = static_cast<const SuiteSparse_long*>(factor.pi);
  const auto* value_begin = static_cast<const SuiteSparse_long*>(factor.px);
  const auto* rows = static_cast<const SuiteSparse_long*>(factor.s);
  const auto* values = static_cast<const double*>(factor.x);
  const auto first = static_cast<SuiteSparse_long>(factor.n) - count;

  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const auto row_count = row_begin[s + 1] - row_begin[s];
    const auto* row = rows + row_begin[s];
    for (auto column = std::max(super[s], first); column < super[s + 1]; ++column) {
      const auto* value = values + value_begin[s] + (column - super[s]) * row_count;
      // Rows of a supernode start with its own columns, so the diagonal sits at this offset.
      for (auto i = column - super[s]; i < row_count; ++i) dense(row[i] - first, column - first) = value[i];
    }
  }
  return dense;
}

}  // namespace palpate
