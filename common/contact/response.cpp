#include "common/contact/response.hpp"

namespace palpate {
namespace {

double mean_diagonal(const Compliance<double>& c) {
  double sum = 0;
  long count = 0;
  for (int node = 0; node < c.column_nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      const double d = c.block(node, node)(axis, axis);
      sum += d;
      count += d > 0;
    }
  return count ? sum / count : 1.0;
}

}  // namespace

CompliantResponse::CompliantResponse(const Compliance<double>& compliance)
    : compliance_(compliance), typical_(mean_diagonal(compliance)) {}

Eigen::Matrix3d CompliantResponse::block(const Anchor& at, const Anchor& under) const {
  Eigen::Matrix3d b = Eigen::Matrix3d::Zero();
  for (int v = 0; v < 3; ++v) {
    if (under.weights[v] == 0 || under.nodes[v] >= compliance_.column_nodes()) continue;
    for (int w = 0; w < 3; ++w) {
      if (at.weights[w] == 0 || at.nodes[w] >= compliance_.row_nodes()) continue;
      const double weight = under.weights[v] * at.weights[w];
      b += weight * compliance_.block(at.nodes[w], under.nodes[v]);
    }
  }
  return b;
}

}  // namespace palpate
