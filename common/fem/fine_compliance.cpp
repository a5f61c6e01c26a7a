#include <fmt/format.h>

#include <mutex>

#include "common/fem/all_cores.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/fem/stopwatch.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kHats = 128;  // right-hand sides at once

/// Columns of W over the free fine dofs, one per free axis of the given run-time nodes.
SparseMatrix loads_of(const FineProblem& problem, const std::vector<int>& nodes) {
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  std::int64_t column = 0;
  for (int node : nodes)
    for (int axis = 0; axis < 3; ++axis) {
      if (!problem.run_time_dofs.is_free(node, axis)) continue;
      for (SparseMatrix::InnerIterator it(problem.hats, node); it; ++it) {
        const int row = problem.dofs.index(static_cast<int>(it.row()), axis);
        if (row >= 0) entries.emplace_back(row, column, it.value());
      }
      ++column;
    }
  SparseMatrix loads(problem.dofs.size(), column);
  loads.setFromTriplets(entries.begin(), entries.end());
  return loads;
}

/// Says about ten times how many right-hand sides are done, whichever thread did them.
class Tenths {
 public:
  Tenths(Stopwatch& watch, Index total) : watch_(watch), total_(total) {}
  void add(Index count) {
    const std::lock_guard lock(telling_);
    done_ += count;
    if (10 * done_ / total_ == 10 * told_ / total_ && done_ < total_) return;
    told_ = done_;
    watch_.lap(fmt::format("right-hand sides, {} of {}", done_, total_));
  }

 private:
  std::mutex telling_;
  Stopwatch& watch_;
  Index total_, done_ = 0, told_ = 0;
};

}  // namespace

SurfaceCompliance surface_compliance(const FineProblem& problem, const std::vector<int>& touchable,
                                     const std::vector<int>& other, const Progress& progress) {
  const auto touch = loads_of(problem, touchable), rest = loads_of(problem, other);
  const Index t = touch.cols(), o = rest.cols();
  const auto rows = static_cast<std::size_t>(t);
  const std::size_t packed = rows * (rows + 1) / 2, others = static_cast<std::size_t>(o) * rows;
  // Right-hand sides, their solution and what CHOLMOD keeps of them.
  const auto block_count = static_cast<std::size_t>((t + kHats - 1) / kHats);
  // Right-hand sides, their solution and what CHOLMOD keeps of them, in each thread.
  const std::size_t blocks =
      core_count(block_count) * 5 * sizeof(double) * static_cast<std::size_t>(touch.rows() * std::min(kHats, t));
  const FineFactor factor(problem, sizeof(double) * (packed + others) + blocks, progress);

  SurfaceCompliance result;
  result.touchable.resize(packed);
  result.other.resize(others);
  Stopwatch watch(progress);
  Tenths tenths(watch, t);
  on_all_cores(block_count, [&] {
    return [&, scratch = Factorisation::Scratch(), load = MatrixXd(), moved = MatrixXd()](std::size_t block) mutable {
      const Index begin = static_cast<Index>(block) * kHats, count = std::min(kHats, t - begin);
      load = touch.middleCols(begin, count);
      factor.solve_into(load, moved, scratch);
      const MatrixXd column = touch.transpose() * moved, rest_column = rest.transpose() * moved;
      for (Index c = 0; c < count; ++c) {
        for (Index i = begin + c; i < t; ++i) result.touchable[i * (i + 1) / 2 + begin + c] = column(i, c);
        for (Index i = 0; i < o; ++i) result.other[i * t + begin + c] = rest_column(i, c);
      }
      tenths.add(count);
    };
  });
  result.flops = factor.flops() + 4 * factor.nonzeros() * static_cast<double>(t);
  return result;
}

}  // namespace palpate
