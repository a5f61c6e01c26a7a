#include "common/archive/compressed_compliance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate {
namespace {

using Eigen::Matrix3f;
using Eigen::MatrixXf;

constexpr int kMaxLeaves = 4096;     // of 64 nodes and more: a quarter of a million nodes
constexpr double kRounding = 1.001;  // of single precision, and of what blocks of low rank leave out

void require(bool holds, const char* sentence) {
  if (!holds) throw std::invalid_argument(sentence);
}

}  // namespace

std::size_t ComplianceBlock::numbers() const {
  const auto r = static_cast<std::size_t>(rows()), c = static_cast<std::size_t>(columns());
  return dense() ? 9 * r * c : 3 * (r + c) * static_cast<std::size_t>(rank);
}

CompressedCompliance::CompressedCompliance(CompressedTensors tensors, int nodes, double scale) : scale_(scale) {
  auto layout = std::make_shared<Layout>();
  layout->tensors = std::move(tensors);
  set_places(*layout, nodes);
  set_leaves(*layout);
  set_tiles(*layout);
  layout_ = std::move(layout);
  check_values();
}

CompressedCompliance CompressedCompliance::scaled(double factor) const {
  CompressedCompliance result = *this;
  result.scale_ *= factor;
  return result;
}

std::size_t CompressedCompliance::bytes() const {
  const Layout& l = *layout_;
  return sizeof(float) * l.tensors.values.size() + sizeof(ComplianceBlock) * l.tensors.blocks.size() +
         sizeof(std::size_t) * l.at.size() + sizeof(int) * (l.place.size() + 2 * l.leaf.size() + l.tile.size());
}

void CompressedCompliance::set_places(Layout& layout, int nodes) {
  const CompressedTensors& t = layout.tensors;
  const int places = static_cast<int>(t.order.size());
  require(t.touchable > 0 && t.touchable <= places, "its order of nodes does not fit");
  layout.place.assign(nodes, -1);
  for (int p = 0; p < places; ++p) {
    require(t.order[p] >= 0 && t.order[p] < nodes && layout.place[t.order[p]] < 0, "its order of nodes does not fit");
    layout.place[t.order[p]] = p;
  }
  std::size_t numbers = 0;
  for (const ComplianceBlock& b : t.blocks) {
    require(b.row >= 0 && b.row < b.row_end && b.row_end <= places && b.column >= 0 && b.column < b.column_end &&
                b.column_end <= t.touchable && b.rank >= ComplianceBlock::kDense && b.rank <= 3 * b.columns(),
            "a block of its compliance is outside of it");
    layout.at.push_back(numbers);
    numbers += b.numbers();
    layout.max_rank = std::max(layout.max_rank, b.rank);
    layout.others |= b.row_end > t.touchable;
  }
  require(numbers == t.values.size(), "its blocks do not have as many numbers as there are");
}

void CompressedCompliance::set_leaves(Layout& layout) {
  std::vector<int>& begin = layout.leaf_begin;
  for (const ComplianceBlock& b : layout.tensors.blocks)
    begin.insert(begin.end(), {b.row, b.row_end, b.column, b.column_end});
  begin.insert(begin.end(), {0, layout.tensors.touchable});
  std::ranges::sort(begin);
  begin.erase(std::unique(begin.begin(), begin.end()), begin.end());
  require(begin.size() <= kMaxLeaves, "it has more clusters of nodes than can be");
  for (std::size_t l = 0; l + 1 < begin.size(); ++l) layout.leaf.resize(begin[l + 1], static_cast<int>(l));
}

