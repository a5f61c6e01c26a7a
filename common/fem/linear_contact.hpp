#pragma once
#include <span>

#include "common/fem/direct.hpp"
#include "common/fem/offline_spec.hpp"
#include "common/fem/sphere.hpp"

namespace palpate {

/// Linear elasticity under a ball that is pressed into its surface, on a mesh of any fineness: what would be inside the
/// ball lies on it, is pushed along the ball's own normal and never pulled. One factorisation; the contact is solved on
/// the dense compliance among the surface nodes that the ball may reach.
///
/// With linear elements nodes touch, each by itself. With quadratic ones, of whose nodes the corners carry nothing of a
/// uniform pressure, the mesh's hats touch: pressures are sums of hats, none of them negative, and the mean distance
/// from the ball under each hat is none either (a mortar method).
class LinearContact {
 public:
  /// Nodes of the surface within `reach` [m] of one of `centres` may touch the ball.
  LinearContact(const StaticProblem& problem, std::span<const Eigen::Vector3d> centres, double reach,
                FiniteElement element = FiniteElement::p1);

  /// Displacements are of the mesh's nodes, and with quadratic elements then of the edges' midpoints. Throws
  /// std::runtime_error if the contact does not settle or the ball comes to nodes beyond the reach.
  PressState press(const Sphere& ball) const;
  const StaticProblem& problem() const { return problem_; }
  int candidates() const { return static_cast<int>(all_.point.size()); }

  /// The nodes of the elements, the mesh's first.
  struct Space {
    std::vector<Eigen::Vector3d> nodes;  ///< [m]
    DofMap dofs;
    SparseMatrix shares;  ///< nodes x nodes of the mesh: what each of these spreads its force over
    NodeGraph graph;
    SparseMatrix stiffness;
  };

 private:
  /// What may touch the ball.
  struct Candidates {
    std::vector<int> point;      ///< nodes of the mesh that may
    std::vector<int> node;       ///< nodes that they spread their forces over
    SparseMatrix share;          ///< node x point
    Eigen::MatrixXd compliance;  ///< [m/N] among the nodes, 3 entries each; fixed axes hold zeros
  };
  LinearContact(StaticProblem problem, Space space, std::span<const Eigen::Vector3d> centres, double reach);
  Candidates spread(std::vector<int> points) const;
  Candidates near(const Sphere& ball) const;
  double penetration(const Sphere& ball, const std::vector<Eigen::Vector3d>& displacement) const;

  StaticProblem problem_;
  std::vector<int> surface_;  // nodes of the mesh
  Space space_;
  Candidates all_;
  Factorisation factor_;
};

}  // namespace palpate
