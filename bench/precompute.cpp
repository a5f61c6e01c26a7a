#include "common/models/quasi_static/precompute.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "bench/only.hpp"
#include "bench/report.hpp"
#include "common/fem/dense.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"

/// How long the tensors of a body take, from the loaded mesh to the renamed archive, beside a dense matrix
/// product of the same number of operations in the same run and beside the paper's conjugate gradients. The
/// operations counted are those of the sparse factorisation (CHOLMOD's count, for the surface's Schur
/// complement and its factor) and 2/3 t^3 for the inverse of the t x t factor of the touchable dofs; a
/// product of n x n matrices takes 2 n^3.
namespace palpate::bench {
namespace {

struct Case {
  std::string name;
  QuasiStaticSpec body;
  TetMesh mesh;
};

Case make_case(const std::string& name, TetMesh mesh, const std::string& fixed_group) {
  Case one{name, {}, std::move(mesh)};
  one.body.name = name;
  one.body.material = {10e3, 0.45, 1000};
  one.body.fixed.emplace_back();
  one.body.fixed[0].where.group = fixed_group;
  return one;
}

Case make_block_case(const std::string& name, const std::array<int, 3>& cells) {
  const Eigen::Vector3d extent(0.01 * cells[0], 0.01 * cells[1], 0.01 * cells[2]);
  return make_case(name, make_block({0, 0, 0}, extent, cells), "bottom");
}

Archive archive_of(const Case& one, PrecomputeCost* cost) {
  return precompute(one.body, one.mesh, nullptr, {}, Route::fastest, cost);
}

/// Median time of an n x n product with as many operations.
double dense_product_seconds(double flops, int runs) {
  const auto n = static_cast<Eigen::Index>(std::cbrt(flops / 2));
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(n, n, 0.5), b = Eigen::MatrixXd::Constant(n, n, 0.25);
  Samples samples;
  samples.measure(1, runs, [&](int) { keep(dense_product(a, b)); });
  return samples.median() * flops / (2.0 * n * n * n);
}

void measure_precompute(const Case& one, int runs) {
  const auto file = std::filesystem::temp_directory_path() / ("palpate-bench-" + one.name) / "a.h5";
  PrecomputeCost cost;
  Samples samples;
  samples.measure(1, runs, [&](int) { write_archive(archive_of(one, &cost), file); });
  std::filesystem::remove_all(file.parent_path());
  report("precompute", one.name, "nodes", static_cast<double>(one.mesh.nodes.size()), "1");
  report("precompute", one.name, "tetrahedra", static_cast<double>(one.mesh.tetrahedra.size()), "1");
  report("precompute", one.name, "wall", samples.median(), "s");
  report("precompute", one.name, "operations", 1e-9 * cost.flops, "Gflop");
  const double product = dense_product_seconds(cost.flops, runs);
  report("precompute", one.name, "dense_product_wall", product, "s");
  report("precompute", one.name, "dense_product_ratio", samples.median() / product, "1");
}

/// The paper's way: one conjugate-gradient solution per touchable dof (Jacobi preconditioner). The time for
/// all columns is scaled up from an even sample of them; the error is the largest over the sample, against
/// CHOLMOD.
void measure_conjugate_gradients(const Case& one, const std::string& text, double tolerance, int sample) {
  const auto archive = archive_of(one, nullptr);
  const auto dofs = apply_boundary_conditions(one.mesh, one.body.fixed, one.name);
  const auto lower = assemble_stiffness(one.mesh, material_field(one.body, one.mesh), dofs);
  const SparseMatrix stiffness = lower.selfadjointView<Eigen::Lower>();
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper> solver(stiffness);
  solver.setTolerance(tolerance);

  const auto& columns = archive.touchable_dofs;
  const auto free_index = [&](const Dof& dof) { return dofs.index(archive.surface.node_number[dof.node], dof.axis); };
  double error = 0;
  Samples samples;
  for (int s = 0; s < sample; ++s) {
    const std::size_t j = (2 * s + 1) * columns.size() / (2 * sample);
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(stiffness.rows()), x;
    unit[free_index(columns[j])] = 1;
    samples.measure(0, 1, [&](int) { x = solver.solve(unit); });
    double worst = 0, size = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::size_t high = std::max(i, j), low = std::min(i, j);
      const double exact = archive.touchable_compliance[high * (high + 1) / 2 + low];
      worst = std::max(worst, std::abs(x[free_index(columns[i])] - exact));
      size = std::max(size, std::abs(exact));
    }
    error = std::max(error, worst / size);
  }
  const std::string name = one.name + "_cg_tol" + text;
  report("precompute", name, "columns_measured", sample, "1");
  report("precompute", name, "wall", samples.median() * static_cast<double>(columns.size()), "s");
  report("precompute", name, "error", error, "1");
}

void run(int argc, char** argv) {
  const bool is_quick = quick(argc, argv);
  const std::string liver_file = std::string(PALPATE_SOURCE_DIR) + "/scenes/meshes/liver.msh";
  const auto liver = make_case("liver1400", load_tet_mesh(liver_file, 1), "attachment");
  const auto measure = [&](const Case& one, int runs) {
    if (is_asked_for(one.name, argc, argv)) measure_precompute(one, runs);
  };
  measure(liver, is_quick ? 5 : 15);
  measure(make_block_case("nodes210", {4, 5, 6}), is_quick ? 5 : 15);
  measure(make_block_case("nodes1728", {11, 11, 11}), is_quick ? 3 : 9);
  measure(make_block_case("box10k", {20, 20, 22}), is_quick ? 1 : 3);
  for (const auto& [text, tolerance] : {std::pair{"1e-3", 1e-3}, {"1e-6", 1e-6}, {"1e-9", 1e-9}})
    if (is_asked_for(fmt::format("liver1400_cg_tol{}", text), argc, argv))
      measure_conjugate_gradients(liver, text, tolerance, is_quick ? 8 : 64);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) try {
  palpate::use_blas_of_this_processor(argv);
  palpate::bench::run(argc, argv);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_precompute: %s\n", error.what());
  return 1;
}
