#include "common/models/catheter/band_matrix.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

TEST(BandMatrix, SolvesLikeADenseFactorisation) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const int particles : {3, 4, 17}) {
    const int n = 3 * particles;
    BandMatrix band(particles);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < particles; ++i)
      for (int apart = 0; apart <= 2 && i + apart < particles; ++apart) {
        Eigen::Matrix3d block = Eigen::Matrix3d::NullaryExpr([&] { return normal(random); });
        if (apart == 0) block = Eigen::Matrix3d(block * block.transpose() + 20 * Eigen::Matrix3d::Identity());
        band.add(i, apart, block);
        dense.block<3, 3>(3 * (i + apart), 3 * i) += block;
        if (apart > 0) dense.block<3, 3>(3 * i, 3 * (i + apart)) += block.transpose();
      }
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
    std::vector<double> x(b.data(), b.data() + n);
    x.resize(n + BandMatrix::kBand, 1e300);
    ASSERT_TRUE(band.factorise());
    band.solve(x);
    const Eigen::VectorXd expected = DenseCholesky(dense).solve(b);
    EXPECT_LT((Eigen::Map<Eigen::VectorXd>(x.data(), n) - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(BandMatrix, ToldThatItIsNotPositiveDefinite) {
  BandMatrix band(3);
  for (int i = 0; i < 3; ++i)
    band.add(i, 0,
             i == 1 ? Eigen::Matrix3d(-Eigen::Matrix3d::Identity()) : Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  EXPECT_FALSE(band.factorise());
}

}  // namespace
}  // namespace palpate
