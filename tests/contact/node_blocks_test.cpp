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
    double along[kNodes];
    blocks_.along(normal, force, j, kNodes, along);
    for (int i = 0; i < kNodes; ++i) EXPECT_EQ(along[i], normal.dot(plain_[i][j] * force));
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

}  // namespace
}  // namespace palpate
