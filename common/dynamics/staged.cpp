#include "common/dynamics/staged.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/fem/elasticity.hpp"

namespace palpate {
namespace {

/// begin[n] .. begin[n+1] in `around`: the tetrahedra of node n, ascending.
void list_around(const ElasticMesh& mesh, std::vector<int>& begin, std::vector<int>& around) {
  begin.assign(mesh.nodes() + 1, 0);
  for (const auto& corners : mesh.tetrahedra)
    for (const int node : corners) ++begin[node + 1];
  for (int n = 0; n < mesh.nodes(); ++n) begin[n + 1] += begin[n];
  around.resize(4 * mesh.tetrahedra.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const int node : mesh.tetrahedra[t]) around[next[node]++] = static_cast<int>(t);
}

double volume(const ElasticMesh& mesh, int t) {
  const auto& [a, b, c, d] = mesh.tetrahedra[t];
  const Eigen::Vector3d& o = mesh.rest[a];
  const double six = (mesh.rest[b] - o).cross(mesh.rest[c] - o).dot(mesh.rest[d] - o);
  if (!(six > 0)) throw std::runtime_error(fmt::format("tetrahedron {} has no positive volume", t));
  return six / 6;
}

}  // namespace

template <class Scalar>
Staged<Scalar>::Staged(const ElasticMesh& mesh, Integrator integrator, double damping)
    : integrator_(integrator),
      damping_(static_cast<Scalar>(damping)),
      tetrahedra_(mesh.tetrahedra),
      fixed_(mesh.fixed),
      alive_(mesh.tetrahedra.size(), 1),
      mass_(mesh.rest.size(), 0),
      coupled_mass_(mesh.rest.size(), 0),
      load_(mesh.rest.size(), Eigen::Vector3d::Zero()),
      dead_(mesh.dead_loads()),
      state_(8 * mesh.rest.size(), 0) {
  const std::size_t entries = 4 * mesh.rest.size();
  for (Array* array : {&constant_, &inverse_mass_, &force_, &stage_u_, &stage_v_, &sum_u_, &sum_v_, &present_})
    array->assign(entries, 0);
  fixed_.resize(mesh.rest.size(), {false, false, false});
  list_around(mesh, around_begin_, around_);
  for (int t = 0; t < size(); ++t) share_.push_back(mesh.material(t).density * volume(mesh, t) / 4);
  for (int n = 0; n < nodes(); ++n) sum_mass(n);
}

template <class Scalar>
void Staged<Scalar>::sum_mass(int node) {
  double sum = 0;
  for (int k = around_begin_[node]; k < around_begin_[node + 1]; ++k)
    if (alive_[around_[k]]) sum += share_[around_[k]];
  mass_[node] = sum;
  set_inverse_mass(node);
  sum_load(node);
}

template <class Scalar>
void Staged<Scalar>::set_inverse_mass(int node) {
  const double mass = mass_[node] + coupled_mass_[node];
  const bool moves = mass > 0;
  const double inverse = moves ? 1 / mass : 0;
  for (int axis = 0; axis < 3; ++axis)
    inverse_mass_[4 * node + axis] = static_cast<Scalar>(fixed_[node][axis] ? 0 : inverse);
  if (!moves) std::fill_n(v() + 4 * node, 4, Scalar(0));
}

template <class Scalar>
void Staged<Scalar>::remove(std::span<const int> tetrahedra) {
  for (const int t : tetrahedra) {
    if (!alive_[t]) continue;
    alive_[t] = 0;
    for (const int node : tetrahedra_[t]) sum_mass(node);
    take_out(t);
  }
  is_present_ = false;
}

template <class Scalar>
void Staged<Scalar>::couple(Coupling* coupling, std::span<const int> nodes, std::span<const double> mass,
                            double bound) {
  std::fill(coupled_mass_.begin(), coupled_mass_.end(), 0);
  const std::size_t count = coupling ? nodes.size() : 0;
  coupled_nodes_.assign(nodes.begin(), nodes.begin() + count);
  for (std::size_t c = 0; c < count; ++c) coupled_mass_[nodes[c]] += mass[c];
  coupling_ = coupling;
  coupling_bound_ = coupling ? bound : 0;
  coupled_u_.assign(3 * count, 0);
  coupled_force_.assign(3 * count, 0);
  for (int n = 0; n < this->nodes(); ++n) set_inverse_mass(n);
}

/// Rayleigh's quotient of the whole is a mean of those of the tetrahedra and of the coupling, weighted by
/// their masses.
template <class Scalar>
double Staged<Scalar>::frequency_bound() const {
  double largest = coupling_bound_;
  for (int t = 0; t < size(); ++t)
    if (alive_[t]) largest = std::max(largest, element_bound_[t]);
  return std::sqrt(largest);
}

template <class Scalar>
void Staged<Scalar>::set_motion(int node, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  for (int axis = 0; axis < 3; ++axis) {
    const int i = 4 * node + axis;
    this->u()[i] = static_cast<Scalar>(fixed_[node][axis] ? 0 : u[axis]);
    this->v()[i] = static_cast<Scalar>(fixed_[node][axis] || mass_[node] + coupled_mass_[node] == 0 ? 0 : v[axis]);
  }
  is_present_ = false;
}

template <class Scalar>
void Staged<Scalar>::set_load(int node, const Eigen::Vector3d& force) {
  load_[node] = force;
  sum_load(node);
}

template <class Scalar>
void Staged<Scalar>::sum_load(int node) {
  const Eigen::Vector3d sum = load_[node] + mass_[node] * gravity_ + dead_[node];
  for (int axis = 0; axis < 3; ++axis) constant_[4 * node + axis] = static_cast<Scalar>(sum[axis]);
}

template <class Scalar>
void Staged<Scalar>::set_gravity(const Eigen::Vector3d& gravity) {
  gravity_ = gravity;
  for (int n = 0; n < nodes(); ++n) sum_load(n);
}

template <class Scalar>
Eigen::Vector3d Staged<Scalar>::elastic_force(int node) const {
  if (!is_present_) {
    std::fill(present_.begin(), present_.end(), Scalar(0));
    add_forces(u(), present_.data());
    is_present_ = true;
  }
  return entry(present_.data(), node);
}

template <class Scalar>
double Staged<Scalar>::energy() const {
  double kinetic = 0;
  for (int n = 0; n < nodes(); ++n) kinetic += 0.5 * mass(n) * velocity(n).squaredNorm();
  return kinetic + elastic_energy();
}

template <class Scalar>
void Staged<Scalar>::state(State& s) {
  s.all(state_);
  if (s.restoring()) is_present_ = false;
}

/// Every force on the nodes at displacements `u`, damping excluded.
template <class Scalar>
void Staged<Scalar>::sum_forces(const Scalar* u) {
  std::copy(constant_.begin(), constant_.end(), force_.begin());
  add_forces(u, force_.data());
  if (coupling_) add_coupling(u);
}

template <class Scalar>
void Staged<Scalar>::add_coupling(const Scalar* u) {
  const std::size_t count = coupled_nodes_.size();
  for (std::size_t c = 0; c < count; ++c)
    for (int axis = 0; axis < 3; ++axis) coupled_u_[3 * c + axis] = u[4 * coupled_nodes_[c] + axis];
  std::fill(coupled_force_.begin(), coupled_force_.end(), 0);
  coupling_->apply(coupled_u_.data(), coupled_force_.data());
  for (std::size_t c = 0; c < count; ++c)
    for (int axis = 0; axis < 3; ++axis)
      force_[4 * coupled_nodes_[c] + axis] += static_cast<Scalar>(coupled_force_[3 * c + axis]);
}

template <class Scalar>
void Staged<Scalar>::step(double dt) {
  if (integrator_ == Integrator::rk4)
    runge_kutta(static_cast<Scalar>(dt));
  else
    euler(static_cast<Scalar>(dt), integrator_ == Integrator::forward_euler);
  end_step(dt);
}

template <class Scalar>
void Staged<Scalar>::step_semi_implicit(double dt) {
  euler(static_cast<Scalar>(dt), false);
  end_step(dt);
}

template <class Scalar>
void Staged<Scalar>::end_step(double dt) {
  remember(u(), static_cast<Scalar>(dt));
  is_present_ = false;
}

/// Classical RK4 of u' = v, v' = M^-1 F(u) - a v: stages at 0, dt/2, dt/2, dt with weights 1, 2, 2, 1.
template <class Scalar>
void Staged<Scalar>::runge_kutta(Scalar dt) {
  const int entries = static_cast<int>(constant_.size());
  Scalar* __restrict u = this->u();
  Scalar* __restrict v = this->v();
  Scalar* __restrict su = stage_u_.data();
  Scalar* __restrict sv = stage_v_.data();
  Scalar* __restrict du = sum_u_.data();
  Scalar* __restrict dv = sum_v_.data();
  const Scalar* __restrict force = force_.data();
  const Scalar* __restrict inverse = inverse_mass_.data();
  const Scalar damping = damping_, half = dt / 2, sixth = dt / 6;

  sum_forces(u);
  for (int i = 0; i < entries; ++i) {
    const Scalar a = force[i] * inverse[i] - damping * v[i];
    du[i] = v[i], dv[i] = a;
    su[i] = u[i] + half * v[i], sv[i] = v[i] + half * a;
  }
  for (const Scalar reach : {half, dt}) {
    sum_forces(su);
    for (int i = 0; i < entries; ++i) {
      const Scalar a = force[i] * inverse[i] - damping * sv[i];
      du[i] += 2 * sv[i], dv[i] += 2 * a;
      su[i] = u[i] + reach * sv[i], sv[i] = v[i] + reach * a;
    }
  }
  sum_forces(su);
  for (int i = 0; i < entries; ++i) {
    const Scalar a = force[i] * inverse[i] - damping * sv[i];
    u[i] += sixth * (du[i] + sv[i]);
    v[i] += sixth * (dv[i] + a);
  }
}

/// The new velocity moves the node (semi-implicit), or the old one does (forward).
template <class Scalar>
void Staged<Scalar>::euler(Scalar dt, bool forward) {
  const int entries = static_cast<int>(constant_.size());
  Scalar* __restrict u = this->u();
  Scalar* __restrict v = this->v();
  const Scalar* __restrict force = force_.data();
  const Scalar* __restrict inverse = inverse_mass_.data();
  const Scalar damping = damping_;

  sum_forces(u);
  for (int i = 0; i < entries; ++i) {
    const Scalar old = v[i];
    v[i] += dt * (force[i] * inverse[i] - damping * old);
    u[i] += dt * (forward ? old : v[i]);
  }
}

template class Staged<float>;
template class Staged<double>;

}  // namespace palpate
