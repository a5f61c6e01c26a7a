#include "common/dynamics/tensor_mass.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace palpate {
namespace {

using kernels::kBlockSize;
using kernels::kNodeWidth;

/// The kernel of the scalar type in use.
template <class Scalar, class F, class D>
auto of_type(F single, D twice) {
  if constexpr (std::is_same_v<Scalar, float>)
    return single;
  else
    return twice;
}

}  // namespace

template <class Scalar>
TensorMass<Scalar>::TensorMass(const ElasticMesh& mesh, Integrator integrator, double damping)
    : elements_(mesh),
      integrator_(integrator),
      damping_(damping),
      kernels_(kernels::active()),
      fixed_(mesh.fixed),
      load_(mesh.nodes(), Eigen::Vector3d::Zero()),
      own_mass_(mesh.nodes()),
      added_mass_(mesh.nodes(), 0),
      row_(number_for_locality(elements_.edges(), mesh.nodes())) {
  const std::size_t scalars = static_cast<std::size_t>(kNodeWidth) * mesh.nodes();
  for (auto* array : {&motion_, &rates_, &product_, &response_}) array->assign(scalars, 0);
  lay_out_edges();
  for (int e = 0; e < static_cast<int>(slot_.size()); ++e) write_edge(e);
  for (int n = 0; n < nodes(); ++n) {
    own_mass_[n] = elements_.mass(n);
    write_response(n);
  }
  blocks_ = {nodes(), begin_.data(), column_.data(), block_.data()};
  arrays_ = {motion_.data(), rates_.data(), product_.data(), response_.data()};
}

/// Rows by their number, within a row by column.
template <class Scalar>
void TensorMass<Scalar>::lay_out_edges() {
  const auto edges = elements_.edges();
  std::vector<std::array<int, 3>> places;  // row, column, edge
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    const auto [low, high] = std::minmax(row_[edges[e][0]], row_[edges[e][1]]);
    places.push_back({low, high, e});
  }
  std::sort(places.begin(), places.end());
  slot_.resize(edges.size());
  begin_.assign(nodes() + 1, 0);
  for (int at = 0; at < static_cast<int>(places.size()); ++at) {
    const auto& [row, column, edge] = places[at];
    ++begin_[row + 1];
    column_.push_back(column);
    slot_[edge] = at;
  }
  for (int i = 0; i < nodes(); ++i) begin_[i + 1] += begin_[i];
  block_.assign(kBlockSize * edges.size() + 3, 0);
}

template <class Scalar>
void TensorMass<Scalar>::write_edge(int edge) {
  const auto [a, b] = elements_.edges()[edge];
  Eigen::Matrix3d tensor = elements_.edge_tensor(edge);
  if (row_[a] > row_[b]) tensor.transposeInPlace();
  Eigen::Map<Eigen::Matrix<Scalar, 3, 3>> block(&block_[kBlockSize * slot_[edge]]);
  block = tensor.cast<Scalar>();
}

/// What the kernels know of a node: its inverse mass and the acceleration that its loads alone would give.
template <class Scalar>
void TensorMass<Scalar>::write_response(int node) {
  const double total = mass(node);
  const Eigen::Vector3d force = load_[node] + own_mass_[node] * gravity_;
  Scalar* response = &response_[kNodeWidth * row_[node]];
  for (int axis = 0; axis < 3; ++axis) {
    const bool moves = total > 0 && !fixed_[node][axis];
    response[axis] = static_cast<Scalar>(moves ? 1 / total : 0);
    response[axis + 4] = static_cast<Scalar>(moves ? force[axis] / total : 0);
  }
}

template <class Scalar>
void TensorMass<Scalar>::set_gravity(const Eigen::Vector3d& gravity) {
  gravity_ = gravity;
  for (int n = 0; n < nodes(); ++n) write_response(n);
}

template <class Scalar>
double TensorMass<Scalar>::frequency_bound() const {
  return std::sqrt(std::max(elements_.frequency_squared(), coupling_bound_));
}

