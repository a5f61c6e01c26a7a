#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace palpate {

/// [m/N] What forces on the nodes of a patch do to these nodes: a block of 3 x 3 for each pair, block (j, i) being the
/// transpose of (i, j). Numbers of the same place in their block stand next to one another for all nodes, so that the
/// loops over nodes are plain ones.
class NodeBlocks {
 public:
  explicit NodeBlocks(int nodes) : nodes_(nodes), entries_(9 * static_cast<std::size_t>(nodes) * nodes, 0.0) {}

  /// Nodes 0 ... end - 1 do not move one another.
  void clear(int end) {
    for (int j = 0; j < end; ++j)
      for (int entry = 0; entry < 9; ++entry)
        std::fill_n(&entries_[(9 * static_cast<std::size_t>(j) + entry) * nodes_], end, 0.0);
  }
  /// Of the displacement of node i under a force on node j, and the other way round; of a node by itself the transpose
  /// of what is given.
  void set(int i, int j, const Eigen::Matrix3d& block) {
    put(i, j, block);
    put(j, i, block.transpose());
  }

  /// [m] What a force [N] on node j does along `normal` to nodes 0 ... end - 1.
  void along(const Eigen::Vector3d& normal, const Eigen::Vector3d& force, int j, int end, double* out) const {
    const double *xx = entries(j, 0, 0), *xy = entries(j, 0, 1), *xz = entries(j, 0, 2), *yx = entries(j, 1, 0),
                 *yy = entries(j, 1, 1), *yz = entries(j, 1, 2), *zx = entries(j, 2, 0), *zy = entries(j, 2, 1),
                 *zz = entries(j, 2, 2);
    const double nx = normal.x(), ny = normal.y(), nz = normal.z(), fx = force.x(), fy = force.y(), fz = force.z();
    // The sums are in the order in which Eigen has them in normal.dot(B * force), so that both give the same bits.
    for (int i = 0; i < end; ++i) {
      const double x = xx[i] * fx + xy[i] * fy + xz[i] * fz, y = yx[i] * fx + yy[i] * fy + yz[i] * fz,
                   z = zx[i] * fx + (zy[i] * fy + zz[i] * fz);
      out[i] = nx * x + ny * y + nz * z;
    }
  }
  /// Adds what a force [N] on node j does to nodes 0 ... end - 1 [m].
  void add_moved(const Eigen::Vector3d& force, int j, int end, double* x, double* y, double* z) const {
    double* const out[] = {x, y, z};
    for (int row = 0; row < 3; ++row) {
      const double *bx = entries(j, row, 0), *by = entries(j, row, 1), *bz = entries(j, row, 2);
      double* const to = out[row];
      for (int i = 0; i < end; ++i) to[i] += bx[i] * force.x() + by[i] * force.y() + bz[i] * force.z();
    }
  }
  /// sum += scale B_ij
  void add(int i, int j, double scale, Eigen::Matrix3d& sum) const {
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row) sum(row, column) += scale * entries(j, row, column)[i];
  }

 private:
  void put(int i, int j, const Eigen::Matrix3d& block) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) entries_[place(j, row, column) + i] = block(row, column);
  }
  /// Entry (row, column) of the blocks of nodes 0, 1 ... under forces on node j.
  const double* entries(int j, int row, int column) const { return &entries_[place(j, row, column)]; }
  std::size_t place(int j, int row, int column) const {
    return (9 * static_cast<std::size_t>(j) + 3 * row + column) * nodes_;
  }

  int nodes_;
  std::vector<double> entries_;
};

}  // namespace palpate
