#include "common/fem/linear_contact.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr int kMaxRounds = 200;
constexpr std::size_t kRightHandSides = 64;  // solved at once

Factorisation factorised(const StaticProblem& problem) {
  const SparseMatrix stiffness = assemble_stiffness(problem.mesh, problem.materials, problem.dofs);
  Factorisation factor(stiffness);
  factor.factorise(stiffness);
  return factor;
}

}  // namespace

LinearContact::LinearContact(StaticProblem problem, const Eigen::Vector3d& centre, double reach)
    : problem_(std::move(problem)), factor_(factorised(problem_)), surface_(extract_surface(problem_.mesh).nodes) {
  for (const int n : surface_)
    if ((problem_.mesh.nodes[n] - centre).norm() < reach) node_.push_back(n);
  const auto size = static_cast<Eigen::Index>(3 * node_.size());
  compliance_ = Eigen::MatrixXd::Zero(size, size);
  std::vector<int> row(static_cast<std::size_t>(size));
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < size; ++i) {
    row[i] = problem_.dofs.index(node_[i / 3], static_cast<int>(i % 3));
    if (row[i] >= 0) free.push_back(i);
  }
  for (std::size_t begin = 0; begin < free.size(); begin += kRightHandSides) {
    const std::size_t count = std::min(kRightHandSides, free.size() - begin);
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(problem_.dofs.size(), static_cast<Eigen::Index>(count));
    for (std::size_t c = 0; c < count; ++c) unit(row[free[begin + c]], static_cast<Eigen::Index>(c)) = 1;
    const Eigen::MatrixXd answer = factor_.solve(unit);
    for (std::size_t c = 0; c < count; ++c)
      for (const Eigen::Index i : free) compliance_(i, free[begin + c]) = answer(row[i], static_cast<Eigen::Index>(c));
  }
}

// Normal forces that keep the active nodes on the planes that stand for the ball; nodes that would be pulled
// are let go and nodes beyond their plane taken in, until none is left.
Eigen::VectorXd LinearContact::solve_normal_forces(const Sphere& ball, const std::vector<Eigen::Vector3d>& normal,
                                                   std::vector<char>& active) const {
  const std::size_t n = node_.size();
  Eigen::MatrixXd along(n, n);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i <= j; ++i)
      along(i, j) = along(j, i) = normal[i].dot(Eigen::Vector3d(compliance_.block<3, 3>(3 * i, 3 * j) * normal[j]));
  Eigen::VectorXd wanted(n);
  for (std::size_t i = 0; i < n; ++i)
    wanted[i] = ball.radius + normal[i].dot(ball.centre - problem_.mesh.nodes[node_[i]]);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<Eigen::Index> held;
    for (std::size_t i = 0; i < n; ++i)
      if (active[i]) held.push_back(static_cast<Eigen::Index>(i));
    force.setZero();
    const Eigen::MatrixXd among = along(held, held);
    const Eigen::VectorXd to_meet = wanted(held);
    if (!held.empty()) {
      const Eigen::VectorXd found = among.ldlt().solve(to_meet);
      for (std::size_t i = 0; i < held.size(); ++i) force[held[i]] = found[static_cast<Eigen::Index>(i)];
    }
    const Eigen::VectorXd open = along * force - wanted;
    const double most = force.cwiseAbs().maxCoeff();
    bool changed = false;
    // Later rounds change one node at a time, which cannot cycle.
    for (std::size_t i = 0; i < n && !(changed && round > kMaxRounds / 4); ++i) {
      const bool leaves = active[i] && force[i] < -1e-12 * most, comes = !active[i] && open[i] < -1e-9 * ball.radius;
      if (!leaves && !comes) continue;
      active[i] = comes;
      changed = true;
    }
    if (!changed) return force;
  }
  throw std::runtime_error("the contact does not settle");
}

PressState LinearContact::press(const Sphere& ball) const {
  const std::size_t n = node_.size();
  std::vector<Eigen::Vector3d> normal(n);
  std::vector<char> active(n, 0);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * n), nodal = u, force;
  for (int round = 0;; ++round) {
    if (round == kMaxRounds) throw std::runtime_error("the normals of the contact do not settle");
    double turned = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d now = (problem_.mesh.nodes[node_[i]] + u.segment<3>(3 * i) - ball.centre).normalized();
      turned = std::max(turned, round == 0 ? 1.0 : active[i] * (now - normal[i]).norm());
      normal[i] = now;
    }
    if (turned < 1e-8) break;
    force = solve_normal_forces(ball, normal, active);
    for (std::size_t i = 0; i < n; ++i) nodal.segment<3>(3 * i) = force[i] * normal[i];
    u = compliance_ * nodal;
  }
  PressState state;
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(problem_.dofs.size(), 1);
  for (std::size_t i = 0; i < 3 * n; ++i) {
    state.force[i % 3] += nodal[i];
    const int row = problem_.dofs.index(node_[i / 3], static_cast<int>(i % 3));
    if (row >= 0) load(row, 0) = nodal[i];
  }
  const Eigen::MatrixXd answer = factor_.solve(load);
  state.displacement.assign(problem_.mesh.nodes.size(), Eigen::Vector3d::Zero());
  for (int dof = 0; dof < problem_.dofs.size(); ++dof)
    state.displacement[problem_.dofs.dof(dof) / 3][problem_.dofs.dof(dof) % 3] = answer(dof, 0);
  for (const int s : surface_)
    state.penetration = std::max(state.penetration,
                                 ball.radius - (problem_.mesh.nodes[s] + state.displacement[s] - ball.centre).norm());
  if (state.penetration > 1e-3 * ball.radius)
    throw std::runtime_error("the ball comes to nodes beyond the reach of the contact");
  return state;
}

}  // namespace palpate
