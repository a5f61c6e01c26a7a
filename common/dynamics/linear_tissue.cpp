#include "common/dynamics/linear_tissue.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {

using kernels::kNodeWidth;

template <class Scalar>
LinearTissue<Scalar>::LinearTissue(const ElasticMesh& mesh, Integrator integrator, double damping)
    : elements_(mesh),
      integrator_(integrator),
      damping_(damping),
      kernels_(kernels::active()),
      fixed_(mesh.fixed),
      load_(mesh.nodes(), Eigen::Vector3d::Zero()),
      dead_(mesh.dead_loads()),
      own_mass_(mesh.nodes()),
      added_mass_(mesh.nodes(), 0),
      row_(number_for_locality(elements_.edges(), mesh.nodes())) {
  const std::size_t scalars = static_cast<std::size_t>(kNodeWidth) * mesh.nodes();
  for (auto* array : {&motion_, &rates_, &product_, &response_}) array->assign(scalars, 0);
  for (int n = 0; n < nodes(); ++n) {
    own_mass_[n] = elements_.mass(n);
    write_response(n);
  }
  arrays_ = {motion_.data(), rates_.data(), product_.data(), response_.data()};
}

/// What the kernels know of a node: its inverse mass and the acceleration that its loads alone would give.
template <class Scalar>
void LinearTissue<Scalar>::write_response(int node) {
  const double total = mass(node);
  const Eigen::Vector3d force = load_[node] + own_mass_[node] * gravity_ + dead_[node];
  Scalar* response = &response_[kNodeWidth * row_[node]];
  for (int axis = 0; axis < 3; ++axis) {
    const bool moves = total > 0 && !fixed_[node][axis];
    response[axis] = static_cast<Scalar>(moves ? 1 / total : 0);
    response[axis + 4] = static_cast<Scalar>(moves ? force[axis] / total : 0);
  }
}

template <class Scalar>
void LinearTissue<Scalar>::set_gravity(const Eigen::Vector3d& gravity) {
  gravity_ = gravity;
  for (int n = 0; n < nodes(); ++n) write_response(n);
}

template <class Scalar>
double LinearTissue<Scalar>::frequency_bound() const {
  return std::sqrt(std::max(frequency_squared(), coupling_bound_));
}

template <class Scalar>
void LinearTissue<Scalar>::step(double dt, Integrator integrator) {
  const int vectors = integrator == Integrator::rk4 ? 2 : 1;
  couple_pass(motion_.data(), vectors);
  switch (integrator) {
    case Integrator::rk4:
      rk4_first(arrays_, damping_);
      couple_pass(rates_.data(), vectors);
      return rk4_second(arrays_, damping_, dt);
    case Integrator::semi_implicit:
      return semi_implicit(arrays_, damping_, dt);
    case Integrator::forward_euler:
      return forward_euler(arrays_, damping_, dt);
  }
}

/// The forces of the coupling for the vectors that the next pass multiplies: two with RK4, u alone with
/// Euler.
template <class Scalar>
void LinearTissue<Scalar>::couple_pass(const Scalar* pair, int vectors) {
  if (!coupling_) return;
  for (int first = 0; first < 4 * vectors; first += 4) {
    for (std::size_t c = 0; c < coupled_.size(); ++c)
      for (int axis = 0; axis < 3; ++axis)
        coupled_vector_[3 * c + axis] = pair[kNodeWidth * row_[coupled_[c]] + first + axis];
    std::fill(coupled_force_.begin(), coupled_force_.end(), 0.0);
    coupling_->apply(coupled_vector_.data(), coupled_force_.data());
    for (std::size_t c = 0; c < coupled_.size(); ++c)
      for (int axis = 0; axis < 3; ++axis)
        product_[kNodeWidth * row_[coupled_[c]] + first + axis] -= static_cast<Scalar>(coupled_force_[3 * c + axis]);
  }
}

template <class Scalar>
void LinearTissue<Scalar>::remove(std::span<const int> tetrahedra) {
  for (int t : tetrahedra) elements_.remove(t);
  for (int t : tetrahedra) {
    rewrite(t);
    for (int n : elements_.tetrahedron(t)) {
      own_mass_[n] = elements_.mass(n);
      if (mass(n) == 0) std::fill_n(&motion_[kNodeWidth * row_[n] + 4], 3, Scalar(0));
      write_response(n);
    }
  }
}

template <class Scalar>
void LinearTissue<Scalar>::couple(Coupling* coupling, std::span<const int> nodes, std::span<const double> mass,
                                  double bound) {
  for (int n : coupled_) added_mass_[n] = 0;
  for (int n : coupled_) write_response(n);
  coupling_ = coupling;
  coupling_bound_ = coupling ? bound : 0;
  coupled_.assign(nodes.begin(), nodes.end());
  coupled_vector_.assign(3 * nodes.size(), 0);
  coupled_force_.assign(3 * nodes.size(), 0);
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    added_mass_[nodes[c]] = mass[c];
    write_response(nodes[c]);
  }
}

template <class Scalar>
Eigen::Vector3d LinearTissue<Scalar>::vector_at(int node, int first) const {
  return Eigen::Map<const Eigen::Matrix<Scalar, 3, 1>>(&motion_[kNodeWidth * row_[node] + first])
      .template cast<double>();
}

template <class Scalar>
void LinearTissue<Scalar>::set_motion(int node, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  Scalar* motion = &motion_[kNodeWidth * row_[node]];
  for (int axis = 0; axis < 3; ++axis) {
    if (fixed_[node][axis]) continue;
    motion[axis] = static_cast<Scalar>(u[axis]);
    motion[axis + 4] = static_cast<Scalar>(v[axis]);
  }
}

template <class Scalar>
void LinearTissue<Scalar>::set_load(int node, const Eigen::Vector3d& force) {
  load_[node] = force;
  write_response(node);
}

template <class Scalar>
double LinearTissue<Scalar>::energy() const {
  double sum = elastic_energy();
  for (int n = 0; n < nodes(); ++n) sum += 0.5 * mass(n) * velocity(n).squaredNorm();
  return sum;
}

template class LinearTissue<float>;
template class LinearTissue<double>;

}  // namespace palpate