template <class Scalar>
void TensorMass<Scalar>::step(double dt, Integrator integrator) {
  const int vectors = integrator == Integrator::rk4 ? 2 : 1;
  couple_pass(motion_.data(), vectors);
  switch (integrator) {
    case Integrator::rk4:
      of_type<Scalar>(kernels_.rk4_first_f, kernels_.rk4_first_d)(blocks_, arrays_, damping_);
      couple_pass(rates_.data(), vectors);
      return of_type<Scalar>(kernels_.rk4_second_f, kernels_.rk4_second_d)(blocks_, arrays_, damping_, dt);
    case Integrator::semi_implicit:
      return of_type<Scalar>(kernels_.semi_implicit_f, kernels_.semi_implicit_d)(blocks_, arrays_, damping_, dt);
    case Integrator::forward_euler:
      return of_type<Scalar>(kernels_.forward_euler_f, kernels_.forward_euler_d)(blocks_, arrays_, damping_, dt);
  }
}

/// The forces of the coupling for the vectors that the next pass multiplies: two with RK4, u alone with
/// Euler.
template <class Scalar>
void TensorMass<Scalar>::couple_pass(const Scalar* pair, int vectors) {
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
void TensorMass<Scalar>::remove(std::span<const int> tetrahedra) {
  for (int t : tetrahedra) elements_.remove(t);
  for (int t : tetrahedra) {
    for (int e : elements_.edges_of(t)) write_edge(e);
    for (int n : elements_.tetrahedron(t)) {
      own_mass_[n] = elements_.mass(n);
      if (mass(n) == 0) std::fill_n(&motion_[kNodeWidth * row_[n] + 4], 3, Scalar(0));
      write_response(n);
    }
  }
}

template <class Scalar>
void TensorMass<Scalar>::couple(Coupling* coupling, std::span<const int> nodes, std::span<const double> mass,
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
Eigen::Vector3d TensorMass<Scalar>::vector_at(int node, int first) const {
  return Eigen::Map<const Eigen::Matrix<Scalar, 3, 1>>(&motion_[kNodeWidth * row_[node] + first])
      .template cast<double>();
}

template <class Scalar>
void TensorMass<Scalar>::set_motion(int node, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  Scalar* motion = &motion_[kNodeWidth * row_[node]];
  for (int axis = 0; axis < 3; ++axis) {
    if (fixed_[node][axis]) continue;
    motion[axis] = static_cast<Scalar>(u[axis]);
    motion[axis + 4] = static_cast<Scalar>(v[axis]);
  }
}

template <class Scalar>
double TensorMass<Scalar>::mass(int node) const {
  return own_mass_[node] + added_mass_[node];
}

template <class Scalar>
void TensorMass<Scalar>::set_load(int node, const Eigen::Vector3d& force) {
  load_[node] = force;
  write_response(node);
}

template <class Scalar>
ElementTensors::Corners TensorMass<Scalar>::displacements(int t) const {
  ElementTensors::Corners u;
  for (int c = 0; c < 4; ++c) u.row(c) = displacement(elements_.tetrahedron(t)[c]);
  return u;
}

template <class Scalar>
Eigen::Vector3d TensorMass<Scalar>::elastic_force(int node) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (int t : elements_.around_node(node)) {
    if (!elements_.alive(t)) continue;
    const auto& corners = elements_.tetrahedron(t);
    const auto c = std::find(corners.begin(), corners.end(), node) - corners.begin();
    force += elements_.force(t, static_cast<int>(c), displacements(t));
  }
  return force;
}

template <class Scalar>
double TensorMass<Scalar>::energy() const {
  double sum = 0;
  for (int t = 0; t < elements_.size(); ++t)
    if (elements_.alive(t)) sum += elements_.energy(t, displacements(t));
  for (int n = 0; n < nodes(); ++n) sum += 0.5 * mass(n) * velocity(n).squaredNorm();
  return sum;
}

template <class Scalar>
Eigen::Matrix3d TensorMass<Scalar>::edge_tensor(int i, int j) const {
  const int edge = elements_.edge_between(i, j);
  if (edge < 0) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d tensor =
      Eigen::Map<const Eigen::Matrix<Scalar, 3, 3>>(&block_[kBlockSize * slot_[edge]]).template cast<double>();
  return row_[i] < row_[j] ? tensor : Eigen::Matrix3d(tensor.transpose());
}

template <class Scalar>
Eigen::Matrix3d TensorMass<Scalar>::vertex_tensor(int i) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  std::vector<int> others;
  for (int t : elements_.around_node(i))
    for (int n : elements_.tetrahedron(t)) others.push_back(n);
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (int j : others)
    if (j != i) sum -= edge_tensor(i, j);
  return sum;
}

template class TensorMass<float>;
template class TensorMass<double>;

}  // namespace palpate
