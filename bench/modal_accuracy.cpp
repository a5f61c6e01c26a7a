// How well and how fast do the lowest modes stand for a whole shell (BHS01 app. B: NIRMS against DNIOS)?
// Errors of r modes under a point load, at rest and in motion, with and without residual flexibility; time of
// a step over r and over the number of dofs; what condensing the rotations gains. scripts/modal_plots.py
// makes docs/modes.md's tables and pictures of these rows.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "bench/report.hpp"
#include "bench/shell_bodies.hpp"
#include "common/fem/factorisation.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/models/modal_shell/modal_newmark.hpp"
#include "common/shell/condensation.hpp"
#include "common/shell/full_newmark.hpp"
#include "common/shell/modes.hpp"

namespace palpate::bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kStep = 1e-3;   // [s] of a haptic step
constexpr double kDamping = 20;  // [1/s] proportional to mass
constexpr double kPush = 0.02;   // [N]

void row(const std::string& name, const std::string& metric, double value, std::string_view unit) {
  report("modal_accuracy", name, metric, value, unit);
}

std::span<const double> view(const VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

// ---- Errors of r modes.

struct Motion {
  std::string name;
  std::function<double(double)> force;  // [N] over time
};

const std::vector<Motion>& motions() {
  static const std::vector<Motion> all{
      {"tap", [](double t) { return t < 0.03 ? kPush * std::pow(std::sin(pi * t / 0.03), 2) : 0; }},
      {"sudden", [](double) { return kPush; }},
  };
  return all;
}

/// Displacements of the unreduced system, a column per step.
MatrixXd full_motion(const ShellSystem& system, int dof, const Motion& motion, int steps) {
  const VectorXd none = VectorXd::Zero(system.translations());
  VectorXd force = none;
  FullNewmark newmark(system.stiffness, system.mass, kDamping, kStep);
  force[dof] = motion.force(0);
  newmark.start(none, none, force);
  MatrixXd path(none.size(), steps);
  for (int i = 0; i < steps; ++i) {
    force[dof] = motion.force((i + 1) * kStep);
    newmark.step(force);
    path.col(i) = newmark.displacement();
  }
  return path;
}

/// The same by the first r modes; `residual` [m/N]: column of the residual flexibility, or zero.
MatrixXd modal_motion(const Modes& modes, int r, const VectorXd& residual, int dof, const Motion& motion, int steps) {
  const VectorXd omega = modes.omega.head(r), share = modes.shape.row(dof).head(r);
  ModalNewmark newmark(view(omega), modal_damping(view(omega), 0, kDamping), kStep);
  const VectorXd none = VectorXd::Zero(r);
  newmark.start(view(none), view(none), view(motion.force(0) * share));
  MatrixXd path(modes.shape.rows(), steps);
  for (int i = 0; i < steps; ++i) {
    const double force = motion.force((i + 1) * kStep);
    newmark.step(view(force * share));
    path.col(i) = modes.shape.leftCols(r) * Eigen::Map<const VectorXd>(newmark.position().data(), r) + force * residual;
  }
  return path;
}

void error_rows(const std::string& name, const std::string& what, const MatrixXd& path, const MatrixXd& reference,
                int dof) {
  const MatrixXd difference = path - reference;
  row(name, what + "_point", difference.row(dof).cwiseAbs().maxCoeff() / reference.row(dof).cwiseAbs().maxCoeff(), "1");
  row(name, what + "_field", difference.colwise().norm().maxCoeff() / reference.colwise().norm().maxCoeff(), "1");
}

void accuracy(int around, int along, int steps) {
  const auto system = duct(around, along);
  const int n = system.translations(), dof = pushed_dof(system, around, along);
  Modes modes;
  row("all", "modes_time", seconds_of([&] { modes = lowest_modes(system.stiffness, system.mass, n); }), "s");
  row("r50", "modes_time", seconds_of([&] { lowest_modes(system.stiffness, system.mass, 50); }), "s");
  row("all", "translations", n, "1");
  row("all", "lowest", modes.omega[0] / (2 * pi), "Hz");
  row("r50", "highest", modes.omega[49] / (2 * pi), "Hz");
  row("all", "highest", modes.omega[n - 1] / (2 * pi), "Hz");

  Factorisation factor(system.stiffness);
  factor.factorise(system.stiffness);
  VectorXd unit = VectorXd::Zero(system.stiffness.rows());
  unit[dof] = 1;
  const VectorXd column = factor.solve(unit).topRows(n);
  std::vector<MatrixXd> references;
  for (const Motion& motion : motions()) references.push_back(full_motion(system, dof, motion, steps));

  for (int r : {5, 10, 20, 50, 100, n}) {
    const std::string name = r == n ? "all" : fmt::format("r{}", r);
    const VectorXd share = modes.shape.row(dof).head(r), soft = modes.omega.head(r).cwiseAbs2().cwiseInverse();
    const VectorXd by_modes = modes.shape.leftCols(r) * soft.cwiseProduct(share);
    const VectorXd none = VectorXd::Zero(n), residual = column - by_modes;
    error_rows(name, "static", by_modes, column, dof);
    row(name, "force_share", system.mass[dof] * share.squaredNorm(), "1");  // of M Phi f at the loaded dof
    row(name, "mode_share", static_cast<double>(r) / n, "1");
    for (std::size_t m = 0; m < motions().size(); ++m) {
      const Motion& motion = motions()[m];
      error_rows(name, motion.name, modal_motion(modes, r, none, dof, motion, steps), references[m], dof);
      error_rows(name, motion.name + "_residual", modal_motion(modes, r, residual, dof, motion, steps), references[m],
                 dof);
    }
  }
}

// ---- Time of a step.

/// What the fastest tenth of the samples does not exceed [s]: the work itself, not what else the machine does.
double fast(const Samples& samples) {
  return samples.quantile(0.1);
}

/// One step of r modes under a force on one node; with `field` the whole field is rebuilt, as app. B has it.
double modal_step_time(const Modes& modes, int r, bool field, int samples_wanted) {
  const MatrixXd shape = modes.shape.leftCols(r);
  const VectorXd omega = modes.omega.head(r);
  const auto constants = make_modal_constants(view(omega), modal_damping(view(omega), 0.2, 0), kStep);
  const MatrixXd touched = shape.middleRows(shape.rows() / 2, 3).transpose();
  VectorXd x = VectorXd::Zero(r), v = x, y = x, f = x, u(shape.rows());
  const Eigen::Vector3d force(kPush, 0, kPush);
  constexpr int kAtOnce = 16;  // a step of few modes is too short for the clock
  Samples samples;
  samples.measure(20, samples_wanted, [&](int) {
    for (int i = 0; i < kAtOnce; ++i) {
      f.noalias() = touched * force;
      free_motion(constants, x.data(), v.data(), f.data(), y.data());
      advance(constants, x.data(), v.data(), y.data());
      if (field) u.noalias() = shape * x;
      keep(u[0]);
    }
  });
  return fast(samples) / kAtOnce;
}

double full_step_time(FullNewmark& newmark, Eigen::Index n, bool reflect, int samples_wanted) {
  const VectorXd none = VectorXd::Zero(n), load = VectorXd::Constant(n, 1e-6);
  newmark.start(none, none, load);
  Samples samples;
  samples.measure(3, samples_wanted, [&](int) {
    newmark.step(load);
    if (reflect) keep(newmark.force()[0]);
  });
  return fast(samples);
}

void cost_of_modes(const Modes& modes, int samples) {
  for (int r : {5, 10, 20, 50, 100, static_cast<int>(modes.omega.size())}) {
    const std::string name = r == modes.omega.size() ? "all" : fmt::format("r{}", r);
    row(name, "step", 1e6 * modal_step_time(modes, r, false, samples), "us");
    row(name, "step_field", 1e6 * modal_step_time(modes, r, true, samples), "us");
  }
}

/// Step 4 of app. B, the force that is reflected, included: 2 n^2 operations more for the dense system.
void cost_over_size(int around, int along, bool dense, int samples) {
  const auto system = duct(around, along);
  const int n = system.translations();
  const std::string name = fmt::format("n{}", n);
  Modes modes;
  row(name, "modes_time", seconds_of([&] { modes = lowest_modes(system.stiffness, system.mass, 50); }), "s");
  row(name, "nirms", 1e6 * modal_step_time(modes, 50, false, samples), "us");
  row(name, "nirms_field", 1e6 * modal_step_time(modes, 50, true, samples), "us");
  FullNewmark sparse(system.stiffness, system.mass, kDamping, kStep);
  row(name, "dnios_sparse", 1e6 * full_step_time(sparse, n, false, samples / 4), "us");
  if (!dense) return;
  FullNewmark condensed(condense_rotations(system.stiffness, n), system.mass, kDamping, kStep);
  row(name, "dnios_dense", 1e6 * full_step_time(condensed, n, true, samples / 8), "us");
}

// ---- Condensed statics.

void condensed_statics(int around, int along, int samples) {
  const auto system = duct(around, along);
  const int n = system.translations(), all = static_cast<int>(system.stiffness.rows());
  VectorXd load = VectorXd::Zero(all);
  load[pushed_dof(system, around, along)] = kPush;

  std::optional<Factorisation> sparse(system.stiffness);
  MatrixXd condensed;
  row("condensed", "translations", n, "1");
  row("condensed", "factor_sparse", 1e3 * seconds_of([&] { sparse->factorise(system.stiffness); }), "ms");
  row("condensed", "condensing", 1e3 * seconds_of([&] { condensed = condense_rotations(system.stiffness, n); }), "ms");
  const MatrixXd whole = MatrixXd(system.stiffness).selfadjointView<Eigen::Lower>();
  std::optional<Eigen::LLT<MatrixXd>> of_whole, of_condensed;
  row("condensed", "factor_full", 1e3 * seconds_of([&] { of_whole.emplace(whole); }), "ms");
  row("condensed", "factor_condensed", 1e3 * seconds_of([&] { of_condensed.emplace(condensed); }), "ms");

  VectorXd by_sparse, by_full, by_condensed;
  const auto time = [&](const char* metric, const std::function<void()>& work) {
    Samples times;
    times.measure(2, samples, [&](int) { work(); });
    row("condensed", metric, 1e6 * fast(times), "us");
  };
  time("solve_sparse", [&] { by_sparse = sparse->solve(load).topRows(n); });
  time("solve_full", [&] { by_full = of_whole->solve(load).head(n); });
  time("solve_condensed", [&] { by_condensed = of_condensed->solve(load.head(n)); });
  row("condensed", "difference", (by_condensed - by_sparse).norm() / by_sparse.norm(), "1");
  row("condensed", "difference_full", (by_condensed - by_full).norm() / by_full.norm(), "1");
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  using namespace palpate;
  using namespace palpate::bench;
  const bool few = quick(argc, argv);
  accuracy(16, few ? 16 : 24, few ? 200 : 500);
  const auto system = duct(16, few ? 16 : 24);
  cost_of_modes(lowest_modes(system.stiffness, system.mass, system.translations()), few ? 100 : 400);
  for (const auto& [around, along] : {std::pair{8, 8}, {8, 16}, {12, 20}, {16, 30}, {20, 40}, {32, 60}, {48, 80}})
    if (!few || along <= 40) cost_over_size(around, along, along <= 40, few ? 40 : 200);
  condensed_statics(16, 24, few ? 20 : 100);
}
