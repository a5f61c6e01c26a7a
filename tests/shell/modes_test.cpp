#include "common/shell/modes.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "common/geometry/dense_solvers.hpp"
#include "common/shell/condensation.hpp"
#include "tests/shell/modal_shells.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;
using namespace testing;

VectorXd hertz(const Modes& modes) {
  return modes.omega / (2 * pi);
}

double orthonormality_error(const Modes& modes, const VectorXd& mass) {
  const MatrixXd product = modes.shape.transpose() * mass.asDiagonal() * modes.shape;
  return (product - MatrixXd::Identity(product.rows(), product.cols())).cwiseAbs().maxCoeff();
}

/// Lower triangle of `copies` chains of `length` springs of 1 N/m between masses, both ends tied to walls.
SparseMatrix chains(int copies, int length) {
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  for (int c = 0; c < copies; ++c)
    for (int i = 0; i < length; ++i) {
      entries.emplace_back(c * length + i, c * length + i, 2);
      if (i + 1 < length) entries.emplace_back(c * length + i + 1, c * length + i, -1);
    }
  SparseMatrix lower(copies * length, copies * length);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

double chain_omega(int mode, int length) {
  return 2 * std::sin(pi * (mode + 1) / (2.0 * (length + 1)));
}

// Kirchhoff's plate: f = pi/2 sqrt(D / rho t) (m^2 + n^2) / a^2.
TEST(ShellModes, ASimplySupportedSquarePlateHasTheFrequenciesOfTheClosedForm) {
  const auto system = supported_plate(28);
  const auto f = hertz(lowest_modes(system.stiffness, system.mass, 8));
  const double expected[] = {2.377, 5.942, 5.942, 9.507, 11.884, 11.884, 15.449, 15.449};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(f[i], expected[i], 0.01 * expected[i]) << i;
}

// Leissa 1973 gives 13.489, 19.789, 24.432, 35.024 (twice), 61.526 as upper bounds; the Ritz method with 16 x
// 16 Legendre polynomials gives what stands here, and NAFEMS FV12 the first three of it.
TEST(ShellModes, AFreeSquarePlateHasSixRigidMotionsAndThePublishedFrequencies) {
  const auto system = make_system(split_squares(28), kSteel, [](const Eigen::Vector3d&, int) { return false; });
  const auto f = hertz(lowest_modes(system.stiffness, system.mass, 13, 100));
  const double rigidity = kSteel.young * std::pow(kSteel.thickness, 3) / 12 / (1 - 0.3 * 0.3);
  const double unit = std::sqrt(rigidity / (kSteel.density * kSteel.thickness)) / (kSide * kSide) / (2 * pi);
  const double expected[] = {13.4682, 19.5961, 24.2702, 34.8009, 34.8009, 61.0932, 61.0932};
  for (int i = 0; i < 6; ++i) EXPECT_LT(f[i], 1e-3) << i;
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(f[6 + i] / unit, expected[i], 0.01 * expected[i]) << i;
}

/// Angular frequency of the lowest mode with m half waves along and n waves around a cylinder whose ends are
/// held by diaphragms: the exact solution of Sanders' theory, u = A cos, v = B sin, w = C sin times cos or
/// sin of n theta.
double sanders_omega(int m, int n, double radius, double length, const ShellMaterial& s) {
  const double l = m * pi / length, nu = s.poisson, r = radius;
  const double stretch = s.young * s.thickness / (1 - nu * nu), bend = stretch * s.thickness * s.thickness / 12;
  using Row = Eigen::RowVector3d;
  const Row axial(-l, 0, 0), around(0, n / r, 1 / r), shear(-n / r, l, 0);
  const Row bend_axial(0, 0, l * l), bend_around(0, n / (r * r), n * n / (r * r));
  const Row twist(n / (2 * r * r), 3 * l / (2 * r), 2 * n * l / r);  // of both halves together
  const auto energy = [&](const Row& a, const Row& b, const Row& c, double rigidity) -> Eigen::Matrix3d {
    const Eigen::Matrix3d cross = a.transpose() * b;
    return rigidity * (a.transpose() * a + b.transpose() * b + nu * (cross + cross.transpose()) +
                       (1 - nu) / 2 * c.transpose() * c);
  };
  const Eigen::Matrix3d k = energy(axial, around, shear, stretch) + energy(bend_axial, bend_around, twist, bend);
  return std::sqrt(symmetric_eigenvalues(k)[0] / (s.density * s.thickness));
}

TEST(ShellModes, AThinCylinderBetweenDiaphragmsHasThePairsOfTheClosedForm) {
  const ShellMaterial steel{200e9, 0.3, 8000, 0.01};
  const double radius = 1, length = 4;
  const auto system = make_system(make_tube(radius, length, 64, 40), steel, [&](const Eigen::Vector3d& x, int dof) {
    return (x[2] < 1e-9 || x[2] > length - 1e-9) && dof <= 1;  // free to slide along the axis as a whole
  });
  std::vector<double> expected;
  for (int m = 1; m <= 4; ++m)
    for (int n = 1; n <= 8; ++n) expected.insert(expected.end(), 2, sanders_omega(m, n, radius, length, steel));
  std::sort(expected.begin(), expected.end());
  const VectorXd omega = lowest_modes(system.stiffness, system.mass, 11, 1e4).omega;
  EXPECT_LT(omega[0], 1);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(omega[1 + i], expected[i], 0.01 * expected[i]) << i;
  for (int i = 1; i < 10; i += 2) EXPECT_NEAR(omega[i], omega[i + 1], 1e-3 * omega[i]) << i;
}

TEST(ShellModes, ModesAreOrthonormalAndSolveTheEigenproblem) {
  const auto system = duct(16, 16);
  for (int count : {1, 5, 20, 50, 100}) {
    const auto modes = lowest_modes(system.stiffness, system.mass, count);
    EXPECT_LT(orthonormality_error(modes, system.mass), 1e-10) << count;
    for (int i = 0; i < count; ++i) {
      const VectorXd mode = modes.shape.col(i);
      const VectorXd inertia = modes.omega[i] * modes.omega[i] * system.mass.cwiseProduct(mode);
      EXPECT_LT((static_solution(system, inertia) - mode).norm(), 1e-8 * mode.norm()) << i << " of " << count;
    }
  }
}

TEST(ShellModes, LanczosAndTheDenseMatrixAgree) {
  const auto system = duct(12, 10);
  const auto few = lowest_modes(system.stiffness, system.mass, 60);
  const auto all = lowest_modes(system.stiffness, system.mass, system.translations());
  EXPECT_LT(orthonormality_error(all, system.mass), 1e-10);
  for (int i = 0; i < 60; ++i) EXPECT_NEAR(few.omega[i], all.omega[i], 1e-8 * all.omega[i]) << i;

  const VectorXd root = system.mass.cwiseSqrt().cwiseInverse();
  const MatrixXd symmetric =
      root.asDiagonal() * condense_rotations(system.stiffness, system.translations()) * root.asDiagonal();
  const VectorXd square = symmetric_eigenvalues(symmetric);
  for (int i = 0; i < square.size(); ++i) EXPECT_NEAR(all.omega[i], std::sqrt(square[i]), 1e-5 * all.omega[i]) << i;
}

TEST(ShellModes, EveryCopyOfARepeatedFrequencyIsFound) {
  const int copies = 7, length = 60;
  const VectorXd mass = VectorXd::Ones(copies * length);
  for (int count : {3, 7, 10, 36}) {
    const auto modes = lowest_modes(chains(copies, length), mass, count);
    EXPECT_LT(orthonormality_error(modes, mass), 1e-10);
    for (int i = 0; i < count; ++i)
      EXPECT_NEAR(modes.omega[i], chain_omega(i / copies, length), 1e-9) << i << " of " << count;
  }
}

// Spectra alone returns seven or fewer of the eight copies of the lowest frequency here.
TEST(ShellModes, CopiesThatLanczosPassesByAreFoundToo) {
  const int copies = 8, count = 10;
  for (int distinct : {20, 24, 34, 38}) {
    SparseMatrix stiffness(copies * distinct, copies * distinct);
    for (int i = 0; i < copies * distinct; ++i) stiffness.insert(i, i) = std::sqrt(1 + i % distinct);
    stiffness.makeCompressed();
    const VectorXd mass = VectorXd::Ones(copies * distinct);
    const auto modes = lowest_modes(stiffness, mass, count);
    EXPECT_LT(orthonormality_error(modes, mass), 1e-10);
    for (int i = 0; i < count; ++i)
      EXPECT_NEAR(modes.omega[i], std::pow(1 + i / copies, 0.25), 1e-9) << i << " of " << distinct;
  }
}

TEST(ShellModes, AsManyModesAsTranslationsCanBeHad) {
  const int length = 40;
  const VectorXd mass = VectorXd::Ones(length);
  for (int count : {length / 3, length - 1, length}) {
    const auto modes = lowest_modes(chains(1, length), mass, count);
    ASSERT_EQ(modes.omega.size(), count);
    for (int i = 0; i < count; ++i) EXPECT_NEAR(modes.omega[i], chain_omega(i, length), 1e-10);
  }
}

TEST(ShellModes, MassesOfDifferentSizeCount) {
  VectorXd mass(2);
  mass << 1, 4;
  const auto modes = lowest_modes(chains(1, 2), mass, 2);
  // 2 - w, -1; -1, 2 - 4 w
  const double root = std::sqrt(13.0);
  EXPECT_NEAR(modes.omega[0] * modes.omega[0], (5 - root) / 4, 1e-12);
  EXPECT_NEAR(modes.omega[1] * modes.omega[1], (5 + root) / 4, 1e-12);
  EXPECT_LT(orthonormality_error(modes, mass), 1e-14);
}

TEST(ShellModes, SameBitsEachTimeAndTheFirstLargestEntryIsPositive) {
  const auto system = duct(12, 10);
  const auto a = lowest_modes(system.stiffness, system.mass, 20), b = lowest_modes(system.stiffness, system.mass, 20);
  EXPECT_EQ(a.omega, b.omega);
  EXPECT_EQ(a.shape, b.shape);
  for (const auto& mode : a.shape.colwise()) {
    const double largest = mode.cwiseAbs().maxCoeff();
    for (double x : mode)
      if (std::abs(x) >= (1 - 1e-6) * largest) {
        EXPECT_GT(x, 0);
        break;
      }
  }
}

std::string refusal(const SparseMatrix& stiffness, const VectorXd& mass, int count) {
  try {
    lowest_modes(stiffness, mass, count);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ShellModes, WrongCountsAndSingularMatricesAreRefusedInWords) {
  const VectorXd mass = VectorXd::Ones(6);
  EXPECT_EQ(refusal(chains(2, 3), mass, 7),
            "7 modes are asked for, but there are 6 free translational degrees of freedom");
  EXPECT_EQ(refusal(chains(2, 3), mass, 0),
            "0 modes are asked for, but there are 6 free translational degrees of freedom");
  SparseMatrix free = chains(1, 6);
  free.coeffRef(0, 0) = free.coeffRef(5, 5) = 1;
  EXPECT_NE(refusal(free, mass, 2), "");
  EXPECT_EQ(lowest_modes(free, mass, 2, 0.01).omega.size(), 2);
  VectorXd massless = mass;
  massless[2] = 0;
  EXPECT_EQ(refusal(chains(1, 6), massless, 1), "a node without mass has no modes of vibration");
  const auto plate = make_system(split_squares(6), kSteel, [](const Eigen::Vector3d&, int) { return false; });
  EXPECT_NE(refusal(plate.stiffness, plate.mass, 3), "");
}

}  // namespace
}  // namespace palpate
