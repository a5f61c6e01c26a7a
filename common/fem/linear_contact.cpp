#include "common/fem/linear_contact.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/fem/dense.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/fem/hat_tractions.hpp"
#include "common/fem/ordering.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kMaxRounds = 200;
constexpr double kNear = 1.2;  // radii about the ball's middle in which nodes are tried

LinearContact::Space linear_space(const StaticProblem& problem) {
  const auto count = static_cast<Index>(problem.mesh.nodes.size());
  SparseMatrix own(count, count);
  own.setIdentity();
  NodeGraph graph = node_graph(problem.mesh, problem.materials);
  SparseMatrix stiffness = assemble_stiffness(problem.mesh, problem.materials, problem.dofs, graph);
  return {problem.mesh.nodes, problem.dofs, own, std::move(graph), stiffness};
}

LinearContact::Space quadratic_space(const StaticProblem& problem) {
  FineProblem fine =
      make_fine_problem(problem.mesh, {.element = FiniteElement::p2}, problem.materials, problem.dofs, "under a ball");
  NodeGraph graph = fine_graph(fine.space, nullptr);
  SparseMatrix stiffness = assemble_stiffness(fine.space, fine.materials, nullptr, fine.dofs, graph);
  return {fine.space.nodes, std::move(fine.dofs), hat_tractions(fine.space, problem.mesh, SurfaceWeight::hat),
          std::move(graph), stiffness};
}

LinearContact::Space make_space(const StaticProblem& problem, FiniteElement element) {
  return element == FiniteElement::p2 ? quadratic_space(problem) : linear_space(problem);
}

/// Those that may touch the ball come last, so that the last block of the factor is that of their compliance's inverse.
Factorisation factorised(const LinearContact::Space& space, const std::vector<int>& last) {
  Factorisation factor(space.stiffness, dof_order(space.dofs, interior_first_order(space.graph, last)));
  factor.factorise(space.stiffness);
  return factor;
}

/// Each node's direction, by its shares: 3 entries of each node x point.
SparseMatrix directions(const SparseMatrix& share, const std::vector<Vector3d>& normal) {
  SparseMatrix along(3 * share.rows(), share.cols());
  along.reserve(3 * share.nonZeros());
  for (Index point = 0; point < share.cols(); ++point) {
    along.startVec(point);
    for (SparseMatrix::InnerIterator it(share, point); it; ++it)
      for (Index axis = 0; axis < 3; ++axis)
        along.insertBack(3 * it.row() + axis, point) = normal[it.row()][axis] * it.value();
  }
  along.finalize();
  return along;
}

std::vector<int> near_any(const StaticProblem& problem, const std::vector<int>& surface,
                          std::span<const Vector3d> centres, double reach) {
  std::vector<int> nodes;
  for (const int n : surface)
    if (std::ranges::any_of(centres, [&](const auto& c) { return (problem.mesh.nodes[n] - c).norm() < reach; }))
      nodes.push_back(n);
  return nodes;
}

/// Forces, none negative, that keep what is active where it is `wanted`: what would be pulled is let go and what is
/// beyond taken in, until nothing is left.
VectorXd solve_forces(const MatrixXd& along, const VectorXd& wanted, double tolerance, std::vector<char>& active) {
  const auto n = static_cast<std::size_t>(wanted.size());
  VectorXd force = VectorXd::Zero(wanted.size());
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<Index> held;
    for (std::size_t i = 0; i < n; ++i)
      if (active[i]) held.push_back(static_cast<Index>(i));
    force.setZero();
    const MatrixXd among = along(held, held);
    const VectorXd to_meet = wanted(held);
    if (!held.empty()) {
      const VectorXd found = solve_semidefinite(among, to_meet);
      for (std::size_t i = 0; i < held.size(); ++i) force[held[i]] = found[static_cast<Index>(i)];
    }
    const VectorXd open = along * force - wanted;
    const double most = force.cwiseAbs().maxCoeff();
    bool changed = false;
    // Later rounds change one at a time, which cannot cycle.
    for (std::size_t i = 0; i < n && !(changed && round > kMaxRounds / 4); ++i) {
      const auto k = static_cast<Index>(i);
      const bool leaves = active[i] && force[k] < -1e-12 * most, comes = !active[i] && open[k] < -tolerance;
      if (!leaves && !comes) continue;
      active[i] = comes;
      changed = true;
    }
    if (!changed) return force;
  }
  throw std::runtime_error("the contact does not settle");
}

}  // namespace

LinearContact::LinearContact(const StaticProblem& problem, std::span<const Vector3d> centres, double reach,
                             FiniteElement element)
    : LinearContact(problem, make_space(problem, element), centres, reach) {}

