// Do the shell elements converge to the published displacements, and does condensing the rotations pay?
// Besides the rows on stdout, an output path as argument gets case,element,mesh,dofs,value,target,error over
// all mesh sizes: scripts/shell_plots.py makes docs/shell.md's table and picture of it.
#include "bench/shell_cases.hpp"

#include <fstream>

#include "bench/report.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "common/shell/condensation.hpp"

namespace palpate::bench {
namespace {

using MakeCase = std::function<ShellCase(int n)>;

struct Published {
  std::string name;
  MakeCase make;
};

std::vector<Published> published() {
  return {{"scordelis_lo", [](int n) { return scordelis_lo(n); }},
          {"pinched_cylinder", [](int n) { return pinched_cylinder(n); }},
          {"hemisphere", [](int n) { return hemisphere(n); }},
          {"twisted_in_plane", [](int n) { return twisted_beam(n, true); }},
          {"twisted_out_of_plane", [](int n) { return twisted_beam(n, false); }},
          {"thin_twisted_in_plane", [](int n) { return twisted_beam(n, true, 0.0032); }},
          {"thin_twisted_out_of_plane", [](int n) { return twisted_beam(n, false, 0.0032); }},
          {"clamped_hypar", [](int n) { return clamped_hypar(n); }},
          {"square_plate_pressure", [](int n) { return square_plate(n, true); }},
          {"square_plate_force", [](int n) { return square_plate(n, false); }},
          {"long_plate_pressure", [](int n) { return square_plate(n, true, 5); }},
          {"long_plate_force", [](int n) { return square_plate(n, false, 5); }}};
}

/// The same cases on meshes that the polynomial element can have: all diagonals alike.
std::vector<Published> for_polynomial() {
  const auto alike = Diagonals::alike;
  return {{"scordelis_lo", [=](int n) { return scordelis_lo(n, alike); }},
          {"pinched_cylinder", [=](int n) { return pinched_cylinder(n, alike); }},
          {"twisted_in_plane", [=](int n) { return twisted_beam(n, true, 0.32, alike); }},
          {"twisted_out_of_plane", [=](int n) { return twisted_beam(n, false, 0.32, alike); }},
          {"clamped_hypar", [=](int n) { return clamped_hypar(n, alike); }},
          {"square_plate_pressure", [=](int n) { return square_plate(n, true, 1, alike); }},
          {"square_plate_force", [=](int n) { return square_plate(n, false, 1, alike); }}};
}

void converge(const Published& kind, Bending bending, int finest, std::ostream& table) {
  const std::string_view element = word_of(bending);
  double error = 0;
  for (int n = 4; n <= finest; n *= 2) {
    ShellCase shell = kind.make(n);
    const ShellAnswer answer = solve(shell, bending);
    error = answer.value / shell.target - 1;
    table << fmt::format("{},{},{},{},{:.8g},{:.8g},{:.4g}\n", kind.name, element, n, answer.size, answer.value,
                         shell.target, error);
  }
  const std::string suffix = bending == Bending::polynomial ? "_polynomial" : "";
  report("shell_cases", kind.name + suffix, fmt::format("error_n{}", finest), error, "1");
}

/// Median time of one solution [s].
template <class Solve>
double solution_time(int count, Solve&& solve) {
  Samples samples;
  samples.measure(2, count, [&](int) { keep(solve()); });
  return samples.median();
}

/// A cylinder of n x n cells as the unreduced system of the paper, dense with and without its rotations, and
/// as sparse as it is: time of a solution once factorised, and how far the condensed answer is from the full
/// one.
void condensation(int n, int count) {
  ShellCase shell = pinched_cylinder(n, Diagonals::alike);
  shell.dofs.number();
  const int translations = shell.dofs.translations();
  const auto lower =
      assemble_shell_stiffness(shell.mesh, shell.material, Bending::discrete_kirchhoff, shell.dofs, "cylinder");
  const Eigen::VectorXd load = load_vector(shell), forces = load.head(translations);
  Factorisation sparse(lower);
  sparse.factorise(lower);

  Samples condensing;
  Eigen::MatrixXd condensed;
  condensing.measure(0, 3, [&](int) { condensed = condense_rotations(lower, translations); });
  const DenseCholesky full{Eigen::MatrixXd(lower)}, small{condensed};
  const Eigen::VectorXd reference = sparse.solve(load).col(0).head(translations);
  const double difference = (small.solve(forces) - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();

  const double full_time = solution_time(count, [&] { return full.solve(load); });
  const double small_time = solution_time(count, [&] { return small.solve(forces); });
  const double sparse_time = solution_time(count, [&] { return sparse.solve(load); });
  const std::string name = fmt::format("condensed_{}", translations);
  report("shell_cases", name, "difference", difference, "1");
  report("shell_cases", name, "condensing", 1e3 * condensing.median(), "ms");
  report("shell_cases", name, "solve_dense_full", 1e6 * full_time, "us");
  report("shell_cases", name, "solve_dense_condensed", 1e6 * small_time, "us");
  report("shell_cases", name, "solve_sparse_full", 1e6 * sparse_time, "us");
  report("shell_cases", name, "gain", full_time / small_time, "1");
}

int run(int argc, char** argv) {
  std::ofstream table;
  for (int i = 1; i < argc; ++i)
    if (argv[i][0] != '-') table.open(argv[i]);
  if (table.fail()) return fmt::print(stderr, "bench_shell_cases: the table cannot be written\n"), 1;
  table << "case,element,mesh,dofs,value,target,error\n";
  const int finest = quick(argc, argv) ? 32 : 64;
  for (const auto& kind : published()) converge(kind, Bending::discrete_kirchhoff, finest, table);
  for (const auto& kind : for_polynomial()) converge(kind, Bending::polynomial, finest, table);
  for (int n : {8, 16, 24}) condensation(n, quick(argc, argv) ? 20 : 200);
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  return palpate::bench::run(argc, argv);
}