void CompressedCompliance::set_tiles(Layout& layout) {
  const int leaves = static_cast<int>(layout.leaf_begin.size()) - 1;
  const auto leaf_at = [&](int place) { return place < layout.leaf_begin.back() ? layout.leaf[place] : leaves; };
  layout.tile.assign(static_cast<std::size_t>(leaves) * leaves, -1);
  for (std::size_t k = 0; k < layout.tensors.blocks.size(); ++k) {
    const ComplianceBlock& b = layout.tensors.blocks[k];
    const bool diagonal = b.row == b.column && b.row_end == b.column_end && b.dense();
    require(diagonal || b.row >= b.column_end, "a block of its compliance is above the diagonal");
    for (int r = leaf_at(b.row); r < leaf_at(b.row_end); ++r)
      for (int c = leaf_at(b.column); c < leaf_at(b.column_end); ++c) {
        require(!diagonal || leaf_at(b.row_end) == r + 1, "a cluster of its nodes is within another");
        int& tile = layout.tile[static_cast<std::size_t>(r) * leaves + c];
        require(tile < 0, "two blocks of its compliance overlap");
        tile = static_cast<int>(k);
      }
  }
  const int touchable = leaf_at(layout.tensors.touchable);
  for (int r = 0; r < leaves; ++r)
    for (int c = 0; c <= std::min(r, touchable - 1); ++c)
      require(layout.tile[static_cast<std::size_t>(r) * leaves + c] >= 0, "a block of its compliance is missing");
}

// c_ii > 0 and c_ij^2 <= c_ii c_jj, entry by entry in dense blocks; those of low rank by what their rows come to, V
// having unit columns.
void CompressedCompliance::check_values() const {
  const CompressedTensors& t = tensors();
  std::vector<double> own(t.touchable, 0);  // largest of c_ii of each touchable node
  for (int p = 0; p < t.touchable; ++p) {
    const Tile diagonal = tile(leaf(p), leaf(p));
    const Matrix3f c = diagonal.entry(p, p);
    own[p] = c.diagonal().maxCoeff();
    require(own[p] > 0 && c.diagonal().minCoeff() >= 0, "a node moves against its own force");
  }
  for (std::size_t k = 0; k < t.blocks.size(); ++k) {
    const ComplianceBlock& b = t.blocks[k];
    if (b.row_end > t.touchable) continue;
    const Tile all{&b, t.values.data() + layout_->at[k], false};
    double loaded = 0;
    for (int q = b.column; q < b.column_end; ++q) loaded += 3 * own[q];
    for (int p = b.row; p < b.row_end; ++p)
      if (b.dense())
        for (int q = b.column; q < b.column_end; ++q) {
          const double most = all.entry(p, q).cwiseAbs().maxCoeff();
          require(most * most <= kRounding * own[p] * own[q], "a node moves more under another's force than can be");
        }
      else if (b.rank > 0)
        require(all.moved_factor(p).colwise().squaredNorm().maxCoeff() <= kRounding * own[p] * loaded,
                "a node moves more under others' forces than can be");
    if (!b.dense() && b.rank > 0)
      for (int q = b.column; q < b.column_end; ++q)
        require(all.loaded_factor(q).cwiseAbs().maxCoeff() <= kRounding, "a factor of its compliance is not a unit");
  }
}

Eigen::Map<const MatrixXf> CompressedCompliance::Tile::factor(int place, bool of_rows) const {
  const int at = of_rows ? place - block->row : block->rows() + place - block->column;
  return {values + 3 * static_cast<std::size_t>(at) * block->rank, block->rank, 3};
}

CompressedCompliance::Tile CompressedCompliance::tile(int moved_leaf, int loaded_leaf) const {
  const auto [column, row] = std::minmax(moved_leaf, loaded_leaf);
  const int k = layout_->tile[static_cast<std::size_t>(row) * leaves() + column];
  if (k < 0) return {nullptr, nullptr, false};
  return {&tensors().blocks[k], tensors().values.data() + layout_->at[k], moved_leaf < loaded_leaf};
}

Eigen::Matrix3d CompressedCompliance::block(int i, int j) const {
  const int p = place(i), q = place(j);
  if (p < 0 || q < 0 || std::max(p, q) >= layout_->leaf_begin.back()) return Eigen::Matrix3d::Zero();
  const Tile t = tile(leaf(p), leaf(q));
  if (!t.block) return Eigen::Matrix3d::Zero();
  if (t.block->dense()) return scale_ * t.entry(p, q).cast<double>();
  const auto moved = t.moved_factor(p), loaded = t.loaded_factor(q);
  Eigen::Matrix3d c;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) c(a, b) = scale_ * moved.col(a).dot(loaded.col(b));
  return c;
}

}  // namespace palpate
