#pragma once
#include <Eigen/Core>
#include <vector>

namespace palpate {

/// One linear condition on displacements, sum of weight * u[node][axis] = value [m], held from both sides.
/// Its multiplier is a force; the tissue receives weight * multiplier at each term.
struct Constraint {
  struct Term {
    int node;  ///< mesh node number
    int axis;
    double weight;
  };
  std::vector<Term> terms;
  double value;
};

/// A dead load on the tissue at a mesh node.
struct NodalLoad {
  int node;
  Eigen::Vector3d force;  ///< [N]
};

/// One axis of one node held at a displacement [m].
inline Constraint hold(int node, int axis, double value) {
  return {{{node, axis, 1.0}}, value};
}

}  // namespace palpate
