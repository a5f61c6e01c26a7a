// The compliance near the tools is that of the whole tissue that is left, solved node by node.
#include "common/sim/local_stiffness.hpp"

#include <gtest/gtest.h>

#include "common/fem/direct.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"

namespace palpate {
namespace {

class LocalCompliance : public ::testing::Test {
 protected:
  /// The largest difference from static solves of the mesh without these tetrahedra, over the largest entry.
  double difference(const std::vector<int>& nodes, const std::vector<int>& removed) {
    LocalStiffness stiffness(elastic_mesh(archive_), {}, LocalStiffness::Worker::caller);
    EXPECT_TRUE(stiffness.ask(nodes, removed) && stiffness.take());
    const LocalStiffness::Answer& answer = stiffness.current();
    EXPECT_EQ(answer.nodes, nodes);

    TetMesh left = mesh_;
    left.tetrahedra.clear();
    for (int t = 0; t < static_cast<int>(mesh_.tetrahedra.size()); ++t)
      if (!std::ranges::binary_search(removed, t)) left.tetrahedra.push_back(mesh_.tetrahedra[t]);
    const StaticProblem problem = make_static_problem(std::get<TensorMassSpec>(scene_.bodies[0]), left);
    const auto& number = archive_.surface.node_number;
    double worst = 0, size = 0;
    for (std::size_t j = 0; j < nodes.size(); ++j)
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<Eigen::Vector3d> load(left.nodes.size(), Eigen::Vector3d::Zero());
        load[number[nodes[j]]][axis] = 1;
        const auto u = solve_loads(problem, load).displacement;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          const Eigen::Vector3d& moved = u[number[nodes[i]]];
          const Eigen::Vector3d ours = answer.block(static_cast<int>(i), static_cast<int>(j)).col(axis);
          worst = std::max(worst, (ours - moved).norm());
          size = std::max(size, moved.norm());
        }
      }
    return worst / size;
  }

  const TetMesh mesh_ = middle_block_mesh(6);
  const Scene scene_ = moving_block_scene<TensorMassSpec>();
  const Archive archive_ = precompute_on(scene_.bodies[0], mesh_);
};

TEST_F(LocalCompliance, OfTheWholeBlock) {
  EXPECT_LT(difference({0, 3, 7, 20, 41}, {}), 1e-3);
}

TEST_F(LocalCompliance, OfWhatACutLeaves) {
  EXPECT_LT(difference({0, 3, 7, 20, 41}, {0, 1, 2, 10, 11, 40}), 1e-3);
}

TEST_F(LocalCompliance, TheSameBitsWhateverWasAskedBefore) {
  LocalStiffness fresh(elastic_mesh(archive_), {}, LocalStiffness::Worker::caller);
  LocalStiffness used(elastic_mesh(archive_), {}, LocalStiffness::Worker::caller);
  used.ask(std::vector{5, 6, 30}, {});
  const std::vector<int> nodes{0, 3, 7}, removed{4};
  for (LocalStiffness* asked : {&used, &fresh}) EXPECT_TRUE(asked->ask(nodes, removed) && asked->take());
  EXPECT_EQ(fresh.current().compliance, used.current().compliance);
}

}  // namespace
}  // namespace palpate
