#include "common/models/moving/inertial_response.hpp"

namespace palpate {

void InertialResponse::follow(double dt) {
  squared_dt_ = dt * dt;
  double sum = 0;
  int count = 0;
  for (int node = 0; node < mesh_.nodes(); ++node) {
    const Eigen::Vector3d own = of_node(node);
    if (own.maxCoeff() <= 0) continue;
    sum += own.sum() / 3;
    ++count;
  }
  typical_ = count ? sum / count : 1.0;
}

Eigen::Vector3d InertialResponse::of_mass(int node, double mass) const {
  if (!(mass > 0)) return Eigen::Vector3d::Zero();
  const auto& fixed = mesh_.fixed[node];
  const double free = squared_dt_ / mass;
  return {fixed[0] ? 0 : free, fixed[1] ? 0 : free, fixed[2] ? 0 : free};
}

Eigen::Matrix3d InertialResponse::block(const Anchor& at, const Anchor& under) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int v = 0; v < 3; ++v)
    for (int w = 0; w < 3; ++w)
      if (at.weights[v] != 0 && under.weights[w] != 0 && at.nodes[v] == under.nodes[w])
        sum += at.weights[v] * under.weights[w] * of_node(at.nodes[v]);
  return sum.asDiagonal();
}

}  // namespace palpate
