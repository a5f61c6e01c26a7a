#include "common/dynamics/spring_mass.hpp"

#include <algorithm>

#include "common/fem/elasticity.hpp"
#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

std::array<int, 2> edge(const std::array<int, 4>& corners, int e) {
  const int a = corners[kEdges[e][0]], b = corners[kEdges[e][1]];
  return {std::min(a, b), std::max(a, b)};
}

/// The order of springs: neighbours differ in both ends, so that forces do not wait for one another, and lie
/// near one another in memory. It depends on the ends alone, and so stays when others vanish.
bool before(const std::array<int, 2>& a, const std::array<int, 2>& b) {
  constexpr int block = 32;
  const auto key = [](const auto& e) { return std::array<int, 3>{e[0] / block, e[1] - e[0], e[0]}; };
  return key(a) < key(b);
}

/// Distinct edges in that order.
std::vector<std::array<int, 2>> list_edges(const ElasticMesh& mesh) {
  std::vector<std::array<int, 2>> edges;
  edges.reserve(6 * mesh.tetrahedra.size());
  for (const auto& corners : mesh.tetrahedra)
    for (int e = 0; e < 6; ++e) edges.push_back(edge(corners, e));
  std::sort(edges.begin(), edges.end(), before);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Largest eigenvalue of the tetrahedron's springs, each as stiff across as along, over its corner mass.
double bound_of(const std::array<double, 6>& stiffness, double corner_mass) {
  Eigen::Matrix4d laplacian = Eigen::Matrix4d::Zero();
  for (int e = 0; e < 6; ++e) {
    const auto [a, b] = kEdges[e];
    laplacian(a, a) += stiffness[e], laplacian(b, b) += stiffness[e];
    laplacian(a, b) -= stiffness[e], laplacian(b, a) -= stiffness[e];
  }
  return symmetric_eigenvalues(laplacian)[3] / corner_mass * (1 + 1e-12);
}

}  // namespace

template <class Scalar>
SpringMass<Scalar>::SpringMass(const ElasticMesh& mesh, Integrator integrator, double damping)
    : Staged<Scalar>(mesh, integrator, damping), ends_(list_edges(mesh)) {
  for (const auto& [a, b] : ends_) rest_.push_back(mesh.rest[b] - mesh.rest[a]);
  const int springs = this->springs();
  stiffness_.assign(springs, 0);
  list_tetrahedra();
  set_bounds(mesh);

  quads_.resize((springs + 3) / 4);
  for (int s = 0; s < 4 * static_cast<int>(quads_.size()); ++s) {
    auto& quad = quads_[s / 4];
    const int lane = s % 4;
    const bool used = s < springs;
    for (int axis = 0; axis < 3; ++axis) quad.rest[axis][lane] = static_cast<Scalar>(used ? rest_[s][axis] : axis == 0);
    quad.length[lane] = static_cast<Scalar>(used ? rest_[s].norm() : 1);
    for (int end = 0; end < 2; ++end) quad.entry[end][lane] = used ? 4 * ends_[s][end] : 0;
    quad.stiffness[lane] = 0;
  }
  for (int s = 0; s < springs; ++s) sum_stiffness(s);
}

template <class Scalar>
void SpringMass<Scalar>::list_tetrahedra() {
  around_begin_.assign(ends_.size() + 1, 0);
  for (int t = 0; t < this->size(); ++t) {
    auto& springs = springs_of_.emplace_back();
    for (int e = 0; e < 6; ++e) {
      const auto place = std::lower_bound(ends_.begin(), ends_.end(), edge(this->tetrahedron(t), e), before);
      springs[e] = static_cast<int>(place - ends_.begin());
      ++around_begin_[springs[e] + 1];
    }
  }
  for (std::size_t s = 0; s < ends_.size(); ++s) around_begin_[s + 1] += around_begin_[s];
  around_.resize(6 * springs_of_.size());
  std::vector<int> next(around_begin_.begin(), around_begin_.end() - 1);
  for (int t = 0; t < this->size(); ++t)
    for (const int s : springs_of_[t]) around_[next[s]++] = t;
}

template <class Scalar>
void SpringMass<Scalar>::set_bounds(const ElasticMesh& mesh) {
  std::vector<double> bounds;
  for (int t = 0; t < this->size(); ++t) {
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    const double volume = tet_gradients({mesh.rest[a], mesh.rest[b], mesh.rest[c], mesh.rest[d]}).volume;
    const Material& material = mesh.material(t);
    young_volume_.push_back(material.young * volume);
    std::array<double, 6> stiffness;
    for (int e = 0; e < 6; ++e) stiffness[e] = young_volume_[t] / rest_[springs_of_[t][e]].squaredNorm();
    bounds.push_back(bound_of(stiffness, material.density * volume / 4));
  }
  this->set_element_bounds(std::move(bounds));
}

template <class Scalar>
void SpringMass<Scalar>::sum_stiffness(int spring) {
  double sum = 0;
  for (int k = around_begin_[spring]; k < around_begin_[spring + 1]; ++k)
    if (this->alive(around_[k])) sum += young_volume_[around_[k]];
  stiffness_[spring] = sum / rest_[spring].squaredNorm();
  quads_[spring / 4].stiffness[spring % 4] = static_cast<Scalar>(stiffness_[spring]);
}

template <class Scalar>
void SpringMass<Scalar>::take_out(int tetrahedron) {
  for (const int spring : springs_of_[tetrahedron]) sum_stiffness(spring);
}

template <class Scalar>
void SpringMass<Scalar>::add_forces(const Scalar* u, Scalar* force) const {
  const auto& kernels = this->kernels_;
  const int count = static_cast<int>(quads_.size());
  if constexpr (std::is_same_v<Scalar, float>)
    kernels.springs_f(quads_.data(), count, u, force);
  else
    kernels.springs_d(quads_.data(), count, u, force);
}

template <class Scalar>
double SpringMass<Scalar>::elastic_energy() const {
  double sum = 0;
  for (int s = 0; s < springs(); ++s) {
    const Eigen::Vector3d change = this->displacement(ends_[s][1]) - this->displacement(ends_[s][0]);
    const double rest = rest_[s].norm(), length = (rest_[s] + change).norm();
    const double elongation = (2 * rest_[s] + change).dot(change) / (length + rest);
    sum += 0.5 * stiffness_[s] * elongation * elongation;
  }
  return sum;
}

template class SpringMass<float>;
template class SpringMass<double>;

}  // namespace palpate
