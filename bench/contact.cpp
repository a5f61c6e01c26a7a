// What does a change of one contact among 64 cost, beside a fresh factorisation by the fastest code at hand?
// The matrix has the structure and order of 64 contacts on the liver; its values do not change the work.
#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "bench/report.hpp"
#include "common/kernels/kernels.hpp"

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void openblas_set_num_threads(int count);
}

namespace {
using namespace palpate;
using Eigen::MatrixXd;

/// Contacts scattered over a sphere of an organ's size in an unbounded incompressible solid: Kelvin's
/// solution for forces spread over the distance of neighbouring nodes, (I (r^2 + 2 e^2) + d d^T) / (8 pi G
/// (r^2 + e^2)^(3/2)).
MatrixXd contact_compliance(int contacts) {
  const double e = 0.01, shear = 1000;  // [m], [Pa]
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> x(contacts);
  for (auto& p : x) p = 0.1 * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  MatrixXd c(3 * contacts, 3 * contacts);
  for (int i = 0; i < contacts; ++i)
    for (int j = 0; j < contacts; ++j) {
      const Eigen::Vector3d d = x[i] - x[j];
      const double square = d.squaredNorm();
      const Eigen::Matrix3d spread = (square + 2 * e * e) * Eigen::Matrix3d::Identity() + d * d.transpose();
      c.block<3, 3>(3 * i, 3 * j) = spread / (8 * M_PI * shear * std::pow(square + e * e, 1.5));
    }
  return c;
}

/// The same matrix with the three rows and columns at `first` moved to the end.
MatrixXd moved_to_end(const MatrixXd& a, int first) {
  const int n = static_cast<int>(a.rows());
  Eigen::PermutationMatrix<Eigen::Dynamic> order(n);
  for (int i = 0; i < n; ++i) order.indices()[i] = i < first ? i : i < first + 3 ? n - 3 + i - first : i - 3;
  return order * a * order.transpose();
}

struct Factor {
  explicit Factor(int n) : n(n), ld(kernels::leading_dimension(n)), floor(n, 1e-20), l(ld * n), scratch(3 * ld) {}

  void load(const MatrixXd& a) {
    for (int j = 0; j < n; ++j) std::copy_n(a.col(j).data(), n, l.data() + j * ld);
  }
  double error(const MatrixXd& a) const {
    const Eigen::Map<const MatrixXd, 0, Eigen::OuterStride<>> map(l.data(), n, n, Eigen::OuterStride<>(ld));
    const MatrixXd lower = map.triangularView<Eigen::Lower>();
    return (lower * lower.transpose() - a).norm() / a.norm();
  }

  int n;
  std::ptrdiff_t ld;
  std::vector<double> floor;
  kernels::Buffer l, scratch;
};

/// Median time [s] of work() after load(), which is not counted.
template <class Work>
double fresh(Factor& factor, const MatrixXd& a, int repeat, Work&& work) {
  bench::Samples samples;
  for (int i = 0; i < repeat; ++i) {
    factor.load(a);
    samples.measure(0, 1, [&](int) { work(); });
  }
  return samples.median();
}

/// Median time [s] over all positions of removing one contact and inserting it again, which puts it last.
/// Like the fresh factorisations, every change starts from a buffer that has just been filled. `error`:
/// largest of the results.
double change(const kernels::Table& table, Factor& factor, const MatrixXd& a, int repeat, double& error) {
  factor.load(a);
  table.cholesky(factor.l.data(), factor.n, factor.ld, factor.floor.data());
  const kernels::Buffer held = factor.l;
  bench::Samples positions;
  const int n = factor.n;
  for (int first = 0; first < n; first += 3) {
    const MatrixXd reordered = moved_to_end(a, first);
    const MatrixXd rows = reordered.rightCols(3);  // their columns are the new rows, by symmetry
    bench::Samples samples;
    for (int i = 0; i < repeat; ++i) {
      factor.l = held;
      samples.measure(0, 1, [&](int) {
        table.cholesky_remove(factor.l.data(), n, factor.ld, first, 3, factor.scratch.data());
        table.cholesky_append(factor.l.data(), n - 3, factor.ld, rows.data(), n, 3, factor.floor.data());
      });
    }
    error = std::max(error, factor.error(reordered));
    positions.add(samples.median());
  }
  return positions.median();
}

int run(bool quick) {
  const kernels::Table& table = kernels::active();
  const int contacts = 64, repeat = quick ? 200 : 2000;
  const MatrixXd a = contact_compliance(contacts);
  Factor factor(3 * contacts);
  const int ld = static_cast<int>(factor.ld);
  int info = 0;
  openblas_set_num_threads(1);

  const double own =
      fresh(factor, a, repeat, [&] { table.cholesky(factor.l.data(), factor.n, factor.ld, factor.floor.data()); });
  const double lapack = fresh(factor, a, repeat, [&] { dpotrf_("L", &factor.n, factor.l.data(), &ld, &info); });
  Eigen::LLT<MatrixXd> llt(factor.n);
  const double eigen = fresh(factor, a, repeat, [&] { llt.compute(a); });
  double error = 0;
  const double changed = change(table, factor, a, quick ? 21 : 201, error);

  const auto row = [](std::string_view metric, double value, std::string_view unit) {
    bench::report("contact_change", "liver1400_64", metric, value, unit);
  };
  row("fresh_own", 1e6 * own, "us");
  row("fresh_openblas", 1e6 * lapack, "us");
  row("fresh_eigen", 1e6 * eigen, "us");
  row("change", 1e6 * changed, "us");
  row("residual", error, "1");
  row("speedup", std::min({own, lapack, eigen}) / changed, "1");
  return error < 1e-12 && info == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return run(palpate::bench::quick(argc, argv));
}
