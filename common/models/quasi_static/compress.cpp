#include "common/models/quasi_static/compress.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <future>

#include "common/archive/node_clusters.hpp"
#include "common/fem/stopwatch.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Three rows of each node of some places.
MatrixXd rows_of(const MatrixXd& columns, std::span<const int> nodes) {
  MatrixXd rows(3 * static_cast<Index>(nodes.size()), columns.cols());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    rows.middleRows<3>(3 * static_cast<Index>(i)) = columns.middleRows<3>(3 * nodes[i]);
  return rows;
}

/// Appends the blocks of one leaf's columns after the other.
class Compressor {
 public:
  Compressor(const SurfaceMap& surface, BlockPlan plan) : blocks_(std::move(plan.blocks)) {
    tensors_.order = std::move(plan.order);
    tensors_.touchable = plan.touchable;
    nodes_ = surface.size();
  }

  /// The nodes of the leaf whose columns are next; empty when all are done.
  std::span<const int> leaf() const {
    if (next_ == blocks_.size()) return {};
    return places(blocks_[next_].column, blocks_[next_].column_end);
  }
  std::size_t done() const { return next_ == blocks_.size() ? tensors_.touchable : blocks_[next_].column; }

  /// Blocks that share the leaf; after this leaf() is the next one.
  std::span<const ComplianceBlock> take() {
    const std::size_t begin = next_;
    while (next_ < blocks_.size() && blocks_[next_].column == blocks_[begin].column) ++next_;
    return std::span(blocks_).subspan(begin, next_ - begin);
  }

  void append(std::span<const ComplianceBlock> blocks, const MatrixXd& columns) {
    const std::span<const int> loaded = places(blocks[0].column, blocks[0].column_end);
    double own = 0;
    for (std::size_t j = 0; j < loaded.size(); ++j)
      own += columns.block<3, 3>(3 * loaded[j], 3 * static_cast<Index>(j)).trace();
    const double left_out = kLeftOut * own / static_cast<double>(columns.cols());
    for (ComplianceBlock block : blocks) {
      const MatrixXd entries = rows_of(columns, places(block.row, block.row_end));
      if (block.dense() || !factorise(block, entries, left_out)) append_dense(block, entries);
    }
  }

  std::shared_ptr<const CompressedCompliance> finish() {
    return std::make_shared<CompressedCompliance>(std::move(tensors_), nodes_);
  }

 private:
  std::span<const int> places(int begin, int end) const {
    return std::span(tensors_.order).subspan(begin, end - begin);
  }

  void append_dense(ComplianceBlock block, const MatrixXd& entries) {
    block.rank = ComplianceBlock::kDense;
    tensors_.blocks.push_back(block);
    for (Index q = 0; q < entries.cols(); q += 3)
      for (Index p = 0; p < entries.rows(); p += 3)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) tensors_.values.push_back(static_cast<float>(entries(p + r, q + c)));
  }

  void append_rows(const MatrixXd& factor) {
    for (Index i = 0; i < factor.rows(); ++i)
      for (Index k = 0; k < factor.cols(); ++k) tensors_.values.push_back(static_cast<float>(factor(i, k)));
  }

  /// B V V^T for the leading right singular vectors of B; false where dense is smaller.
  bool factorise(ComplianceBlock block, const MatrixXd& entries, double left_out) {
    MatrixXd square = MatrixXd::Zero(entries.cols(), entries.cols());
    square.selfadjointView<Eigen::Lower>().rankUpdate(entries.transpose());
    const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(square);  // ascending squares of singular values
    const double most = left_out * left_out * static_cast<double>(entries.size());
    Index dropped = 0;
    for (double sum = 0; dropped < entries.cols(); ++dropped)
      if ((sum += std::max(0.0, modes.eigenvalues()[dropped])) > most) break;
    block.rank = static_cast<int>(entries.cols() - dropped);
    const ComplianceBlock dense{block.row, block.row_end, block.column, block.column_end};
    if (block.numbers() >= dense.numbers()) return false;
    const MatrixXd v = modes.eigenvectors().rightCols(block.rank);
    tensors_.blocks.push_back(block);
    append_rows(entries * v);
    append_rows(v);
    return true;
  }

  CompressedTensors tensors_;
  std::vector<ComplianceBlock> blocks_;
  std::size_t next_ = 0;
  int nodes_;
};

constexpr int kUsualRank = 16;  // of a block of low rank

}  // namespace

std::size_t compressed_bytes(const SurfaceMap& surface) {
  std::size_t numbers = 0;
  for (ComplianceBlock block : plan_blocks(surface).blocks) {
    if (!block.dense()) block.rank = kUsualRank;
    numbers += block.numbers();
  }
  return sizeof(float) * numbers;
}

std::shared_ptr<const CompressedCompliance> compress(const SurfaceMap& surface, const ColumnsOf& columns_of,
                                                     const Progress& progress) {
  Stopwatch watch(progress);
  BlockPlan plan = plan_blocks(surface);
  const int touchable = plan.touchable;
  Compressor compressor(surface, std::move(plan));
  std::future<void> before;  // the leaf before is compressed while the next one is solved for
  for (int told = 0; !compressor.leaf().empty();) {
    MatrixXd columns = columns_of(compressor.leaf());
    if (before.valid()) before.get();
    const auto blocks = compressor.take();
    before = std::async(std::launch::async,
                        [&compressor, blocks, columns = std::move(columns)] { compressor.append(blocks, columns); });
    const int done = static_cast<int>(compressor.done());
    if (10 * done / touchable == 10 * told / touchable && done < touchable) continue;
    told = done;
    watch.lap(fmt::format("compressed columns of {} of {} nodes", done, touchable));
  }
  before.get();
  return compressor.finish();
}

}  // namespace palpate
