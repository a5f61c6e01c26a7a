#pragma once
#include <Eigen/Core>
#include <array>

#include "common/describe/state.hpp"

namespace palpate {

/// A material point of a body's surface: three surface nodes and barycentric coordinates (TVCG99 sec. 5).
/// A vertex is (weights 1, 0, 0).
struct Anchor {
  std::array<int, 3> nodes{};
  Eigen::Vector3d weights = Eigen::Vector3d::UnitX();
};

/// What is remembered of one.
inline void state(State& s, Anchor& anchor) {
  s.value(anchor.nodes);
  s.value(anchor.weights);
}

/// Position of the anchor for given node positions [m].
template <class Positions>
Eigen::Vector3d anchor_position(const Anchor& anchor, const Positions& positions) {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  for (int v = 0; v < 3; ++v)
    if (anchor.weights[v] != 0) p += anchor.weights[v] * positions[anchor.nodes[v]];
  return p;
}

/// The weights of TVCG99's alpha rule with the sign mended: alpha_v = k_v + 1 - |k|^2, so that sum k_v alpha_v = 1
/// and the touched point moves exactly with the tool.
inline Eigen::Vector3d alpha_weights(const Eigen::Vector3d& k) {
  return (k.array() + 1.0 - k.squaredNorm()).matrix();
}

}  // namespace palpate
