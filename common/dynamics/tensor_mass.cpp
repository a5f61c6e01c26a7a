#include "common/dynamics/tensor_mass.hpp"

#include <algorithm>

namespace palpate {

using kernels::kBlockSize;

template <class Scalar>
TensorMass<Scalar>::TensorMass(const ElasticMesh& mesh, Integrator integrator, double damping)
    : LinearTissue<Scalar>(mesh, integrator, damping) {
  lay_out_edges();
  for (int e = 0; e < static_cast<int>(slot_.size()); ++e) write_edge(e);
  blocks_ = {this->nodes(), begin_.data(), column_.data(), block_.data()};
}

/// Rows by their number, within a row by column.
template <class Scalar>
void TensorMass<Scalar>::lay_out_edges() {
  const auto edges = elements().edges();
  std::vector<std::array<int, 3>> places;  // row, column, edge
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    const auto [low, high] = std::minmax({row(edges[e][0]), row(edges[e][1])});
    places.push_back({low, high, e});
  }
  std::sort(places.begin(), places.end());
  slot_.resize(edges.size());
  begin_.assign(this->nodes() + 1, 0);
  for (int at = 0; at < static_cast<int>(places.size()); ++at) {
    const auto& [low, column, edge] = places[at];
    ++begin_[low + 1];
    column_.push_back(column);
    slot_[edge] = at;
  }
  for (int i = 0; i < this->nodes(); ++i) begin_[i + 1] += begin_[i];
  block_.assign(kBlockSize * edges.size() + 3, 0);
}

template <class Scalar>
void TensorMass<Scalar>::write_edge(int edge) {
  const auto [a, b] = elements().edges()[edge];
  Eigen::Matrix3d tensor = elements().edge_tensor(edge);
  if (row(a) > row(b)) tensor.transposeInPlace();
  Eigen::Map<Eigen::Matrix<Scalar, 3, 3>> block(&block_[kBlockSize * slot_[edge]]);
  block = tensor.cast<Scalar>();
}

template <class Scalar>
void TensorMass<Scalar>::rk4_first(const Arrays& arrays, double damping) {
  this->of_type(this->kernels().rk4_first_f, this->kernels().rk4_first_d)(blocks_, arrays, damping);
}

template <class Scalar>
void TensorMass<Scalar>::rk4_second(const Arrays& arrays, double damping, double dt) {
  this->of_type(this->kernels().rk4_second_f, this->kernels().rk4_second_d)(blocks_, arrays, damping, dt);
}

template <class Scalar>
void TensorMass<Scalar>::semi_implicit(const Arrays& arrays, double damping, double dt) {
  this->of_type(this->kernels().semi_implicit_f, this->kernels().semi_implicit_d)(blocks_, arrays, damping, dt);
}

template <class Scalar>
void TensorMass<Scalar>::forward_euler(const Arrays& arrays, double damping, double dt) {
  this->of_type(this->kernels().forward_euler_f, this->kernels().forward_euler_d)(blocks_, arrays, damping, dt);
}

template <class Scalar>
void TensorMass<Scalar>::rewrite(int tetrahedron) {
  for (int e : elements().edges_of(tetrahedron)) write_edge(e);
}

template <class Scalar>
ElementTensors::Corners TensorMass<Scalar>::displacements(int t) const {
  ElementTensors::Corners u;
  for (int c = 0; c < 4; ++c) u.row(c) = displacement(elements().tetrahedron(t)[c]);
  return u;
}

template <class Scalar>
Eigen::Vector3d TensorMass<Scalar>::elastic_force(int node) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (int t : elements().around_node(node)) {
    if (!elements().alive(t)) continue;
    const auto& corners = elements().tetrahedron(t);
    const auto c = std::find(corners.begin(), corners.end(), node) - corners.begin();
    force += elements().force(t, static_cast<int>(c), displacements(t));
  }
  return force;
}

template <class Scalar>
double TensorMass<Scalar>::elastic_energy() const {
  double sum = 0;
  for (int t = 0; t < elements().size(); ++t)
    if (elements().alive(t)) sum += elements().energy(t, displacements(t));
  return sum;
}

template <class Scalar>
Eigen::Matrix3d TensorMass<Scalar>::edge_tensor(int i, int j) const {
  const int edge = elements().edge_between(i, j);
  if (edge < 0) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d tensor =
      Eigen::Map<const Eigen::Matrix<Scalar, 3, 3>>(&block_[kBlockSize * slot_[edge]]).template cast<double>();
  return row(i) < row(j) ? tensor : Eigen::Matrix3d(tensor.transpose());
}

template <class Scalar>
Eigen::Matrix3d TensorMass<Scalar>::vertex_tensor(int i) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  std::vector<int> others;
  for (int t : elements().around_node(i))
    for (int n : elements().tetrahedron(t)) others.push_back(n);
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (int j : others)
    if (j != i) sum -= edge_tensor(i, j);
  return sum;
}

template class TensorMass<float>;
template class TensorMass<double>;

}  // namespace palpate