LinearContact::LinearContact(StaticProblem problem, Space space, std::span<const Vector3d> centres, double reach)
    : problem_(std::move(problem)),
      surface_(extract_surface(problem_.mesh).nodes),
      space_(std::move(space)),
      all_(spread(near_any(problem_, surface_, centres, reach))),
      factor_(factorised(space_, all_.node)) {
  const auto size = static_cast<Index>(3 * all_.node.size());
  std::vector<Index> free;
  for (Index i = 0; i < size; ++i)
    if (space_.dofs.is_free(all_.node[i / 3], static_cast<int>(i % 3))) free.push_back(i);
  MatrixXd among = factor_.trailing_factor(static_cast<int>(free.size()));
  invert_from_cholesky(among);
  all_.compliance = MatrixXd::Zero(size, size);
  all_.compliance(free, free) = among.selfadjointView<Eigen::Lower>();
  space_.stiffness = {};
  space_.graph = {};
}

LinearContact::Candidates LinearContact::spread(std::vector<int> points) const {
  Candidates candidates{.point = std::move(points), .node = {}, .share = {}, .compliance = {}};
  std::vector<int>& node = candidates.node;
  for (const int p : candidates.point)
    for (SparseMatrix::InnerIterator it(space_.shares, p); it; ++it) node.push_back(static_cast<int>(it.row()));
  std::ranges::sort(node);
  node.erase(std::unique(node.begin(), node.end()), node.end());
  candidates.share.resize(static_cast<Index>(node.size()), static_cast<Index>(candidates.point.size()));
  for (std::size_t p = 0; p < candidates.point.size(); ++p) {
    const auto column = static_cast<Index>(p);
    candidates.share.startVec(column);
    for (SparseMatrix::InnerIterator it(space_.shares, candidates.point[p]); it; ++it)
      candidates.share.insertBack(std::ranges::lower_bound(node, static_cast<int>(it.row())) - node.begin(), column) =
          it.value();
  }
  candidates.share.finalize();
  return candidates;
}

LinearContact::Candidates LinearContact::near(const Sphere& ball) const {
  std::vector<int> points;
  for (const int p : all_.point)
    if ((problem_.mesh.nodes[p] - ball.centre).norm() <= kNear * ball.radius) points.push_back(p);
  Candidates candidates = spread(std::move(points));
  std::vector<Index> rows;
  for (const int node : candidates.node)
    for (Index axis = 0; axis < 3; ++axis)
      rows.push_back(3 * (std::ranges::lower_bound(all_.node, node) - all_.node.begin()) + axis);
  candidates.compliance = all_.compliance(rows, rows);
  return candidates;
}

PressState LinearContact::press(const Sphere& ball) const {
  const auto& [point, node, share, compliance] = near(ball);
  const auto n = static_cast<Index>(node.size());
  std::vector<Vector3d> normal(node.size());
  std::vector<char> active(point.size(), 0);
  VectorXd u = VectorXd::Zero(3 * n), nodal = u, depth(n);
  for (int round = 0;; ++round) {
    if (round == kMaxRounds) throw std::runtime_error("the normals of the contact do not settle");
    double turned = 0;
    for (Index a = 0; a < n; ++a) {
      const Vector3d from_centre = space_.nodes[node[a]] - ball.centre;
      const Vector3d now = (from_centre + u.segment<3>(3 * a)).normalized();
      const bool held = !nodal.segment<3>(3 * a).isZero(0);
      turned = std::max(turned, round == 0 ? 1.0 : held * (now - normal[a]).norm());
      normal[a] = now;
      depth[a] = ball.radius - now.dot(from_centre);
    }
    if (turned < 1e-8) break;
    const SparseMatrix along = directions(share, normal);
    const MatrixXd moved = compliance * along;
    const VectorXd force =
        solve_forces(along.transpose() * moved, share.transpose() * depth, 1e-9 * ball.radius, active);
    nodal = along * force;
    u = compliance * nodal;
  }
  PressState state;
  MatrixXd load = MatrixXd::Zero(space_.dofs.size(), 1);
  for (Index i = 0; i < 3 * n; ++i) {
    state.force[i % 3] += nodal[i];
    const int row = space_.dofs.index(node[i / 3], static_cast<int>(i % 3));
    if (row >= 0) load(row, 0) = nodal[i];
  }
  const MatrixXd answer = factor_.solve(load);
  state.displacement.assign(space_.nodes.size(), Vector3d::Zero());
  for (int dof = 0; dof < space_.dofs.size(); ++dof)
    state.displacement[space_.dofs.dof(dof) / 3][space_.dofs.dof(dof) % 3] = answer(dof, 0);
  state.penetration = penetration(ball, state.displacement);
  if (state.penetration > 1e-3 * ball.radius)
    throw std::runtime_error("the ball comes to nodes beyond the reach of the contact");
  return state;
}

double LinearContact::penetration(const Sphere& ball, const std::vector<Vector3d>& displacement) const {
  double deepest = 0;
  for (const int s : surface_) {
    double mean = 0;
    for (SparseMatrix::InnerIterator it(space_.shares, s); it; ++it)
      mean += it.value() * (ball.radius - (space_.nodes[it.row()] + displacement[it.row()] - ball.centre).norm());
    deepest = std::max(deepest, mean);
  }
  return deepest;
}

}  // namespace palpate
