#include "common/fem/newton_solid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr int kMaxIterations = 30;
constexpr double kTolerance = 1e-8;  // of the unbalanced force
constexpr double kMinShare = 1e-3;   // of Newton's step that the line search tries

/// Where an entry of the lower triangle stands among the matrix's values; -1 outside it.
std::int64_t place_of(const SparseMatrix& matrix, int row, int column) {
  if (row < column || column < 0) return -1;
  const std::int64_t *begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column],
                     *end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  return std::lower_bound(begin, end, row) - matrix.innerIndexPtr();
}

}  // namespace

NewtonSolid::NewtonSolid(StaticProblem problem, Law law, double stiffness)
    : problem_(std::move(problem)),
      law_(law),
      stiffness_(stiffness),
      u_(problem_.mesh.nodes.size(), Eigen::Vector3d::Zero()) {
  const auto& x = problem_.mesh.nodes;
  for (std::size_t e = 0; e < problem_.mesh.tetrahedra.size(); ++e) {
    const auto& t = problem_.mesh.tetrahedra[e];
    tets_.push_back(tet_gradients({x[t[0]], x[t[1]], x[t[2]], x[t[3]]}));
    lame_.push_back(lame(problem_.materials.at(static_cast<int>(e))));
  }
  const Surface surface = extract_surface(problem_.mesh);
  surface_ = surface.nodes;
  const std::vector<double> area = node_areas(x, surface.triangles);
  for (const int n : surface_) area_.push_back(area[n]);
  tangent_ = assemble_stiffness(problem_.mesh, problem_.materials, problem_.dofs);
  gradient_.resize(problem_.dofs.size());
  factor_.emplace(tangent_);
  find_places();
}

void NewtonSolid::find_places() {
  const auto dof = [&](int node, int axis) { return problem_.dofs.index(node, axis); };
  place_.reserve(144 * tets_.size());
  for (const auto& t : problem_.mesh.tetrahedra)
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) {
        const int row = dof(t[i / 3], i % 3), column = dof(t[j / 3], j % 3);
        place_.push_back(row < 0 || column < 0 ? -1 : place_of(tangent_, row, column));
      }
  for (const int n : surface_)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int row = dof(n, i), column = dof(n, j);
        block_.push_back(row < 0 || column < 0 ? -1 : place_of(tangent_, row, column));
      }
}

void NewtonSolid::prescribe(int node, int axis, double value) {
  if (problem_.dofs.is_free(node, axis))
    throw std::runtime_error("a displacement is prescribed at an axis that is not fixed");
  u_[node][axis] = value;
}

Eigen::Matrix<double, 4, 3> NewtonSolid::corners(std::size_t t, const std::vector<Eigen::Vector3d>& u) const {
  Eigen::Matrix<double, 4, 3> rows;
  for (int c = 0; c < 4; ++c) rows.row(c) = u[problem_.mesh.tetrahedra[t][c]].transpose();
  return rows;
}

double NewtonSolid::contact_stiffness(int s, const Sphere& ball) const {
  const double k = stiffness_ > 0 ? stiffness_ : 1000 * problem_.materials.materials[0].young / ball.radius;
  return k * area_[s];
}

double NewtonSolid::energy(const std::vector<Eigen::Vector3d>& u, const std::optional<Sphere>& ball) const {
  double sum = 0;
  for (std::size_t t = 0; t < tets_.size() && std::isfinite(sum); ++t)
    sum += palpate::element_energy(law_, tets_[t], lame_[t], corners(t, u));
  for (std::size_t s = 0; ball && s < surface_.size(); ++s) {
    const int n = surface_[s];
    const double depth = ball->radius - (problem_.mesh.nodes[n] + u[n] - ball->centre).norm();
    if (depth > 0) sum += 0.5 * contact_stiffness(static_cast<int>(s), *ball) * depth * depth;
  }
  return sum;
}

/// Fills gradient and tangent; returns the sum of the sizes of the elements' own forces.
double NewtonSolid::assemble(const std::optional<Sphere>& ball) {
  gradient_.setZero();
  std::fill_n(tangent_.valuePtr(), tangent_.nonZeros(), 0.0);
  double size = 0;
  for (std::size_t e = 0; e < tets_.size(); ++e) {
    const ElementResponse r = element_response(law_, tets_[e], lame_[e], corners(e, u_));
    size += r.gradient.squaredNorm();
    const auto& t = problem_.mesh.tetrahedra[e];
    const std::int64_t* place = place_.data() + 144 * e;
    for (int i = 0; i < 12; ++i) {
      const int row = problem_.dofs.index(t[i / 3], i % 3);
      if (row >= 0) gradient_[row] += r.gradient[i];
      for (int j = 0; j < 12; ++j)
        if (place[12 * i + j] >= 0) tangent_.valuePtr()[place[12 * i + j]] += r.tangent(i, j);
    }
  }
  if (ball) add_contact(*ball);
  return std::sqrt(size);
}

