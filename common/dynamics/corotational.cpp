#include "common/dynamics/corotational.hpp"

#include "common/dynamics/stability.hpp"
#include "common/fem/elasticity.hpp"
#include "common/geometry/nearest_rotation.hpp"

namespace palpate {

template <class Scalar>
Corotational<Scalar>::Corotational(const ElasticMesh& mesh, Integrator integrator, double damping)
    : Staged<Scalar>(mesh, integrator, damping), quads_((this->size() + 3) / 4) {
  std::vector<double> bounds;
  for (int t = 0; t < this->size(); ++t) {
    const auto& corners = mesh.tetrahedra[t];
    const auto tet =
        tet_gradients({mesh.rest[corners[0]], mesh.rest[corners[1]], mesh.rest[corners[2]], mesh.rest[corners[3]]});
    const Material& material = mesh.material(t);
    const Lame constants = lame(material);
    auto& quad = quads_[t / 4];
    const int lane = t % 4;
    for (int j = 1; j < 4; ++j)
      for (int axis = 0; axis < 3; ++axis)
        quad.gradient[j - 1][axis][lane] = static_cast<Scalar>(tet.gradient(j, axis));
    quad.shear[lane] = static_cast<Scalar>(2 * constants.mu * tet.volume);
    quad.volume[lane] = static_cast<Scalar>(constants.lambda * tet.volume);
    for (int j = 0; j < 4; ++j) quad.entry[j][lane] = 4 * corners[j];
    // Without the symmetry of the strain a shear weighs up to 2 mu, which exceeds the linear bound if lambda
    // < 0 alone.
    bounds.push_back((constants.lambda < 0 ? 2 : 1) * element_frequency_squared(tet, constants, material.density));
  }
  this->set_element_bounds(std::move(bounds));
}

template <class Scalar>
void Corotational<Scalar>::take_out(int tetrahedron) {
  auto& quad = quads_[tetrahedron / 4];
  const int lane = tetrahedron % 4;
  quad.shear[lane] = quad.volume[lane] = 0;
  // Equal corners: no motion of the nodes that stay gives this lane a strain.
  for (auto& corner : quad.entry) corner[lane] = quad.entry[0][lane];
}

template <class Scalar>
void Corotational<Scalar>::add_forces(const Scalar* u, Scalar* force) const {
  const auto& kernels = this->kernels_;
  const int count = static_cast<int>(quads_.size());
  if constexpr (std::is_same_v<Scalar, float>)
    kernels.corotated_f(quads_.data(), count, u, force);
  else
    kernels.corotated_d(quads_.data(), count, u, force);
}

template <class Scalar>
double Corotational<Scalar>::elastic_energy() const {
  double sum = 0;
  for (int t = 0; t < this->size(); ++t) {
    if (!this->alive(t)) continue;
    const auto& quad = quads_[t / 4];
    const int lane = t % 4;
    const auto& corners = this->tetrahedron(t);
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    for (int j = 1; j < 4; ++j) {
      const Eigen::Vector3d change = this->displacement(corners[j]) - this->displacement(corners[0]);
      const auto& g = quad.gradient[j - 1];
      f += change * Eigen::RowVector3d(g[0][lane], g[1][lane], g[2][lane]);
    }
    const Eigen::Matrix3d r = nearest_rotation(f).rotation;
    const double dilation = (r.transpose() * f).trace() - 3;
    sum += 0.5 * quad.shear[lane] * (f - r).squaredNorm() + 0.5 * quad.volume[lane] * dilation * dilation;
  }
  return sum;
}

template class Corotational<float>;
template class Corotational<double>;

}  // namespace palpate
