#include "common/fem/fine_element.hpp"
#include "common/fem/fine_stiffness.hpp"

namespace palpate {

Pressures make_pressures(const FineSpace& space, const MaterialField& materials) {
  const auto elements = static_cast<Eigen::Index>(space.elements.size()), count = elements / space.per_pressure;
  Pressures pressures;
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(3 * space.per_element * elements);
  for (int e = 0; e < elements; ++e) {
    const int a = e / space.per_pressure;
    const auto points = quadrature(space, e);
    volume[a] += points.count * points.weight;
    for (int q = 0; q < points.count; ++q)
      for (int j = 0; j < space.per_element; ++j)
        for (int axis = 0; axis < 3; ++axis)
          entries.emplace_back(3 * space.elements[e][j] + axis, a, points.weight * points.gradient[q](j, axis));
  }
  pressures.divergence.resize(3 * static_cast<Eigen::Index>(space.nodes.size()), count);
  pressures.divergence.setFromTriplets(entries.begin(), entries.end());
  pressures.modulus.resize(count);
  for (Eigen::Index a = 0; a < count; ++a) {
    const int tetrahedron = static_cast<int>(a) * space.per_pressure / space.children;
    pressures.modulus[a] = lame(materials.at(tetrahedron)).lambda / volume[a];
  }
  return pressures;
}

Eigen::VectorXd Pressures::operator()(const std::vector<Eigen::Vector3d>& displacement) const {
  const Eigen::Map<const Eigen::VectorXd> u(displacement[0].data(), divergence.rows());
  return modulus.cwiseProduct(divergence.transpose() * u);
}

Eigen::Matrix3d fine_stress(const FineSpace& space, const MaterialField& materials, const Eigen::VectorXd* pressure,
                            const std::vector<Eigen::Vector3d>& displacement, int element, const Eigen::Vector4d& at) {
  const auto gradient = shape_gradients(corner_gradients(space, element), space.per_element, at);
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
  for (int j = 0; j < space.per_element; ++j) slope += displacement[space.elements[element][j]] * gradient.row(j);
  const auto constants = lame(materials.at(element / space.children));
  const double mean = pressure ? (*pressure)[element / space.per_pressure] : constants.lambda * slope.trace();
  return mean * Eigen::Matrix3d::Identity() + constants.mu * (slope + slope.transpose());
}

}  // namespace palpate