void NewtonSolid::add_contact(const Sphere& ball) {
  for (std::size_t s = 0; s < surface_.size(); ++s) {
    const int n = surface_[s];
    const Eigen::Vector3d from = problem_.mesh.nodes[n] + u_[n] - ball.centre;
    const double distance = from.norm(), depth = ball.radius - distance,
                 k = contact_stiffness(static_cast<int>(s), ball);
    if (depth <= 0) continue;
    const Eigen::Vector3d normal = from / distance;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    const Eigen::Matrix3d block = k * (normal * normal.transpose() - depth / distance * across);
    for (int i = 0; i < 3; ++i) {
      const int row = problem_.dofs.index(n, i);
      if (row >= 0) gradient_[row] -= k * depth * normal[i];
      for (int j = 0; j < 3; ++j)
        if (block_[9 * s + 3 * i + j] >= 0) tangent_.valuePtr()[block_[9 * s + 3 * i + j]] += block(i, j);
    }
  }
}

/// Newton's direction; a tangent that is not positive definite gets a shift that makes it so.
Eigen::VectorXd NewtonSolid::direction(int& shifted) {
  const double mean = tangent_.diagonal().cwiseAbs().mean();
  double shift = 0;
  for (int trial = 0; trial < 20; ++trial) {
    try {
      factor_->factorise(tangent_);
      return -factor_->solve(gradient_);
    } catch (const std::runtime_error&) {
      const double next = shift == 0 ? 1e-4 * mean : 4 * shift;
      for (Eigen::Index i = 0; i < tangent_.rows(); ++i)
        tangent_.valuePtr()[tangent_.outerIndexPtr()[i]] += next - shift;  // the first of a column is its diagonal
      shift = next;
      ++shifted;
    }
  }
  throw std::runtime_error("Newton's tangent cannot be made positive definite");
}

NewtonOutcome NewtonSolid::solve(const std::optional<Sphere>& ball) {
  NewtonOutcome outcome;
  const auto before = u_;
  double now = energy(u_, ball);
  for (; outcome.iterations < kMaxIterations && std::isfinite(now); ++outcome.iterations, ++iterations_) {
    const double size = assemble(ball);
    outcome.residual = gradient_.norm() / std::max(size, 1e-300);
    if (outcome.residual < kTolerance || gradient_.norm() == 0) {
      outcome.converged = true;
      return outcome;
    }
    const Eigen::VectorXd step = direction(outcome.shifted);
    const double slope = gradient_.dot(step);
    const auto start = u_;
    double share = 1, next = 0;
    for (; share > kMinShare; share /= 2) {
      for (int i = 0; i < problem_.dofs.size(); ++i) {
        const int dof = problem_.dofs.dof(i);
        u_[dof / 3][dof % 3] = start[dof / 3][dof % 3] + share * step[i];
      }
      next = energy(u_, ball);
      if (next <= now + 1e-4 * share * slope + 1e-13 * std::abs(now)) break;
    }
    if (share <= kMinShare) break;
    now = next;
  }
  u_ = before;
  return outcome;
}

/// Goes on as in the last step of load, where that brings the body nearer to rest.
void NewtonSolid::predict(const Sphere& ball, double ratio) {
  if (before_.empty() || ratio > 3) return;
  auto guess = u_;
  for (std::size_t n = 0; n < u_.size(); ++n) guess[n] += ratio * (u_[n] - before_[n]);
  if (energy(guess, ball) < energy(u_, ball)) u_ = std::move(guess);
}

PressState NewtonSolid::press(const Sphere& from, const Sphere& to, const Stepping& stepping) {
  const double way = (to.centre - from.centre).norm();
  double done = 0, stride = std::min(1.0, stepping.stride * to.radius / std::max(way, 1e-300));
  for (int halvings = 0; done < 1;) {
    const double next = std::min(1.0, done + stride);
    const Sphere ball{from.centre + next * (to.centre - from.centre), to.radius};
    ++steps_;
    const auto reached = u_;
    predict(ball, (next - done) * way / std::max(last_way_, 1e-300));
    if (solve(ball).converged) {
      before_ = reached;
      last_way_ = (next - done) * way;
      done = next;
      halvings = 0;
      continue;
    }
    u_ = reached;
    stride /= 2;
    if (++halvings > stepping.max_halvings)
      throw std::runtime_error("Newton's method does not converge under the ball");
  }
  return state(to);
}

PressState NewtonSolid::state(const std::optional<Sphere>& ball) const {
  PressState state{u_, Eigen::Vector3d::Zero(), 0};
  for (std::size_t s = 0; ball && s < surface_.size(); ++s) {
    const int n = surface_[s];
    const Eigen::Vector3d from = problem_.mesh.nodes[n] + u_[n] - ball->centre;
    const double depth = ball->radius - from.norm();
    if (depth <= 0) continue;
    state.force += contact_stiffness(static_cast<int>(s), *ball) * depth * from.normalized();
    state.penetration = std::max(state.penetration, depth);
  }
  return state;
}

std::vector<Eigen::Vector3d> NewtonSolid::internal_force() const {
  std::vector<Eigen::Vector3d> force(u_.size(), Eigen::Vector3d::Zero());
  for (std::size_t e = 0; e < tets_.size(); ++e) {
    const ElementResponse r = element_response(law_, tets_[e], lame_[e], corners(e, u_));
    for (int c = 0; c < 4; ++c) force[problem_.mesh.tetrahedra[e][c]] += r.gradient.segment<3>(3 * c);
  }
  return force;
}

}  // namespace palpate
