#include "common/models/quasi_static/tensor_work.hpp"

#include <fmt/format.h>

#include <chrono>
#include <vector>

#include "common/fem/dense.hpp"
#include "common/fem/factorisation.hpp"
#include "common/fem/fine_stiffness.hpp"
#include "common/fem/ordering.hpp"
#include "common/models/quasi_static/spec.hpp"

namespace palpate {
namespace {

constexpr double kBlockPenalty = 4;     // blocks of right-hand sides run at a quarter of the speed of dense algebra
constexpr Eigen::Index kSquare = 1000;  // the size of a product that tells this machine's speed

/// [flop/s] of a dense product.
double dense_speed() {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(kSquare, kSquare, 0.5);
  dense_product(a, a);  // wakes its threads
  const auto begin = std::chrono::steady_clock::now();
  dense_product(a, a);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return 2.0 * kSquare * kSquare * kSquare / taken.count();
}

}  // namespace

TensorWork tensor_work(const TetMesh& mesh, const SurfaceMap& surface, const Offline& offline) {
  const double touchable = 3.0 * surface.touchable;
  const FineSpace space = make_fine_space(mesh, offline);
  const NodeGraph graph = fine_graph(space, nullptr);
  std::vector<char> used(space.nodes.size());
  for (std::size_t n = 0; n < used.size(); ++n) used[n] = graph.begin[n + 1] > graph.begin[n];
  DofMap dofs(used);
  dofs.number();
  const bool by_blocks = is_finer(offline) || form_of(surface.touchable) == TensorForm::compressed;
  const std::vector<Eigen::Matrix3d> blocks(graph.neighbour.size(), Eigen::Matrix3d::Identity());
  const std::vector<int> last = by_blocks ? std::vector<int>{} : surface.node_number;
  const Factorisation factor(lower_triangle(blocks, dofs, graph), dof_order(dofs, interior_first_order(graph, last)));
  const auto entries = static_cast<double>(factor.factor_nonzeros());
  const double rest = by_blocks ? kBlockPenalty * 4 * entries * touchable : 2.0 / 3 * touchable * touchable * touchable;
  return {factor.flops() + rest, sizeof(double) * entries};
}

WorkTime time_of(const TensorWork& work) {
  const double seconds = work.operations / dense_speed();
  const std::string figure = seconds < 10 ? fmt::format("{:.2g}", seconds) : fmt::format("{:.0f}", seconds);
  return {seconds, fmt::format("about {} s on this machine", figure)};
}

}  // namespace palpate
