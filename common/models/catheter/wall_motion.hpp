#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/contact/wall.hpp"

namespace palpate {

/// How the nodes of a duct's wall move within a tick, for given motions of its modes; worked out where asked for.
class WallMotion {
 public:
  explicit WallMotion(const DuctWall* wall);

  /// Takes up the modes' motions [kg^1/2 m] up to the beginning and up to the end of a substep.
  void set(std::span<const double> before, std::span<const double> now);
  /// The triangle at the beginning and at the end of the substep, from where the surface stands.
  Triangle before(int triangle);
  Triangle now(int triangle);
  /// [m] the farthest that one of some 64 nodes spread over the wall goes in the coming tick if no catheter
  /// touches it.
  double expected();

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  struct Node {
    int stamp = 0;
    Eigen::Vector3d before = Eigen::Vector3d::Zero(), now = Eigen::Vector3d::Zero();  ///< [m] from the surface's
  };
  const Node& at(int node);
  void read_rows(int node, double* rows) const;

  const DuctWall* wall_;
  Rows spread_;            ///< [kg^-1/2] of the spread nodes: 3 a node x modes
  Eigen::VectorXd moved_;  ///< [m] 3 a spread node
  Rows rows_;              ///< of the node in hand
  Eigen::VectorXd before_, now_;
  std::vector<Node> nodes_;
  int clock_ = 0;
};

}  // namespace palpate
