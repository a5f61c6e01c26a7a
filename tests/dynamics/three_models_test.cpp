#include <gtest/gtest.h>

#include "bench/model_cases.hpp"
#include "common/dynamics/corotational.hpp"
#include "common/dynamics/spring_mass.hpp"
#include "common/dynamics/tensor_mass.hpp"

namespace palpate::bench {
namespace {

constexpr Material kQuarter{2e3, 0.25, 1000}, kSoft{2e3, 0.45, 1000};

TEST(ThreeModels, PrecomputedAndTensorMassEqualTheDirectSolve) {
  for (const Material& material : {kQuarter, kSoft}) {
    const auto solid = make_loaded_solid(Meshing::five, material);
    const Field direct = direct_field(solid);
    EXPECT_LT(field_error(solid, superposed_field(solid), direct), 1e-10);
    EXPECT_LT(field_error(solid, rest_field<TensorMass<double>>(solid), direct), 1e-6);
    EXPECT_LT(field_error(solid, rest_field<TensorMass<float>>(solid, {}, 1e-5), direct), 1e-3);
    EXPECT_LT(field_error(solid, rest_field<Corotational<double>>(solid), direct), 1e-3);
  }
}

TEST(ThreeModels, SinglePrecisionRestsWhereDoubleDoes) {
  auto solid = make_loaded_solid(Meshing::five, kSoft);
  for (auto& force : solid.load) force *= 10;  // strains of some 0.1 %
  EXPECT_LT(field_error(solid, rest_field<SpringMass<float>>(solid, {}, 1e-4), rest_field<SpringMass<double>>(solid)),
            1e-3);
  EXPECT_LT(
      field_error(solid, rest_field<Corotational<float>>(solid, {}, 1e-4), rest_field<Corotational<double>>(solid)),
      1e-3);
}

TEST(ThreeModels, SpringsAreOffByTenPerCentAndMoreWhereTheirPoissonRatioIsNotTheTissues) {
  double error[2];
  for (const int soft : {0, 1}) {
    const auto solid = make_loaded_solid(Meshing::five, soft ? kSoft : kQuarter);
    error[soft] = field_error(solid, rest_field<SpringMass<double>>(solid), direct_field(solid));
  }
  EXPECT_GT(error[0], 0.03);
  EXPECT_LT(error[0], 0.2);
  EXPECT_GT(error[1], error[0]);
}

TEST(ThreeModels, MeshedOtherwiseSpringsChangeAndElementsHardlyDo) {
  const auto five = make_loaded_solid(Meshing::five, kQuarter);
  const auto six = make_loaded_solid(Meshing::six, kQuarter);
  const auto change = [&](const Field& first, const Field& second) {
    return std::abs(give(five, first) / give(six, second) - 1);
  };
  const double elements = change(direct_field(five), direct_field(six));
  const double springs = change(rest_field<SpringMass<double>>(five), rest_field<SpringMass<double>>(six));
  EXPECT_LT(elements, 0.01);
  EXPECT_GT(springs, 0.02);
}

TEST(ThreeModels, CutTensorMassEqualsAFreshSolveOfTheCutMesh) {
  const auto solid = make_loaded_solid(Meshing::five, kQuarter);
  const auto cut = slot(solid.problem.mesh);
  const auto fresh = make_loaded_solid(without(solid.problem.mesh, cut), kQuarter);
  const Field reference = direct_field(fresh);
  EXPECT_GT(field_error(solid, direct_field(solid), reference), 0.5) << "the cut must matter";
  EXPECT_LT(field_error(solid, rest_field<TensorMass<double>>(solid, cut), reference), 1e-5);
  EXPECT_LT(field_error(solid, rest_field<Corotational<double>>(solid, cut), reference), 1e-2);
  EXPECT_GT(field_error(solid, rest_field<SpringMass<double>>(solid, cut), reference), 1e-2);
}

TEST(ThreeModels, RotationGivesFalseForcesToTheLinearModelsAlone) {
  const auto solid = make_loaded_solid(Meshing::five, kQuarter);
  EXPECT_GT(false_force_of<TensorMass<double>>(solid.mesh), 1);
  EXPECT_LT(false_force_of<SpringMass<double>>(solid.mesh), 1e-12);
  EXPECT_LT(false_force_of<Corotational<double>>(solid.mesh), 1e-12);
}

/// Effective Young's modulus of a block whose top is pulled while sides and bottom slide freely.
TEST(ThreeModels, SpringsAreStifferAlongTheGridThanYoungsModulus) {
  for (const Meshing meshing : {Meshing::five, Meshing::six}) {
    auto solid = make_loaded_solid(meshing, kQuarter);
    const double strain = 1e-4, height = 0.06, area = 0.07 * 0.07;
    for (int n = 0; n < solid.mesh.nodes(); ++n) {
      const auto& x = solid.mesh.rest[n];
      solid.mesh.fixed[n] = {x.x() == 0, x.y() == 0, x.z() == 0};
    }
    solid.load = top_load(solid.problem.mesh, {0, 0, strain * kQuarter.young});
    const auto effective = [&](const Field& u) {
      const double force = strain * kQuarter.young * area;
      return force * force * height / (give(solid, u) * area) / kQuarter.young;
    };
    EXPECT_NEAR(effective(rest_field<TensorMass<double>>(solid)), 1, 1e-6);
    const double springs = effective(rest_field<SpringMass<double>>(solid));
    EXPECT_GT(springs, 1.1);
    EXPECT_LT(springs, 1.35);
  }
}

}  // namespace
}  // namespace palpate::bench
