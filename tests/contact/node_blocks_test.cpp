#include "common/contact/patch/node_blocks.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kNodes = 7;

class NodeBlocksTest : public testing::Test {
 protected:
  NodeBlocksTest() : blocks_(kNodes) {
    std::srand(1);
    for (int i = 0; i < kNodes; ++i)
      for (int j = 0; j <= i; ++j) {
        plain_[i][j] = Matrix3d::Random();
        blocks_.set(i, j, plain_[i][j]);
        plain_[j][i] = plain_[i][j].transpose().eval();
      }
  }

  NodeBlocks blocks_;
  Matrix3d plain_[kNodes][kNodes];
};

TEST_F(NodeBlocksTest, GiveTheBitsOfTheBlocksThemselves) {
  const Vector3d normal = Vector3d::Random().normalized(), force = Vector3d::Random();
  for (int j = 0; j < kNodes; ++j) {
    double along[kNodes], added[kNodes] = {};
    blocks_.along(normal, j, j, kNodes, along);
    blocks_.add_along(normal, force, j, kNodes, added);
    for (int i = j; i < kNodes; ++i) EXPECT_EQ(along[i - j], normal.dot(plain_[i][j] * normal));
    for (int i = 0; i < kNodes; ++i) EXPECT_EQ(added[i], normal.dot(plain_[i][j] * force));
  }
}

TEST_F(NodeBlocksTest, TheOtherWayRoundItIsTheTranspose) {
  for (int i = 0; i < kNodes; ++i)
    for (int j = 0; j < kNodes; ++j) {
      Matrix3d sum = Matrix3d::Identity();
      blocks_.add(i, j, 2, sum);
      EXPECT_EQ(sum, Matrix3d(Matrix3d::Identity() + 2 * plain_[i][j]));
    }
}

TEST_F(NodeBlocksTest, AreTakenFromOthersAsTheyAre) {
  const int order[] = {4, 6, 0, 3};
  NodeBlocks some(kNodes);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) some.take(i, j, blocks_, order[i], order[j]);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      Matrix3d sum = Matrix3d::Zero(), whole = Matrix3d::Zero();
      some.add(i, j, 1, sum);
      blocks_.add(order[i], order[j], 1, whole);
      EXPECT_EQ(sum, whole);
    }
}

}  // namespace
}  // namespace palpate
