#include "common/fem/linear_contact.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/fem/dense.hpp"
#include "common/fem/ordering.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr int kMaxRounds = 200;
constexpr double kNear = 1.2;  // radii about the ball's middle in which nodes are tried

/// Those that may touch the ball come last, so that the last block of the factor is that of their compliance's inverse.
Factorisation factorised(const StaticProblem& problem, const std::vector<int>& last) {
  const NodeGraph graph = node_graph(problem.mesh, problem.materials);
  const SparseMatrix stiffness = assemble_stiffness(problem.mesh, problem.materials, problem.dofs, graph);
  Factorisation factor(stiffness, dof_order(problem.dofs, interior_first_order(graph, last)));
  factor.factorise(stiffness);
  return factor;
}

std::vector<int> near_any(const StaticProblem& problem, const std::vector<int>& surface,
                          std::span<const Eigen::Vector3d> centres, double reach) {
  std::vector<int> nodes;
  for (const int n : surface)
    if (std::ranges::any_of(centres, [&](const auto& c) { return (problem.mesh.nodes[n] - c).norm() < reach; }))
      nodes.push_back(n);
  return nodes;
}

}  // namespace

LinearContact::LinearContact(StaticProblem problem, std::span<const Eigen::Vector3d> centres, double reach)
    : problem_(std::move(problem)),
      surface_(extract_surface(problem_.mesh).nodes),
      all_{near_any(problem_, surface_, centres, reach), {}},
      factor_(factorised(problem_, all_.node)) {
  const auto size = static_cast<Eigen::Index>(3 * all_.node.size());
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < size; ++i)
    if (problem_.dofs.is_free(all_.node[i / 3], static_cast<int>(i % 3))) free.push_back(i);
  Eigen::MatrixXd among = factor_.trailing_factor(static_cast<int>(free.size()));
  invert_from_cholesky(among);
  all_.compliance = Eigen::MatrixXd::Zero(size, size);
  all_.compliance(free, free) = among.selfadjointView<Eigen::Lower>();
}

LinearContact::Candidates LinearContact::near(const Sphere& ball) const {
  Candidates candidates;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < all_.node.size(); ++i) {
    if ((problem_.mesh.nodes[all_.node[i]] - ball.centre).norm() > kNear * ball.radius) continue;
    candidates.node.push_back(all_.node[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) rows.push_back(static_cast<Eigen::Index>(3 * i + axis));
  }
  candidates.compliance = all_.compliance(rows, rows);
  return candidates;
}

// Normal forces that keep the active nodes on the planes that stand for the ball; nodes that would be pulled
// are let go and nodes beyond their plane taken in, until none is left.
Eigen::VectorXd LinearContact::solve_normal_forces(const Sphere& ball, const Candidates& candidates,
                                                   const std::vector<Eigen::Vector3d>& normal,
                                                   std::vector<char>& active) const {
  const auto& [node, compliance] = candidates;
  const std::size_t n = node.size();
  Eigen::MatrixXd along(n, n);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i <= j; ++i)
      along(i, j) = along(j, i) = normal[i].dot(Eigen::Vector3d(compliance.block<3, 3>(3 * i, 3 * j) * normal[j]));
  Eigen::VectorXd wanted(n);
  for (std::size_t i = 0; i < n; ++i)
    wanted[i] = ball.radius + normal[i].dot(ball.centre - problem_.mesh.nodes[node[i]]);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<Eigen::Index> held;
    for (std::size_t i = 0; i < n; ++i)
      if (active[i]) held.push_back(static_cast<Eigen::Index>(i));
    force.setZero();
    const Eigen::MatrixXd among = along(held, held);
    const Eigen::VectorXd to_meet = wanted(held);
    if (!held.empty()) {
      const Eigen::VectorXd found = solve_semidefinite(among, to_meet);
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
  const Candidates candidates = near(ball);
  const auto& [node, compliance] = candidates;
  const std::size_t n = node.size();
  std::vector<Eigen::Vector3d> normal(n);
  std::vector<char> active(n, 0);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * n), nodal = u, force;
  for (int round = 0;; ++round) {
    if (round == kMaxRounds) throw std::runtime_error("the normals of the contact do not settle");
    double turned = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d now = (problem_.mesh.nodes[node[i]] + u.segment<3>(3 * i) - ball.centre).normalized();
      turned = std::max(turned, round == 0 ? 1.0 : active[i] * (now - normal[i]).norm());
      normal[i] = now;
    }
    if (turned < 1e-8) break;
    force = solve_normal_forces(ball, candidates, normal, active);
    for (std::size_t i = 0; i < n; ++i) nodal.segment<3>(3 * i) = force[i] * normal[i];
    u = compliance * nodal;
  }
  PressState state;
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(problem_.dofs.size(), 1);
  for (std::size_t i = 0; i < 3 * n; ++i) {
    state.force[i % 3] += nodal[i];
    const int row = problem_.dofs.index(node[i / 3], static_cast<int>(i % 3));
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
