#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/archive/compliance.hpp"

namespace palpate {

/// u = C f: what forces on nodes do to the surface. After construction only add() allocates, and only beyond the number
/// of loads that was foreseen.
template <class Scalar>
class LoadSum {
 public:
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

  /// `compliance` outlives this object.
  explicit LoadSum(const Compliance<Scalar>& compliance, std::size_t foreseen = 0);

  void clear();
  /// A force [N] at a node; one where nothing can move has no effect.
  void add(int node, const Vector3& force);
  bool empty() const { return columns_.empty() && loads_.empty(); }

  /// Fills the displacement [m] of some row nodes, three entries a node.
  void at(std::span<const int> nodes, std::span<Scalar> displacement);
  /// Fills that of every row node.
  void everywhere(std::span<Scalar> displacement);

 private:
  struct Load {
    int place;
    Vector3 force;
  };
  /// Numbers 0, 1, ... sorted into leaf clusters: lists that are linked.
  struct ByLeaf {
    std::vector<int> first, next, used;
    void clear();
    void put(int leaf, int number);
  };

  void dense_at(std::span<const int> nodes, std::span<Scalar> displacement);
  void compressed_at(std::span<const int> nodes, std::span<Scalar> displacement);
  void add_tile(int moved_leaf, int loaded_leaf, std::span<Scalar> displacement);

  const Compliance<Scalar>& compliance_;
  std::vector<const Scalar*> columns_;  // of a dense one
  std::vector<Scalar> coefficients_, whole_;
  std::vector<Load> loads_;  // of a compressed one
  ByLeaf loaded_, moved_;
  std::vector<int> places_;     // of the nodes that are asked for
  std::vector<int> all_;        // row nodes
  std::vector<Scalar> shares_;  // of a block's rank
};

extern template class LoadSum<double>;
extern template class LoadSum<float>;

}  // namespace palpate
