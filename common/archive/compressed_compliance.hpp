#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace palpate {

/// A block of a compliance: how a cluster of nodes moves under forces on another. Nodes go by their places in an order
/// in which clusters are ranges.
struct ComplianceBlock {
  static constexpr int kDense = -1;

  int row = 0, row_end = 0;        ///< places of what moves
  int column = 0, column_end = 0;  ///< places of what is loaded
  int rank = kDense;               ///< of U V^T; kDense: all entries are there

  int rows() const { return row_end - row; }
  int columns() const { return column_end - column; }
  bool dense() const { return rank == kDense; }
  /// How many numbers it has. Dense: 3 x 3 matrices column by column, nodes of a column one after another. Else the
  /// rows of U, then those of V, three a node.
  std::size_t numbers() const;
  bool operator==(const ComplianceBlock&) const = default;
};

/// What is stored of a compressed compliance [m/N].
struct CompressedTensors {
  std::vector<int> order;  ///< surface node at each place: those with a free axis, the touchable ones first
  int touchable = 0;       ///< how many of them are touchable
  /// Rows at or behind their columns, which are touchable: C is symmetric. They tile all of that, but rows that are not
  /// touchable may be left out.
  std::vector<ComplianceBlock> blocks;
  std::vector<float> values;  ///< numbers of one block after another
  bool operator==(const CompressedTensors&) const = default;
};

/// C among the touchable nodes, and of the others of the surface against them, by blocks of clusters of nodes: near
/// ones dense, far ones of low rank. Rows and columns of fixed axes are zero. Copies share their tensors.
class CompressedCompliance {
 public:
  /// `nodes`: how many the surface has. Throws std::invalid_argument("sentence") on tensors that do not fit together or
  /// that no positive definite matrix has.
  CompressedCompliance(CompressedTensors tensors, int nodes, double scale = 1);

  /// The same times a factor.
  CompressedCompliance scaled(double factor) const;
  double scale() const { return scale_; }
  const CompressedTensors& tensors() const { return layout_->tensors; }
  std::size_t bytes() const;
  /// Whether it has the rows of nodes that are not touchable.
  bool has_others() const { return layout_->others; }

  /// [m/N] of node i under forces on node j; zero where nothing is known.
  Eigen::Matrix3d block(int i, int j) const;

  /// A block as seen from its leaf clusters, the smallest ones: mirrored, its columns move and its rows are loaded.
  struct Tile {
    const ComplianceBlock* block;
    const float* values;
    bool mirrored;

    // Of a dense one: between two places, and what a force does.
    Eigen::Matrix3f entry(int moved, int loaded) const {
      return mirrored ? Eigen::Matrix3f(pair(loaded, moved).transpose()) : Eigen::Matrix3f(pair(moved, loaded));
    }
    Eigen::Vector3f under(int moved, int loaded, const Eigen::Vector3f& force) const {
      return mirrored ? Eigen::Vector3f(pair(loaded, moved).transpose() * force)
                      : Eigen::Vector3f(pair(moved, loaded) * force);
    }
    /// Of one of low rank: rank x 3, of the node at a place that moves or is loaded.
    Eigen::Map<const Eigen::MatrixXf> moved_factor(int place) const { return factor(place, !mirrored); }
    Eigen::Map<const Eigen::MatrixXf> loaded_factor(int place) const { return factor(place, mirrored); }

   private:
    Eigen::Map<const Eigen::Matrix3f> pair(int row, int column) const {
      const auto at = static_cast<std::size_t>(column - block->column) * block->rows() + (row - block->row);
      return Eigen::Map<const Eigen::Matrix3f>(values + 9 * at);
    }
    Eigen::Map<const Eigen::MatrixXf> factor(int place, bool of_rows) const;
  };
  int leaves() const { return static_cast<int>(layout_->leaf_begin.size()) - 1; }
  int max_rank() const { return layout_->max_rank; }
  int place(int node) const { return layout_->place[node]; }  ///< -1: it cannot move
  int leaf(int place) const { return layout_->leaf[place]; }
  /// Nothing where both leaves are of nodes that are not touchable, or such rows were left out.
  Tile tile(int moved_leaf, int loaded_leaf) const;

 private:
  struct Layout {
    CompressedTensors tensors;
    std::vector<std::size_t> at;  ///< of the first number of each block
    std::vector<int> place;       ///< per surface node
    std::vector<int> leaf_begin;  ///< places, and the end
    std::vector<int> leaf;        ///< per place
    std::vector<int> tile;        ///< block of (row leaf, column leaf); -1: none
    int max_rank = 0;
    bool others = false;
  };
  static void set_places(Layout& layout, int nodes);
  static void set_leaves(Layout& layout);
  static void set_tiles(Layout& layout);
  void check_values() const;

  std::shared_ptr<const Layout> layout_;
  double scale_;
};

}  // namespace palpate
